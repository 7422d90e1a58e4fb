/** leeway interval: how often each IMU needs a fix. */
import type { Chart, Level, Series } from "../chart";
import type { Report, Table } from "../report";
import type { Grid, View } from "../view";
import { count, duration, list, percent, short, withUnit } from "../words";
import { metricOf, sceneInWords, sceneOf, type SceneInput } from "./scene";

interface Confirm {
  readonly trials: number;
  readonly rms_over_sigma: number;
  readonly error_over_true: number;
  readonly agrees: boolean;
  readonly nees: number;
  readonly nees_low: number;
  readonly nees_high: number;
  readonly diverged: number;
  readonly monte_carlo_interval_s: number | null;
}

interface Row {
  readonly imu: string;
  readonly range: string | null;
  /** As it is asked for: "5m", "5m+5%". */
  readonly limit: string;
  readonly limit_m: number;
  /** Of the way since the last fix, allowed on top. */
  readonly share: number;
  readonly interval_s: number | null;
  /** What the answer rests on; answer_s is the trials' where they contradict. */
  readonly mark: "linear" | "checked" | "by trials";
  readonly answer_s: number | null;
  readonly free_inertial_s: number | null;
  readonly consistent: boolean | null;
  readonly confirm: Confirm | null;
  readonly outcome: "solved" | "never" | "always";
  readonly error_m: number;
  readonly claimed_error_m: number;
  readonly settled: boolean;
  readonly covariance_step_effect: number;
}

/** An outage that the scene scripts. */
interface Coast {
  readonly imu: string;
  readonly range: string | null;
  readonly start_s: number;
  readonly duration_s: number;
  readonly end_s: number;
  readonly end_error_m: number;
  readonly end_allowed_m: number;
  readonly keeps_limit: boolean;
  readonly coast_s: number | null;
}

interface Aided {
  readonly aiding: string;
  readonly is_the_scenes: boolean;
  readonly imu: string;
  readonly limit: string;
  readonly limit_m: number;
  readonly share: number;
  readonly interval_s: number | null;
}

export function intervalView(report: Report): View {
  const rows = report.results as readonly Row[];
  if (report.outages !== undefined) return outagesView(report, report.outages as readonly Coast[]);
  const scene = sceneOf(report);
  const imus = [...new Set(rows.map(nameOf))];
  const limits = rows.filter((row, i) => rows.findIndex((r) => r.limit === row.limit) === i);
  return {
    title: "How long can an IMU go between GNSS fixes?",
    scene: sceneInWords(scene, false),
    answer: limits.map((limit) => answerFor(rows, limit)),
    tables: [
      answersGrid(rows, imus, limits),
      ...aidedGrid((report.aiding ?? []) as readonly Aided[]),
      ...confirmGrid(rows),
    ],
    trust: trust(rows, scene),
    charts: [
      errorChart(report, rows, imus, limits, scene),
      timesChart(rows, imus, limits),
      growthChart(report, imus, limits, scene),
      claimChart(report, imus),
    ],
  };
}

/** A scene with outages is asked how far each carries the error, and how long the limit allows. */
function outagesView(report: Report, coasts: readonly Coast[]): View {
  const scene = sceneOf(report);
  const kept = coasts.filter((c) => c.keeps_limit);
  return {
    title: "How far does an outage carry the error?",
    scene: sceneInWords(scene, true),
    answer: [
      kept.length === coasts.length
        ? "Every IMU stays within the limit to the end of every outage."
        : `${kept.length} of ${count(coasts.length, "outage")} end within the limit.`,
    ],
    tables: [
      {
        caption:
          "Error before the first fix after each outage, and the coast time: how long without " +
          "fixes until the limit, from the outage's start",
        headings: ["IMU", "outage at, s", "for, s", "error at its end, m", "limit, m", "keeps it",
          "coast time, s"],
        rows: coasts.map((c) => [
          nameOf(c), short(c.start_s), short(c.duration_s), short(c.end_error_m), short(c.end_allowed_m),
          c.keeps_limit ? "yes" : `no, at ${withUnit(c.end_s, "s")}`,
          c.coast_s === null ? "to the scene's end" : short(c.coast_s),
        ]),
      },
    ],
    trust: [
      `The error is ${metricOf(scene)}, by covariance analysis: linearized along the true motion, ` +
        "against sensors that also have the errors the filter does not model.",
    ],
    charts: [],
  };
}

function aidedGrid(aided: readonly Aided[]): Grid[] {
  const first = aided[0];
  if (!first) return [];
  return [
    {
      caption:
        `What the vehicle tells beside its receiver: the interval of ${first.imu} at ` +
        `${spokenLimit(first)}, linear`,
      headings: ["aiding", "interval, s", ""],
      rows: aided.map((a) => [a.aiding, short(a.interval_s), a.is_the_scenes ? "the scene's" : ""]),
    },
  ];
}

const nameOf = (row: { readonly imu: string; readonly range: string | null }): string => (row.range ? `${row.imu}/${row.range}` : row.imu);

type Limit = Pick<Row, "limit" | "limit_m" | "share">;

const spokenLimit = ({ limit_m, share }: Limit): string =>
  withUnit(limit_m, "m") + (share > 0 ? ` + ${percent(share)} of the way` : "");

/** A class without its "mid", which is what it is when nothing else is said. */
const spoken = (imu: string): string => imu.replace(/\/mid$/, "");

/** The interval to rely on: that of the trials where they contradict the linear analysis. */
const reliable = (row: Row): number | null => row.answer_s;

const signOf = ({ mark }: Row): string =>
  mark === "linear" ? "" : mark === "checked" ? " ✓" : " ✗";

function answerFor(rows: readonly Row[], limit: Limit): string {
  const asked = rows.filter((row) => row.limit === limit.limit);
  const name = (row: Row): string => spoken(nameOf(row));
  const parts: string[] = [];
  const solved = asked.filter((row) => reliable(row) !== null);
  if (solved.length > 0) parts.push(`a fix is needed every ${list(solved.map(needOf))}`);
  const never = asked.filter((row) => row.outcome === "never").map(name);
  if (never.length === asked.length) parts.push("no IMU here can, however often there is a fix");
  else if (never.length > 0) parts.push(`${list(never)} cannot, however often there is a fix`);
  const unsure = asked.filter((row) => row.outcome !== "never" && reliable(row) === null).map(name);
  if (unsure.length > 0) parts.push(`for ${list(unsure)} the trials found no interval`);
  return `To stay within ${spokenLimit(limit)}: ${parts.join("; ")}.`;
}

/** @pre it has an interval */
function needOf(row: Row): string {
  const sure = row.mark === "by trials" ? " (by the trials)" : signOf(row);
  const more = row.outcome === "always" && row.mark !== "by trials" ? "half of the scene, " : "";
  return `${more}${duration(reliable(row) as number)} by ${spoken(nameOf(row))}${sure}`;
}

function answersGrid(rows: readonly Row[], imus: readonly string[], limits: readonly Limit[]): Grid {
  const cell = (imu: string, limit: Limit): string => {
    const row = rows.find((r) => nameOf(r) === imu && r.limit === limit.limit);
    if (!row) return "-";
    return `${short(row.answer_s)}${signOf(row)} (${short(row.free_inertial_s)})`;
  };
  const anyTrials = rows.some((row) => row.mark !== "linear");
  return {
    caption:
      "Longest time between fixes, s; in brackets the time that it lasts without any, from a " +
      "perfect start, s" +
      (anyTrials ? ". ✓ checked by trials, ✗ by trials, which contradict the analysis." : "."),
    headings: ["IMU", ...limits.map(spokenLimit)],
    rows: imus.map((imu) => [imu, ...limits.map((limit) => cell(imu, limit))]),
  };
}

function confirmGrid(rows: readonly Row[]): Grid[] {
  const confirmed = rows.filter((row) => row.confirm !== null);
  if (confirmed.length === 0) return [];
  return [
    {
      caption: "Monte Carlo trials of the scene's estimator at the intervals of the analysis",
      headings: ["IMU", "limit", "interval, s", "trials", "RMS / claimed", "error / linear", "NEES",
        "95 % band", "verdict"],
      rows: confirmed.map((row) => {
        const c = row.confirm as Confirm;
        return [
          nameOf(row), spokenLimit(row), short(row.interval_s), String(c.trials),
          ratio(c.rms_over_sigma), ratio(c.error_over_true), ratio(c.nees),
          `${c.nees_low.toFixed(2)} to ${c.nees_high.toFixed(2)}`,
          c.agrees ? "✓" : `✗ ${foundBy(c)}`,
        ];
      }),
    },
  ];
}

const ratio = (value: number): string => (value < 100 ? value.toFixed(3) : short(value));

function foundBy({ monte_carlo_interval_s: seconds }: Confirm): string {
  return seconds === null ? "none found" : `by trials ${withUnit(seconds, "s")}`;
}

function trust(rows: readonly Row[], scene: SceneInput): string[] {
  const step = Math.max(...rows.map((row) => row.covariance_step_effect));
  return [
    `“Within” means ${metricOf(scene)} just before any fix that counts: all after the time to settle, ` +
      "or those at the scene's end.",
    ...(scene.limit_source ? [`The limit is that of ${scene.limit_source}.`] : []),
    "The intervals are those of a covariance analysis: the filter's own equations, linearized " +
      "along the true motion, against sensors that also have the errors the filter does not model.",
    ...confirmationInWords(rows),
    ...honesty(rows),
    `${rows.filter((row) => row.settled).length} of ${rows.length} answers are of a filter that ` +
      "has settled; the others hold for the end of the scene.",
    `Halving the step of the analysis changes an error by ${short(100 * step)} % at most.`,
  ];
}

function confirmationInWords(rows: readonly Row[]): string[] {
  const tried = rows.filter((row) => row.confirm !== null);
  if (tried.length === 0) {
    return ["Not confirmed: no trials of the nonlinear filter were run. Add --confirm 200."];
  }
  const trials = tried.map((row) => (row.confirm as Confirm).trials);
  const [fewest, most] = [Math.min(...trials), Math.max(...trials)];
  const failed = tried.filter((row) => row.mark === "by trials");
  const name = (row: Row): string => `${spoken(nameOf(row))} at ${spokenLimit(row)}`;
  const words = [
    `${tried.length - failed.length} of ${count(tried.length, "answer")} checked (✓) by ` +
      `${fewest === most ? fewest : `${fewest} to ${most}`} Monte Carlo trials of the scene's ` +
      "estimator each: its error is the one that the analysis says, within 10 %.",
  ];
  const untried = rows.filter((row) => row.confirm === null && row.interval_s !== null).length;
  if (untried > 0) words.push(`Not tried: the other ${count(untried, "answer")}, by the analysis alone.`);
  if (failed.length > 0) {
    words.push(
      `Contradicted (✗): ${list(failed.map(name))}. There the trials err otherwise than the ` +
        "analysis says, and the answer above is the interval at which the trials met the limit, if any.",
    );
  }
  return words;
}

function honesty(rows: readonly Row[]): string[] {
  // What trials contradict says nothing of the linear claim.
  const ratios = rows
    .filter((row) => row.claimed_error_m > 0 && row.mark !== "by trials")
    .map((row) => row.error_m / row.claimed_error_m);
  const [least, most] = [Math.min(...ratios), Math.max(...ratios)];
  if (ratios.length === 0) return [];
  if (most < 1.05 && least > 0.95) {
    return ["The filter is honest: what it claims is within 5 % of the true error at every answer."];
  }
  return [
    `The true error is ${short(least)} to ${short(most)} times what the filter claims: above 1 it ` +
      "is optimistic, because there are errors that it does not model.",
  ];
}

function curves(report: Report, imus: readonly string[], kind: string): [string, number, Table][] {
  return imus.flatMap((imu, i) => {
    const table = report.series[`${kind}/${imu}`];
    return table ? [[imu, i, table] as [string, number, Table]] : [];
  });
}

/** Of limits that stay where they are. */
const levels = (limits: readonly Limit[]): Level[] =>
  limits.filter(({ share }) => share === 0)
    .map((limit) => ({ at: limit.limit_m, label: `limit ${spokenLimit(limit)}` }));

function errorChart(
  report: Report, rows: readonly Row[], imus: readonly string[], limits: readonly Limit[],
  scene: SceneInput,
): Chart {
  const lines = curves(report, imus, "curve").map(
    ([imu, colour, table]): Series => ({
      label: imu, style: "line", marked: true, colour,
      x: table.column("interval_s"), y: table.column("true_m"),
    }),
  );
  // An error of trials that diverged would dwarf the chart; the table has it.
  const trialled = rows.filter((row) => row.confirm?.diverged === 0 && row.interval_s !== null);
  if (trialled.length > 0) {
    lines.push({
      label: "Monte Carlo", style: "points", colour: 6,
      x: trialled.map((row) => row.interval_s as number),
      y: trialled.map((row) => row.error_m * (row.confirm as Confirm).error_over_true),
      names: trialled.map((row) => `${nameOf(row)}, ${spokenLimit(row)}`),
    });
  }
  return {
    id: "error-over-interval",
    title: "Error against the time between fixes",
    caption:
      `True error (${scene.metric}) just before a fix. Where a curve crosses a limit ` +
      "is the longest interval. Markers are what was computed; trials that diverged are left out.",
    x: { label: "time between fixes", unit: "s", log: true },
    y: { label: "error before a fix", unit: "m", log: true },
    series: lines, levels: levels(limits), hover: "point",
  };
}

function timesChart(rows: readonly Row[], imus: readonly string[], limits: readonly Limit[]): Chart {
  const solved = (imu: string, pick: (row: Row) => number | null): [number[], number[]] => {
    const own = rows.filter((row) => nameOf(row) === imu && pick(row) !== null);
    return [own.map((row) => row.limit_m), own.map((row) => pick(row) as number)];
  };
  const series = imus.flatMap((imu, colour): Series[] => {
    const [x, y] = solved(imu, (row) => row.interval_s);
    const [freeX, freeY] = solved(imu, (row) => row.free_inertial_s);
    return [
      { label: `${imu}, calibrated`, style: "line", marked: true, colour, x, y },
      { label: `${imu}, free`, style: "line", dashed: true, marked: true, colour, x: freeX, y: freeY },
    ];
  });
  return {
    id: "free-against-calibrated",
    title: "With fixes and without",
    caption:
      "Solid: the longest time between fixes that calibrate the sensors. Dashed: the time to the " +
      "limit from a perfect start without any fix. " +
      `${count(limits.length, "limit")}.`,
    x: { label: "limit", unit: "m", log: true },
    y: { label: "time", unit: "s", log: true },
    series, hover: "point",
  };
}

function growthChart(
  report: Report, imus: readonly string[], limits: readonly Limit[], scene: SceneInput,
): Chart {
  return {
    id: "free-inertial",
    title: "Growth of the error without any fix",
    caption: `Error (${scene.metric}) from a perfect start with uncalibrated sensors.`,
    x: { label: "time", unit: "s", log: true },
    y: { label: "error", unit: "m", log: true },
    series: curves(report, imus, "free_inertial").map(
      ([imu, colour, table]): Series => ({
        label: imu, style: "line", colour, x: table.column("t_s"), y: table.column("true_m"),
      }),
    ),
    levels: levels(limits), hover: "point",
  };
}

function claimChart(report: Report, imus: readonly string[]): Chart {
  return {
    id: "claimed-against-true",
    title: "Does the filter know how wrong it is?",
    caption:
      "True error over the error that the filter claims. At 1 the filter is honest, above 1 it is " +
      "optimistic.",
    x: { label: "time between fixes", unit: "s", log: true },
    y: { label: "true / claimed error", unit: "" },
    series: curves(report, imus, "curve").map(([imu, colour, table]): Series => {
      const claimed = table.column("claimed_m");
      return {
        label: imu, style: "line", marked: true, colour, x: table.column("interval_s"),
        y: Array.from(table.column("true_m"), (v, i) => v / (claimed[i] as number)),
      };
    }),
    levels: [{ at: 1, label: "honest" }], hover: "point",
  };
}
