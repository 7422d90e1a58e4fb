/** The charts of one run of leeway fuse. */
import type { Chart, Series, Span, Values } from "../chart";
import type { Numbers, Report, Table } from "../report";
import type { Outage } from "./fuse";

const kAxes = ["north", "east", "down"] as const;
const kBody = ["forward", "right", "down"] as const;
const kMgPerMps2 = 1000 / 9.80665;
const kDegPerHPerRadps = (3600 * 180) / Math.PI;

interface Run {
  readonly name: string;
  readonly solution: Table;
  readonly spans: readonly Span[];
}

/** @param name  of the drive; empty when the logs were given one by one */
export function chartsOfRun(report: Report, name: string, outages: readonly Outage[]): Chart[] {
  const table = (kind: string): Table | undefined => report.series[`${kind}/${name}`];
  const [solution, track, fixes] = [table("solution"), table("track"), table("fixes")];
  if (!solution || !track) return [];
  const spans = outages.map((o) => ({
    from: o.start_s,
    to: o.start_s + o.duration_s,
    label: "outage",
  }));
  const run = { name, solution, spans };
  return [
    trackChart(track),
    ...kAxes.map((_axis, i) => errorChart(run, i)),
    ...outageCharts(table("outages"), outages),
    biasChart(run, "accelerometer", "b_a_mps2", "mg", kMgPerMps2),
    biasChart(run, "gyro", "b_g_radps", "deg/h", kDegPerHPerRadps),
    ...(fixes ? [nisChart(run, fixes)] : []),
    ...verdictChart(run, report),
  ].map((chart) => named(chart, name));
}

/** Charts of several drives on one page must not share their names. */
function named(chart: Chart, run: string): Chart {
  if (run === "") return chart;
  return { ...chart, id: `${chart.id}-${run}`, title: `${chart.title} (${run})` };
}

const time = { label: "time", unit: "s" };

function trackChart(track: Table): Chart {
  const line = (label: string, colour: number, stem: string): Series => ({
    label, style: "line", colour, dashed: stem !== "",
    x: track.column(`${stem}east_m`), y: track.column(`${stem}north_m`),
    names: Array.from(track.column("t_s"), (t) => `at ${t.toFixed(1)} s`),
  });
  return {
    id: "track", title: "Track", map: true, hover: "point",
    caption: "In metres from where the solution begins. Scale bar at the lower left, north is up.",
    x: { label: "east", unit: "m" },
    y: { label: "north", unit: "m" },
    series: [
      line("solution", 0, ""),
      ...(isGiven(track.column("true_east_m")) ? [line("truth", 1, "true_")] : []),
    ],
  };
}

const isGiven = (values: Numbers): boolean => values.some((v) => Number.isFinite(v));

function scaled(values: Values, factor: number): Values {
  return Float32Array.from(values, (v) => v * factor);
}

function greyIn(spans: readonly Span[]): string {
  return spans.length > 0 ? " Grey: fixes withheld, each time on a branch of its own." : "";
}

function errorChart({ solution, spans }: Run, axis: number): Chart {
  const name = kAxes[axis] as string;
  const letter = name.charAt(0);
  const sigma = solution.highest(`sigma_${letter}_m`) ?? solution.column(`sigma_${letter}_m`);
  const t = solution.column("t_s");
  const series: Series[] = [
    { label: "3 sigma claimed", style: "band", colour: 6, x: t, y: scaled(sigma, -3), high: scaled(sigma, 3) },
  ];
  const hasError = isGiven(solution.column(`error_${letter}_m`));
  if (hasError) {
    series.push(envelope("error", 1, solution, `error_${letter}_m`, 1));
  }
  return {
    id: `error-${name}`,
    title: hasError ? `Error ${name}` : `Claimed uncertainty ${name}`,
    caption: hasError
      ? `Estimate minus truth, within three sigma as the filter claims them.${greyIn(spans)}`
      : `Three sigma as the filter claims them; without truth there is no error to show.${greyIn(spans)}`,
    x: time, y: { label: hasError ? `error ${name}` : `3 sigma ${name}`, unit: "m" }, series, spans, hover: "x",
  };
}

function envelope(label: string, colour: number, table: Table, column: string, factor: number): Series {
  const high = table.highest(column);
  return {
    label, style: "envelope", colour, x: table.column("t_s"),
    y: scaled(table.column(column), factor),
    ...(high ? { high: scaled(high, factor) } : {}),
  };
}

function biasChart(
  { solution, spans }: Run, sensor: string, column: string, unit: string, factor: number,
): Chart {
  const t = solution.column("t_s");
  const series = kBody.flatMap((axis, colour): Series[] => {
    const bias = scaled(solution.column(`${column}_${axis}`), factor);
    const sigma = scaled(solution.column(`sigma_${column}_${axis}`), factor);
    const off = (sign: number): Values =>
      Float32Array.from(bias, (b, i) => b + sign * (sigma[i] as number));
    return [
      { label: `${axis} ± 1 sigma`, style: "band", colour, x: t, y: off(-1), high: off(1) },
      envelope(axis, colour, solution, `${column}_${axis}`, factor),
    ];
  });
  return {
    id: `bias-${sensor}`, title: `Bias of the ${sensor}`,
    caption: "As the filter estimates it, by body axis, with one sigma.",
    x: time, y: { label: `${sensor} bias`, unit }, series, spans, hover: "x",
  };
}

function nisChart({ spans }: Run, fixes: Table): Chart {
  const t = fixes.column("t_s");
  const points = (label: string, y: Values): Series => ({ label, style: "points", colour: 0, x: t, y });
  const most = fixes.highest("nis");
  return {
    id: "nis", title: "Is each fix where the filter expects it?",
    caption:
      "Normalized innovation squared of the fixes. An honest filter has 95 % of them within the " +
      "dashed band.",
    x: time, y: { label: "NIS", unit: "", log: true },
    series: [
      points(most ? "NIS, least" : "NIS", fixes.column("nis")),
      ...(most ? [{ ...points("NIS, greatest", most), colour: 1 }] : []),
      { label: "band, low", style: "line", dashed: true, colour: 2, x: t, y: fixes.column("nis_low") },
      { label: "band, high", style: "line", dashed: true, colour: 1, x: t, y: fixes.column("nis_high") },
    ],
    spans, hover: "x",
  };
}

function verdictChart({ name, spans }: Run, report: Report): Chart[] {
  const { verdicts } = report.results as { verdicts: Readonly<Record<string, number>> };
  const met = Object.keys(verdicts).flatMap((verdict) => {
    const t = report.series[`verdict/${name}/${verdict}`]?.column("t_s");
    return t ? [{ verdict, t }] : [];
  });
  if (met.length === 0) return [];
  return [
    {
      id: "verdicts", title: "What became of the inputs",
      caption: `Every fix, and whatever else was not simply taken.${greyIn(spans)}`,
      x: time, y: { label: "", unit: "", categories: met.map(({ verdict }) => verdict) },
      series: met.map(({ verdict, t }, row) => ({
        label: verdict, style: "points", colour: row, x: t, y: new Float32Array(t.length).fill(row),
      })),
      spans, hover: "point",
    },
  ];
}

function outageCharts(growth: Table | undefined, outages: readonly Outage[]): Chart[] {
  if (!growth || outages.length === 0) return [];
  const of = Array.from(growth.column("outage"));
  const names = of.map((i) => `outage from ${outages[i]?.start_s} s`);
  const points = (label: string, colour: number, column: string): Series => ({
    label, style: "points", colour, names,
    x: growth.column("since_s"), y: growth.column(column),
  });
  return [
    {
      id: "outages", title: "While fixes are withheld",
      caption: "Horizontal error of the branches without fixes, beside what they claim (1 sigma).",
      x: { label: "time since the outage began", unit: "s" },
      y: { label: "horizontal error", unit: "m" },
      series: [points("error", 1, "error_h_m"), points("claimed sigma", 0, "sigma_h_m")],
      hover: "point",
    },
  ];
}
