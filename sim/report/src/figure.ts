/** A chart on the page: caption, legend, buttons, plot, and what the pointer or the keys point at. */
import type { Chart, Series, Window } from "./chart";
import { csvOf } from "./csv";
import { button, element } from "./dom";
import { Plot, type Pixel } from "./plot";
import { moved, placeNear, readingAt, stride, type Place } from "./reading";
import { colour, onTheme } from "./theme";

const kKeys = "Arrow keys read values, + and - zoom, 0 shows all, with Shift the arrows move.";

export function figureOf(chart: Chart): HTMLElement {
  const host = element("div", { class: "plot", tabindex: "0", role: "group" });
  host.setAttribute("aria-label", `${chart.title}. ${kKeys}`);
  const figure = element(
    "figure",
    { id: chart.id, class: "chart" },
    element("figcaption", {}, element("h3", {}, chart.title), element("p", {}, chart.caption)),
  );
  const legend = element("div", { class: "legend", role: "group", "aria-label": "Legend" });
  const tools = element("div", { class: "tools" });
  figure.append(element("div", { class: "bar" }, legend, tools), host);
  // A plot needs the width that its place on the page gives it.
  queueMicrotask(() => fill(chart, figure, host, legend, tools));
  return figure;
}

function fill(
  chart: Chart,
  figure: HTMLElement,
  host: HTMLElement,
  legend: HTMLElement,
  tools: HTMLElement,
): void {
  const pointer = new Pointer(host);
  const plot = new Plot(chart, host);
  plot.onCursor = (at) => pointer.follow(plot, at);
  plot.onWindow = (window) => figure.setAttribute("data-window", textOf(window));
  plot.reset();
  legend.append(...chart.series.map((series, i) => key(plot, series, i)));
  tools.append(
    button("+", "Zoom in", () => plot.zoom(0.5)),
    button("−", "Zoom out", () => plot.zoom(2)),
    button("All", "Show all", () => plot.reset()),
    button("CSV", "Download the data as CSV", () => download(chart)),
  );
  host.addEventListener("dblclick", () => plot.reset());
  host.addEventListener("keydown", (event) => {
    if (pressed(event, plot, pointer)) event.preventDefault();
  });
  host.addEventListener("blur", () => pointer.hide());
  figure.setAttribute("data-ready", "");
}

const textOf = ({ x, y }: Window): string => [x.low, x.high, y.low, y.high].join(" ");

/** A key of the legend, which hides and shows its series. */
function key(plot: Plot, series: Series, index: number): HTMLElement {
  const swatch = element("span", { class: `swatch ${series.dashed ? "dashed" : series.style}` });
  const paint = (): void => swatch.style.setProperty("--colour", colour(series.colour));
  paint();
  onTheme(paint);
  const made = element("button", { type: "button", "aria-pressed": "true" }, swatch, series.label);
  made.addEventListener("click", () => {
    const shown = !plot.isShown(index);
    plot.setShown(index, shown);
    made.setAttribute("aria-pressed", String(shown));
  });
  return made;
}

function download(chart: Chart): void {
  const url = URL.createObjectURL(new Blob([csvOf(chart)], { type: "text/csv" }));
  element("a", { href: url, download: `${chart.id}.csv` }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** @returns whether the key means anything here */
function pressed(event: KeyboardEvent, plot: Plot, pointer: Pointer): boolean {
  if (event.ctrlKey || event.altKey || event.metaKey) return false;
  const sideways = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  if (sideways !== undefined) {
    if (event.shiftKey) plot.pan(0.25 * sideways);
    else pointer.step(plot, sideways, 0);
    return true;
  }
  const action: (() => void) | undefined = {
    ArrowUp: () => pointer.step(plot, 0, -1),
    ArrowDown: () => pointer.step(plot, 0, 1),
    "+": () => plot.zoom(0.5),
    "=": () => plot.zoom(0.5),
    "-": () => plot.zoom(2),
    "0": () => plot.reset(),
    Escape: () => pointer.hide(),
  }[event.key];
  action?.();
  return action !== undefined;
}

/** The place that is read, with its text beside it. */
class Pointer {
  private readonly tip = element("div", { class: "tip", role: "status", hidden: "" });
  private readonly dot = element("div", { class: "dot", hidden: "" });
  private place: Place | undefined;

  constructor(host: HTMLElement) {
    host.append(this.dot, this.tip);
  }

  follow(plot: Plot, at: Pixel | undefined): void {
    const place = at && placeNear(plot, at);
    if (place) this.read(plot, place);
    else this.hide();
  }

  step(plot: Plot, dIndex: number, dSeries: number): void {
    const { left, top, width, height } = plot.area();
    const middle = { left: left + width / 2, top: top + height / 2 };
    const from = this.place ?? placeNear(plot, middle);
    if (!from) return;
    this.read(plot, this.place ? moved(plot, from, dIndex * stride(plot, from), dSeries) : from);
  }

  hide(): void {
    this.tip.hidden = true;
    this.dot.hidden = true;
    this.place = undefined;
  }

  private read(plot: Plot, place: Place): void {
    this.place = place;
    const series = plot.chart.series[place.series] as Series;
    const reading = readingAt(plot, place);
    const lines = reading.lines.map((line) => {
      const text = element("div", {}, line.text);
      if (line.colour !== undefined) {
        const swatch = element("span", { class: "swatch" });
        swatch.style.setProperty("--colour", colour(line.colour));
        text.prepend(swatch);
      }
      return text;
    });
    this.tip.replaceChildren(element("strong", {}, reading.heading), ...lines);
    const x = series.x[place.index] as number;
    this.put(plot, plot.toPixel(x, series.y[place.index] as number));
  }

  private put(plot: Plot, at: Pixel): void {
    const area = plot.area();
    const left = area.left + Math.min(Math.max(at.left, 0), area.width);
    const top = area.top + Math.min(Math.max(Number.isFinite(at.top) ? at.top : 0, 0), area.height);
    this.tip.hidden = false;
    this.dot.hidden = false;
    this.dot.style.translate = `${left}px ${top}px`;
    const beside = left > area.left + area.width / 2 ? left - this.tip.offsetWidth - 12 : left + 12;
    const above = Math.min(top, area.top + area.height - this.tip.offsetHeight);
    this.tip.style.translate = `${Math.max(beside, 0)}px ${Math.max(above, 0)}px`;
  }
}
