/** leeway analyze: claimed and true error of a scene, and where it comes from. */
import type { Chart, Series } from "../chart";
import type { Report, Table } from "../report";
import type { View } from "../view";
import { list, percent, short, withUnit } from "../words";
import { metricOf, sceneInWords, sceneOf, type SceneInput } from "./scene";

interface BudgetLine {
  readonly source: string;
  readonly north_m2: number;
  readonly east_m2: number;
  readonly down_m2: number;
  readonly horizontal_share: number;
}

interface Results {
  readonly true_m: number;
  readonly claimed_m: number;
  readonly optimistic_by: number;
  readonly worst_s: number;
  readonly window_s: number;
  readonly settled: boolean;
  readonly settled_s: number | null;
  readonly budget: readonly BudgetLine[];
}

export function analyzeView(report: Report): View {
  const results = report.results as Results;
  const scene = sceneOf(report);
  const budget = [...results.budget].sort((a, b) => b.horizontal_share - a.horizontal_share);
  const moments = report.series["moments"];
  return {
    title: "What the filter claims, what is true, and where the error comes from",
    scene: sceneInWords(scene),
    answer: answer(results, budget, scene),
    tables: [
      {
        caption: `Where the true error comes from, at ${short(results.worst_s)} s`,
        headings: ["source", "north, m", "east, m", "down, m", "horizontal share"],
        rows: budget.map((line) => [
          spoken(line.source), ...[line.north_m2, line.east_m2, line.down_m2].map((m2) => short(Math.sqrt(m2))),
          percent(line.horizontal_share),
        ]),
      },
    ],
    trust: [
      "A covariance analysis: the filter's own equations, linearized along the true motion, " +
        "against sensors and a receiver that also have the errors it does not model. No trials.",
      "Sources are independent of each other, so their squares add up.",
      results.settled
        ? `The filter has settled since ${short(results.settled_s)} s: every sigma repeats to 0.1 %.`
        : "The filter has not settled by the end of the scene.",
    ],
    charts: [
      ...(moments ? [sigmaChart(moments, "h", "horizontal", scene), sigmaChart(moments, "d", "down", scene)] : []),
      budgetChart(budget),
    ],
  };
}

const spoken = (source: string): string => source.replaceAll("_", " ");

function answer(results: Results, budget: readonly BudgetLine[], scene: SceneInput): string[] {
  const ratio = results.optimistic_by;
  const honesty = Math.abs(ratio - 1) < 0.005
    ? "as honest as it can be"
    : ratio > 1 ? `optimistic by a factor of ${short(ratio)}` : `pessimistic by a factor of ${short(1 / ratio)}`;
  const most = budget.slice(0, 3).map((line) => `${spoken(line.source)} (${percent(line.horizontal_share)})`);
  return [
    `Largest error before a fix in the last ${short(results.window_s)} s: ` +
      `${withUnit(results.true_m, "m")}, at ${short(results.worst_s)} s; it is ${metricOf(scene)}.`,
    `The filter claims: ${withUnit(results.claimed_m, "m")}, so it is ${honesty}.`,
    `Most of it comes from: ${list(most)}.`,
  ];
}

function sigmaChart(moments: Table, letter: string, name: string, scene: SceneInput): Chart {
  const line = (label: string, colour: number, column: string): Series => {
    const high = moments.highest(column);
    return {
      label, colour, style: "envelope", x: moments.column("t_s"), y: moments.column(column),
      ...(high ? { high } : {}),
    };
  };
  return {
    id: `sigma-${name}`,
    title: `Claimed and true sigma, ${name}`,
    caption: "One sigma of the position: it grows between fixes and falls at each of them.",
    x: { label: "time", unit: "s" },
    y: { label: `${name} sigma`, unit: "m", log: true },
    series: [line("true", 1, `true_${letter}_m`), line("claimed", 0, `claimed_${letter}_m`)],
    spans: scene.gnss.outages.map((o) => ({
      from: o.start_s, to: o.start_s + o.duration_s, label: "outage",
    })),
    hover: "x",
  };
}

function budgetChart(budget: readonly BudgetLine[]): Chart {
  return {
    id: "sources",
    title: "Where the true error comes from",
    caption: "Horizontal error (DRMS) that each source alone makes, at the worst fix.",
    x: { label: "horizontal error", unit: "m" },
    y: { label: "", unit: "", categories: budget.map((line) => spoken(line.source)) },
    series: [
      {
        label: "horizontal", style: "bars", colour: 0, y: budget.map((_line, i) => i),
        x: budget.map((line) => Math.sqrt(line.north_m2 + line.east_m2)),
      },
    ],
    hover: "point",
  };
}
