/** That the charts of a report show the numbers that --json has. */
import { strict as assert } from "node:assert";
import { numberIn, type Row } from "./csv_rows";

type Tables = ReadonlyMap<string, Row[]>;
type Check = (results: unknown, tables: Tables) => void;

function rowsIn(tables: Tables, chart: string, series: string): Row[] {
  return (tables.get(chart) ?? []).filter((row) => row["series"] === series);
}

interface IntervalRow {
  readonly imu: string;
  readonly range: string;
  readonly limit_m: number;
  readonly interval_s: number;
  readonly free_inertial_s: number;
  readonly error_m: number;
}

const kTime = "time between fixes, s";

function checkInterval(results: unknown, tables: Tables): void {
  for (const row of results as IntervalRow[]) {
    const imu = `${row.imu}/${row.range}`;
    const answer = (series: string): number =>
      numberIn(
        rowsIn(tables, "free-against-calibrated", series).find(
          (r) => numberIn(r, "limit, m") === row.limit_m,
        ),
        "time, s",
      );
    assert.equal(answer(`${imu}, calibrated`), row.interval_s);
    assert.equal(answer(`${imu}, free`), row.free_inertial_s);
    const solved = rowsIn(tables, "error-over-interval", imu).find(
      (r) => numberIn(r, kTime) === row.interval_s,
    );
    assert.equal(numberIn(solved, "error before a fix, m"), row.error_m);
  }
}

interface FuseResults {
  readonly rms: { readonly epochs: number; readonly horizontal_m: number };
  readonly outages: readonly { readonly duration_s: number; readonly end_error_h_m: number }[];
  readonly verdicts: Readonly<Record<string, number>>;
}

/** The errors drawn are in single precision: a relative 6e-8, far below 1e-5. */
const kSingle = 1e-5;

function checkFuse(results: unknown, tables: Tables): void {
  const { rms, outages, verdicts } = results as FuseResults;
  const squares = ["north", "east"].map((axis) => {
    const errors = rowsIn(tables, `error-${axis}`, "error").map((r) => numberIn(r, `error ${axis}, m`));
    assert.equal(errors.length, rms.epochs);
    return errors.reduce((sum, e) => sum + e * e, 0) / errors.length;
  });
  const drawn = Math.sqrt((squares[0] as number) + (squares[1] as number));
  assert(Math.abs(drawn / rms.horizontal_m - 1) < kSingle, `RMS ${drawn} m`);
  const branch = rowsIn(tables, "outages", "error").at(-1);
  assert.equal(numberIn(branch, "time since the outage began, s"), outages[0]?.duration_s);
  const end = numberIn(branch, "horizontal error, m");
  assert(Math.abs(end / (outages[0]?.end_error_h_m as number) - 1) < kSingle, `end ${end} m`);
  assert.equal(rowsIn(tables, "verdicts", "fused").length, verdicts["fused"]);
}

interface CompareRow {
  readonly variant: string;
  readonly cost_ns_per_s: number;
  readonly rms_horizontal_m: number | null;
  readonly front: boolean;
}

function checkCompare(results: unknown, tables: Tables): void {
  // What lost its numbers is told in words.
  const rows = (results as CompareRow[]).filter((row) => row.rms_horizontal_m !== null);
  const drawn = tables.get("cost-against-error") ?? [];
  assert.equal(drawn.length, rows.length);
  for (const row of rows) {
    const point = drawn.find((r) => r["name"]?.split(" (")[0] === row.variant);
    assert.equal(numberIn(point, "cost per second of IMU data, ns"), row.cost_ns_per_s);
    const rms_m = numberIn(point, "horizontal RMS error before a fix, m");
    assert.equal(rms_m, row.rms_horizontal_m);
    assert.equal(point?.["series"] === "front", row.front);
  }
}

interface DriftRow {
  readonly imu: string;
  readonly range: string;
  readonly reading: string;
  readonly error_100s_m: number;
}

function checkDrift(results: unknown, tables: Tables): void {
  const rows = results as DriftRow[];
  for (const [reading, chart, range] of [
    ["complete", "drift-complete", "mid"],
    ["paper_assumptions", "drift-paper-assumptions", "low"],
  ] as const) {
    for (const row of rows.filter((r) => r.reading === reading && r.range === range)) {
      const at100s = rowsIn(tables, chart, row.imu).find((r) => numberIn(r, "time, s") === 100);
      assert.equal(numberIn(at100s, "3-D position error, m"), row.error_100s_m);
    }
  }
  const printed = rows.filter((row) => row.reading === "paper");
  const points = rowsIn(tables, "drift-complete", "Table 2 of the paper");
  assert.equal(points.length, 2 * printed.length, "two cells of Table 2 for each class");
}

interface AnalyzeResults {
  readonly worst_s: number;
  readonly budget: readonly { readonly source: string; readonly north_m2: number; readonly east_m2: number }[];
}

/** The sources add up to the true error at the worst fix, which is a point of the other chart. */
function checkAnalyze(results: unknown, tables: Tables): void {
  const { budget, worst_s } = results as AnalyzeResults;
  const bars = tables.get("sources") ?? [];
  assert.equal(bars.length, budget.length);
  const sum = Math.hypot(...bars.map((row) => numberIn(row, "horizontal error, m")));
  const there = rowsIn(tables, "sigma-horizontal", "true")
    .filter((r) => Math.abs(numberIn(r, "time, s") - worst_s) < 1e-6)
    .map((r) => numberIn(r, "horizontal sigma, m"));
  assert(Math.abs(sum / Math.max(...there) - 1) < kSingle, `${sum} m of sources, ${there} m drawn`);
}

interface CampaignResults {
  readonly rms_ned_m: readonly number[];
}

function checkCampaign(results: unknown, tables: Tables): void {
  const found = rowsIn(tables, "axes", "RMS found").map((r) => numberIn(r, "error before a fix, m"));
  assert.deepEqual(found, (results as CampaignResults).rms_ned_m);
  const median = rowsIn(tables, "fan", "median").map((r) => numberIn(r, "horizontal error, m"));
  const most = rowsIn(tables, "fan", "95 % are below").map((r) => numberIn(r, "horizontal error, m"));
  assert.equal(median.length, 30, "a fix every 10 s for 300 s");
  assert(median.every((error, i) => error > 0 && error <= (most[i] as number)));
}

interface ReduceResults {
  readonly terms: readonly { readonly term: string; readonly measured_m: number; readonly kept: boolean }[];
}

function checkReduce(results: unknown, tables: Tables): void {
  for (const { term, measured_m, kept } of (results as ReduceResults).terms) {
    const name = kept ? `${term} (kept)` : term;
    const bar = (tables.get("terms-error") ?? []).find((row) => Object.values(row).includes(name));
    assert.equal(numberIn(bar, "error without the term, m"), measured_m);
  }
}

interface AtlasResults {
  readonly cells: readonly { readonly scene: string; readonly group: string; readonly verdict: string }[];
}

function checkAtlas(results: unknown, tables: Tables): void {
  const { cells } = results as AtlasResults;
  const drawn = tables.get("matrix") ?? [];
  assert.equal(drawn.length, new Set(cells.map((c) => `${c.scene} ${c.group}`)).size);
  const order = ["survives", "degrades", "fails"];
  for (const { scene, group } of cells) {
    const cell = drawn.find((row) => row["variants"] === group && Object.values(row).includes(scene));
    const verdicts = cells.filter((c) => c.scene === scene && c.group === group).map((c) => c.verdict);
    const worst = Math.max(...verdicts.map((verdict) => order.indexOf(verdict)));
    assert.equal(cell?.["series"], order[worst]);
  }
}

export const kNumbers: Readonly<Record<string, Check>> = {
  analyze: checkAnalyze,
  atlas: checkAtlas,
  campaign: checkCampaign,
  compare: checkCompare,
  drift: checkDrift,
  fuse: checkFuse,
  interval: checkInterval,
  reduce: checkReduce,
};
