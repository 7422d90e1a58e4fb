/** The page around the charts: the answer in words first, then how sure it is, then the pictures. */
import { button, element } from "./dom";
import { figureOf } from "./figure";
import type { Report } from "./report";
import { switchTheme } from "./theme";
import type { Grid, View } from "./view";

export function pageOf(report: Report, view: View): HTMLElement {
  document.title = `${view.title} · Leeway`;
  return element(
    "main",
    {},
    element(
      "header",
      {},
      element("h1", {}, view.title),
      button("Light / dark", "Switch between light and dark", switchTheme),
    ),
    section("scene", "The scene", view.scene),
    section("answer", "The answer", view.answer),
    ...view.tables.map(tableOf),
    section("trust", "How sure is this?", view.trust),
    element("section", { id: "charts" }, ...view.charts.map(figureOf)),
    ...(view.details ?? []).map(folded),
    madeBy(report),
  );
}

function section(id: string, title: string, sentences: readonly string[]): HTMLElement {
  if (sentences.length === 0) return element("section", { id, hidden: "" });
  const items = sentences.map((sentence) => element("li", {}, ...withLead(sentence)));
  return element("section", { id }, element("h2", {}, title), element("ul", {}, ...items));
}

/** What stands before a colon is what the sentence is about. */
function withLead(sentence: string): (HTMLElement | string)[] {
  const colon = sentence.indexOf(": ");
  if (colon < 0) return [sentence];
  return [element("strong", {}, sentence.slice(0, colon + 1)), sentence.slice(colon + 1)];
}

function tableOf(grid: Grid): HTMLElement {
  const head = grid.headings.map((text) => element("th", { scope: "col" }, text));
  const rows = grid.rows.map((row) =>
    element("tr", {}, ...row.map((text, i) => element(i === 0 ? "th" : "td", {}, text))),
  );
  const table = element(
    "table",
    {},
    element("caption", {}, grid.caption),
    element("thead", {}, element("tr", {}, ...head)),
    element("tbody", {}, ...rows),
  );
  return element("div", { class: "scroll", tabindex: "0" }, table);
}

function folded(grid: Grid): HTMLElement {
  return element("details", {}, element("summary", {}, grid.caption), tableOf(grid));
}

function madeBy(report: Report): HTMLElement {
  const row = (term: string, text: HTMLElement | string): HTMLElement[] => [
    element("dt", {}, term),
    element("dd", {}, text),
  ];
  const input = JSON.stringify(report.input, null, 2);
  return element(
    "section",
    { id: "made-by" },
    element("h2", {}, "Where this comes from"),
    element(
      "dl",
      {},
      ...row("Command", element("code", {}, report.command_line)),
      ...row("Version", `leeway ${report.leeway}`),
      ...row("Seeds", seedsOf(report)),
    ),
    element(
      "details",
      {},
      element("summary", {}, "Everything that was asked for"),
      element("pre", {}, input),
    ),
  );
}

/** Trial k of first seed s has seed s + k. */
function seedsOf({ input, command }: Report): string {
  const trials = input["trials"];
  const first = input["first_seed"] ?? input["seed"];
  if (command === "atlas") return "1 and on, as many as a scene has trials";
  if (typeof first !== "number") return "none: nothing is random here";
  if (command === "analyze") return "none: a covariance analysis draws no random numbers";
  if (typeof trials !== "number" || input["seed"] !== undefined) return String(first);
  return `${first} to ${first + trials - 1}, one for each trial`;
}
