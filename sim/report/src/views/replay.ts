/** leeway replay: how often a fix has to come on recorded logs, measured and predicted. */
import type { Chart, Series } from "../chart";
import type { Report } from "../report";
import type { Grid, View } from "../view";
import { count, list, short, withUnit } from "../words";

/** A figure and its 90 % band; null where there is none. */
interface Banded {
  readonly value: number | null;
  readonly low: number | null;
  readonly high: number | null;
}

interface Outages {
  readonly duration_s: number;
  readonly outages: number;
  readonly end_r50_m: Banded;
  readonly end_r68_m: Banded;
  readonly end_r95_m: Banded;
  readonly largest_r50_m: Banded;
  readonly largest_r68_m: Banded;
  readonly largest_r95_m: Banded;
}

interface Errors {
  readonly interval_s: number;
  readonly fixes: number;
  readonly measured_m: Banded;
  readonly predicted_m: number | null;
}

type Outcome = "found" | "shorter" | "longer" | "unknown";

interface Interval {
  readonly limit_m: number;
  readonly measured: Outcome;
  readonly measured_s: Banded;
  readonly predicted: Outcome;
  readonly predicted_s: number | null;
  readonly predicted_over_measured: number | null;
}

interface Answer {
  readonly outages: readonly Outages[];
  readonly errors: readonly Errors[];
  readonly intervals: readonly Interval[];
}

type Log = { readonly log: string } & (
  | { readonly has_solution: false }
  | (Answer & {
    readonly has_solution: true;
    readonly against: "reference" | "gnss";
    readonly first_s: number;
    readonly settled_s: number;
    readonly last_s: number;
    readonly not_predicted: string | null;
  })
);

interface Results {
  readonly metric: string;
  readonly logs: readonly Log[];
  readonly pooled: Answer;
}

interface Input {
  readonly imu: string;
  readonly vehicle: string;
}

export function replayView(report: Report): View {
  const { metric, logs, pooled } = report.results as Results;
  const { imu, vehicle } = report.input as unknown as Input;
  return {
    title: "How often does a fix have to come, on recorded logs?",
    scene: [
      `${count(logs.length, "log")}: ${list(logs.map((log) => log.log))}.`,
      `IMU model ${imu}, vehicle ${vehicle}; error by ${metric}.`,
    ],
    answer: pooled.intervals.map((interval) => inWords(interval)),
    tables: [intervalGrid(logs, pooled), outageGrid(pooled.outages)],
    trust: trust(logs),
    charts: [
      ...(pooled.outages.length > 0 ? [outageChart(pooled.outages)] : []),
      ...(pooled.errors.length > 0 ? [intervalChart(pooled, metric)] : []),
    ],
    details: [errorGrid(pooled.errors)],
  };
}

function spoken(outcome: Outcome, interval_s: number | null): string {
  if (outcome === "unknown") return "-";
  const sign = outcome === "shorter" ? "below " : outcome === "longer" ? "at least " : "";
  return `${sign}${withUnit(interval_s, "s")}`;
}

function bandOf(b: Banded, unit: string): string {
  return b.low === null ? "-" : `${short(b.low)} to ${withUnit(b.high, unit)}`;
}

function inWords(i: Interval): string {
  const band = i.measured_s.low === null ? "" : ` (90 % band ${bandOf(i.measured_s, "s")})`;
  const ratio = i.predicted_over_measured === null
    ? "" : `, ${i.predicted_over_measured.toFixed(2)} of it`;
  return `Within ${withUnit(i.limit_m, "m")}: a fix every ` +
    `${spoken(i.measured, i.measured_s.value)}${band}. ` +
    `Predicted: ${spoken(i.predicted, i.predicted_s)}${ratio}.`;
}

function trust(logs: readonly Log[]): string[] {
  const lines = logs.map((log) => {
    if (!log.has_solution) return `${log.log}: no solution.`;
    const against = log.against === "reference" ? "the reference" : "the withheld fixes";
    return `${log.log}: all fixes until ${short(log.settled_s)} s, fewer until ` +
      `${short(log.last_s)} s; errors against ${against}` +
      (log.not_predicted === null ? "." : `; not predicted: ${log.not_predicted}`);
  });
  return [
    ...lines,
    "Bands hold 90 %, by drawing blocks of time that are twice as long as errors overlap.",
    "The prediction is a covariance analysis on each log's own motion, with the same IMU model " +
      "and aiding, and noise as large as the navigator has found it.",
  ];
}

function intervalGrid(logs: readonly Log[], pooled: Answer): Grid {
  const rowsOf = (name: string, answer: Answer): string[][] =>
    answer.intervals.map((i) => [
      name, short(i.limit_m), spoken(i.measured, i.measured_s.value), bandOf(i.measured_s, "s"),
      spoken(i.predicted, i.predicted_s), short(i.predicted_over_measured),
    ]);
  return {
    caption: "The interval between fixes that keeps a limit",
    headings: ["log", "limit, m", "measured", "90 % band", "predicted", "predicted / measured"],
    rows: [
      ...logs.flatMap((log) => (log.has_solution ? rowsOf(log.log, log) : [])),
      ...(logs.length > 1 ? rowsOf("all", pooled) : []),
    ],
  };
}

function outageGrid(outages: readonly Outages[]): Grid {
  return {
    caption: "Outages that begin while moving: horizontal error, m",
    headings: ["duration, s", "outages", "end R50", "R68", "R95", "largest R50", "R68", "R95"],
    rows: outages.map((o) => [
      short(o.duration_s), String(o.outages),
      ...[o.end_r50_m, o.end_r68_m, o.end_r95_m, o.largest_r50_m, o.largest_r68_m, o.largest_r95_m]
        .map((b) => short(b.value)),
    ]),
  };
}

function errorGrid(errors: readonly Errors[]): Grid {
  return {
    caption: "Error just before a fix, by the time between fixes",
    headings: ["interval, s", "fixes", "measured, m", "90 % band", "predicted, m"],
    rows: errors.map((e) => [
      short(e.interval_s), String(e.fixes), short(e.measured_m.value), bandOf(e.measured_m, "m"),
      short(e.predicted_m),
    ]),
  };
}

const numbers = (values: readonly (number | null)[]): number[] => values.map((v) => v ?? NaN);

/** Where there are bands; a short log has none. */
function bandSeries(label: string, x: readonly number[], bands: readonly Banded[]): Series[] {
  const there = x.flatMap((at, i) => (bands[i]?.low == null ? [] : [{ at, band: bands[i] }]));
  if (there.length === 0) return [];
  return [{
    label, style: "band", colour: 6, x: there.map((t) => t.at),
    y: numbers(there.map((t) => t.band.low)), high: numbers(there.map((t) => t.band.high)),
  }];
}

function outageChart(all: readonly Outages[]): Chart {
  const outages = all.filter((o) => o.outages > 0);
  const x = outages.map((o) => o.duration_s);
  const line = (label: string, colour: number, bands: readonly Banded[]): Series => ({
    label, style: "line", marked: true, colour, x, y: numbers(bands.map((b) => b.value)),
  });
  return {
    id: "error-since-fix",
    title: "Error against the time since the last fix",
    caption: "Percentiles of the horizontal error at the end of outages, over all logs, and the " +
      "90 % band of the highest.",
    x: { label: "time since the last fix", unit: "s", log: true },
    y: { label: "horizontal error", unit: "m", log: true },
    series: [
      ...bandSeries("90 % band of R95", x, outages.map((o) => o.end_r95_m)),
      line("R95", 1, outages.map((o) => o.end_r95_m)),
      line("R68", 2, outages.map((o) => o.end_r68_m)),
      line("R50", 0, outages.map((o) => o.end_r50_m)),
    ],
    hover: "x",
  };
}

function intervalChart(pooled: Answer, metric: string): Chart {
  const told = pooled.errors.filter((e) => e.measured_m.value !== null);
  const x = told.map((e) => e.interval_s);
  const measured = told.map((e) => e.measured_m);
  return {
    id: "error-over-interval",
    title: "Error against the time between fixes",
    caption: `Error just before a fix (${metric}), measured over all logs with its 90 % band, and ` +
      "predicted by covariance analysis on their motion.",
    x: { label: "time between fixes", unit: "s", log: true },
    y: { label: `error (${metric})`, unit: "m", log: true },
    series: [
      ...bandSeries("90 % band", x, measured),
      {
        label: "measured", style: "line", marked: true, colour: 0, x,
        y: numbers(measured.map((b) => b.value)),
      },
      {
        label: "predicted", style: "line", dashed: true, colour: 1, x,
        y: numbers(told.map((e) => e.predicted_m)),
      },
    ],
    levels: pooled.intervals.map((i) => ({ at: i.limit_m, label: `limit ${short(i.limit_m)} m` })),
    hover: "x",
  };
}
