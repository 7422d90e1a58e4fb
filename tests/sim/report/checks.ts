/** What is checked of a report in a browser. */
import { strict as assert } from "node:assert";
import { readFile, stat } from "node:fs/promises";
import { pathToFileURL } from "node:url";
import type { Browser, Locator, Page } from "playwright-core";
import { rowsOf, type Row } from "./csv_rows";
import type { MadeReport } from "./made_reports";
import { kNumbers } from "./numbers";

const kPatienceMs = 60_000;  // for a slow machine; nothing is judged by its time
const kMostBytes = 5_000_000;

export async function checkReport(browser: Browser, report: MadeReport): Promise<void> {
  assert((await stat(report.path)).size < kMostBytes, "the report is larger than 5 MB");
  const context = await browser.newContext({ viewport: { width: 1000, height: 800 } });
  context.setDefaultTimeout(kPatienceMs);
  const page = await context.newPage();
  const complaints = complaintsOf(page);
  try {
    await open(page, report);
    await checkWords(page, report);
    const tables = new Map<string, Row[]>();
    for (const chart of report.charts) tables.set(chart, await checkChart(page, chart));
    kNumbers[report.name]?.(report.json.results, tables);
    await checkWidths(page, report);
    await checkColours(page, report);
    assert.deepEqual(complaints, []);
  } finally {
    await context.close();
  }
}

/** Errors on the console, and requests to anywhere but the file and what it made itself. */
function complaintsOf(page: Page): string[] {
  const complaints: string[] = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`request: ${request.url()}`);
  });
  return complaints;
}

async function open(page: Page, report: MadeReport): Promise<void> {
  await page.goto(pathToFileURL(report.path).href);
  for (const chart of report.charts) {
    await page.waitForSelector(`figure[id="${chart}"][data-ready]`, { state: "attached" });
  }
  const all = await page.locator("figure").evaluateAll((figures) => figures.map((f) => f.id));
  assert.deepEqual(all, report.charts, "the charts on the page");
}

async function checkWords(page: Page, report: MadeReport): Promise<void> {
  for (const id of ["scene", "answer", "trust", "made-by"]) {
    assert((await page.locator(`#${id}`).innerText()).length > 40, `#${id} says next to nothing`);
  }
  const madeBy = await page.locator("#made-by").innerText();
  assert(madeBy.includes(`leeway ${report.name} `), "the command that made it");
  const words = await page.locator("main").innerText();
  assert(!/undefined|NaN|null|\[object/.test(words), "a value that is none");
}

async function checkChart(page: Page, id: string): Promise<Row[]> {
  const figure = page.locator(`figure[id="${id}"]`);
  const plot = figure.locator(".plot");
  await plot.scrollIntoViewIfNeeded();
  assert(await isDrawn(figure), `${id}: nothing is drawn`);
  const rows = await download(page, figure);
  assert(rows.length > 0, `${id}: no data`);
  await checkHover(page, figure, id);
  await checkKeys(page, figure, id, rows);
  await checkZoom(page, figure, id);
  await checkLegend(figure, id);
  return rows;
}

/** Whether some pixels of the canvas have the colour of a series: neither grey nor empty. */
async function isDrawn(figure: Locator): Promise<boolean> {
  return figure.locator("canvas").evaluate((element) => {
    const canvas = document.createElement("canvas"); // the browser warns of reading the other twice
    ({ width: canvas.width, height: canvas.height } = element as HTMLCanvasElement);
    const context = canvas.getContext("2d");
    context?.drawImage(element as HTMLCanvasElement, 0, 0);
    const pixels = context?.getImageData(0, 0, canvas.width, canvas.height).data;
    let coloured = 0;
    for (let i = 0; pixels && i < pixels.length; i += 4) {
      const [r, g, b, a] = [0, 1, 2, 3].map((k) => pixels[i + k] as number) as [
        number, number, number, number,
      ];
      if (a > 200 && Math.max(r, g, b) - Math.min(r, g, b) > 60) ++coloured;
    }
    return coloured > 20;
  });
}

async function download(page: Page, figure: Locator): Promise<Row[]> {
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    figure.getByRole("button", { name: "Download the data as CSV" }).click(),
  ]);
  return rowsOf(await readFile(await file.path(), "utf8"));
}

async function checkHover(page: Page, figure: Locator, id: string): Promise<void> {
  const box = await figure.locator(".u-over").boundingBox();
  assert(box, `${id}: no plot`);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await figure.locator(".tip").waitFor({ state: "visible" });
  assert(/\d/.test(await figure.locator(".tip").innerText()), `${id}: hovering tells no number`);
  await page.mouse.move(box.x + box.width / 2, box.y - 60);
  await figure.locator(".tip").waitFor({ state: "hidden" });
}

/** The keys read other values one after the other, and those of the CSV. */
async function checkKeys(page: Page, figure: Locator, id: string, rows: Row[]): Promise<void> {
  await figure.locator(".plot").focus();
  const texts = new Set<string>();
  for (const press of ["ArrowRight", "ArrowRight", "ArrowLeft", "ArrowDown", "ArrowLeft"]) {
    await page.keyboard.press(press);
    const text = await figure.locator(".tip").innerText();
    assert(isInCsv(text, rows), `${id}: not in the CSV: ${text}`);
    texts.add(text);
  }
  assert(texts.size > 1 || rows.length === 1, `${id}: the arrow keys always read the same`);
  await page.keyboard.press("Escape");
  await figure.locator(".tip").waitFor({ state: "hidden" });
}

/** Whether x and y of some row are what is told, to the three digits that it is told with. */
function isInCsv(told: string, rows: Row[]): boolean {
  const values = told.split("\n").map((line) => line.slice(line.indexOf(": ") + 2));
  const isTold = (cell: string): boolean =>
    values.some((value) => {
      const [cellNumber, toldNumber] = [Number(cell), Number.parseFloat(value)];
      return value === cell || Math.abs(cellNumber - toldNumber) <= 0.006 * Math.abs(cellNumber);
    });
  return rows.some((row) => {
    const cells = Object.entries(row).filter(([name]) => !["series", "name"].includes(name));
    return cells.slice(0, 2).every(([, cell]) => isTold(cell));
  });
}

const windowOf = async (figure: Locator): Promise<number[]> =>
  ((await figure.getAttribute("data-window")) ?? "").split(" ").map(Number);

async function checkZoom(page: Page, figure: Locator, id: string): Promise<void> {
  const width = async (): Promise<number> => {
    const [low, high] = (await windowOf(figure)) as [number, number];
    return high - low;
  };
  const whole = await width();
  await page.keyboard.press("+");
  const byKey = await width();
  assert(byKey < whole, `${id}: + does not zoom`);
  await page.keyboard.press("0");
  assert.equal(await width(), whole, `${id}: 0 does not show all`);
  const box = await figure.locator(".u-over").boundingBox();
  assert(box, `${id}: no plot`);
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.3 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.7 * box.height, { steps: 4 });
  await page.mouse.up();
  assert((await width()) < 0.95 * whole, `${id}: dragging does not zoom`);
  await figure.getByRole("button", { name: "Show all" }).click();
  assert.equal(await width(), whole, `${id}: the button does not show all`);
}

async function checkLegend(figure: Locator, id: string): Promise<void> {
  const keys = figure.locator(".legend button");
  assert((await keys.count()) > 0, `${id}: no legend`);
  await keys.first().click();
  assert.equal(await keys.first().getAttribute("aria-pressed"), "false");
  await keys.first().click();
  assert.equal(await keys.first().getAttribute("aria-pressed"), "true");
}

/** From a telephone to a large screen nothing sticks out, and charts fill what there is. */
async function checkWidths(page: Page, report: MadeReport): Promise<void> {
  for (const width of [400, 1600]) {
    await page.setViewportSize({ width, height: 800 });
    await page.waitForFunction(
      () => [...document.querySelectorAll(".plot")].every(
        (plot) => Math.abs(plot.clientWidth - (plot.querySelector(".uplot")?.clientWidth ?? 0)) < 2,
      ),
    );
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert(wide <= width, `${report.name}: ${wide} px wide where there are ${width}`);
  }
}

async function checkColours(page: Page, report: MadeReport): Promise<void> {
  const ground = (): Promise<string> =>
    page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await ground();
  await page.emulateMedia({ colorScheme: "dark" });
  await page.waitForFunction(
    (before) => getComputedStyle(document.body).backgroundColor !== before, light,
  );
  for (const id of report.charts) {
    assert(await isDrawn(page.locator(`figure[id="${id}"]`)), `${id}: nothing is drawn when dark`);
  }
  await page.getByRole("button", { name: "Switch between light and dark" }).click();
  assert.equal(await ground(), light, "the button does not switch back to light");
}
