/** leeway compare: cost against accuracy of the ways of running the filter. */
import type { Chart, Series } from "../chart";
import type { Report } from "../report";
import type { Grid, View } from "../view";
import { count, short, withUnit } from "../words";
import { sceneInWords, sceneOf } from "./scene";

interface Row {
  readonly variant: string;
  readonly cost_ns_per_s: number;
  readonly cost_least_ns_per_s: number;
  readonly cost_most_ns_per_s: number;
  readonly rms_horizontal_m: number | null;
  readonly r95_m: number | null;
  readonly nees: number | null;
  readonly consistency: string;
  readonly front: boolean;
  readonly dominated_by: string | null;
}

export function compareView(report: Report): View {
  const rows = report.results as readonly Row[];
  const scene = sceneOf(report);
  const front = rows.filter((row) => row.front).sort((a, b) => a.cost_ns_per_s - b.cost_ns_per_s);
  return {
    title: "What does each way of running the filter cost, and how much does it err?",
    scene: sceneInWords(scene),
    answer: answer(rows, front),
    tables: [frontGrid(front)],
    trust: [
      `Errors are of ${count(scene.trials, "trial")}, before each fix; the same to the bit whenever ` +
        "asked for.",
      `Costs are of the filter alone, measured on this machine: the median of ` +
        `${short(report.input["repeat"] as number)} runs, all variants in turn.`,
      "A variant is dominated by another that errs no more and costs less beyond the spread, or " +
        "errs less and costs no more.",
      ...lost(rows.filter((row) => !hasError(row))),
    ],
    charts: [scatter(rows.filter(hasError), front)],
  };
}

function answer(rows: readonly Row[], front: readonly Row[]): string[] {
  const [cheapest, best] = [front[0], front.at(-1)];
  if (!cheapest || !best) return ["No variant is consistent in this scene."];
  const describe = (row: Row): string =>
    `“${row.variant}”, ${microseconds(row)} per second of IMU data for an RMS of ` +
    `${withUnit(row.rms_horizontal_m, "m")}`;
  return [
    `The cheapest that is worth it: ${describe(cheapest)}.`,
    `The most accurate: ${describe(best)}.`,
    `${front.length} of ${rows.length} variants are on the front: whoever wants less error than ` +
      "one of them pays more.",
  ];
}

/** Runs that ended in numbers that are none have no place in the chart. */
const hasError = (row: Row): boolean => row.rms_horizontal_m !== null;

function lost(rows: readonly Row[]): string[] {
  if (rows.length === 0) return [];
  const names = rows.map((row) => row.variant).join("; ");
  return [`Lost its numbers in every trial, and is not in the chart: ${names}.`];
}

const microseconds = (row: Row): string => withUnit(row.cost_ns_per_s / 1000, "µs");

function frontGrid(front: readonly Row[]): Grid {
  return {
    caption: "The front, from the cheapest on",
    headings: ["variant", "cost, µs/s", "least", "most", "RMS, m", "R95, m", "NEES", "consistency"],
    rows: front.map((row) => [
      row.variant,
      ...[row.cost_ns_per_s, row.cost_least_ns_per_s, row.cost_most_ns_per_s].map((ns) =>
        short(ns / 1000),
      ),
      short(row.rms_horizontal_m), short(row.r95_m), short(row.nees), row.consistency,
    ]),
  };
}

function scatter(rows: readonly Row[], front: readonly Row[]): Chart {
  const series = (label: string, colour: number, of: readonly Row[]): Series => ({
    label, style: "points", colour,
    x: of.map((row) => row.cost_ns_per_s), y: of.map((row) => row.rms_horizontal_m ?? NaN),
    names: of.map((row) => `${row.variant} (${row.consistency})`),
  });
  const others = rows.filter((row) => !row.front);
  const isConsistent = (row: Row): boolean => row.consistency === "consistent";
  return {
    id: "cost-against-error",
    title: "Cost against error",
    caption: "Down is more accurate, left is cheaper. Every point is a way of running the filter.",
    x: { label: "cost per second of IMU data", unit: "ns", log: true },
    y: { label: "horizontal RMS error before a fix", unit: "m", log: true },
    series: [
      series("dominated", 0, others.filter(isConsistent)),
      series("not consistent", 1, others.filter((row) => !isConsistent(row))),
      {
        label: "front", style: "line", marked: true, colour: 2,
        x: front.map((row) => row.cost_ns_per_s), y: front.map((row) => row.rms_horizontal_m ?? NaN),
        names: front.map((row) => row.variant),
      },
    ],
    hover: "point",
  };
}
