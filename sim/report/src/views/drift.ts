/** leeway drift: figure 2 and Table 2 of the source paper. */
import type { Chart, Series } from "../chart";
import type { Report } from "../report";
import type { Grid, View } from "../view";
import { duration, list, short, withUnit } from "../words";

interface Row {
  readonly imu: string;
  readonly range: "low" | "mid" | "high";
  readonly reading: "paper" | "paper_assumptions" | "complete";
  readonly error_100s_m: number | null;
  readonly error_100s_p2_5_m: number | null;
  readonly error_100s_p97_5_m: number | null;
  readonly time_to_100m_s: number | null;
}

const kTableS = 100;
const kTableM = 100;
const kReadings = { paper_assumptions: "as the paper assumes", complete: "complete model" };

export function driftView(report: Report): View {
  const rows = report.results as readonly Row[];
  const imus = [...new Set(rows.map((row) => row.imu))];
  const { trials, latitude_deg, imu_rate_hz } = report.input;
  return {
    title: "How far does each IMU drift on its own?",
    scene: [
      `At rest at latitude ${latitude_deg}°, from a perfect start, without any fix; IMU at ` +
        `${imu_rate_hz} Hz, ${trials} trials of the complete model.`,
    ],
    answer: answer(rows, imus),
    tables: [grid(rows, imus)],
    trust: [
      "Complete model: every bias of both triads is drawn for each trial (1 sigma: low end, " +
        "geometric mean or high end of the range of the class), and the noise is added. RMS of " +
        "the 3-D error; in brackets the range of 95 % of the trials.",
      "As the paper assumes: the low end of the accelerometer drift on all three axes at once, no " +
        "gyro drift, no noise. That reproduces the printed cells.",
      "The paper's automotive cell contradicts its own gyro drift, which tilts the platform and " +
        "adds an error that grows with the cube of time.",
    ],
    charts: [
      chart(report, rows, imus, "complete"),
      chart(report, rows, imus, "paper_assumptions"),
    ],
  };
}

function answer(rows: readonly Row[], imus: readonly string[]): string[] {
  const complete = imus.flatMap((imu) => {
    const row = rows.find((r) => r.imu === imu && r.range === "mid" && r.reading === "complete");
    return row ? [row] : [];
  });
  const errors = complete.map((row) => `${withUnit(row.error_100s_m, "m")} (${row.imu})`);
  const times = complete.map((row) =>
    row.time_to_100m_s === null ? `not reached (${row.imu})` : `${duration(row.time_to_100m_s)} (${row.imu})`,
  );
  return [
    `Error after ${kTableS} s: ${list(errors)}, for the middle of each class.`,
    `Time to an error of ${kTableM} m: ${list(times)}.`,
  ];
}

function grid(rows: readonly Row[], imus: readonly string[]): Grid {
  const cell = (imu: string, reading: Row["reading"], range: Row["range"]): string => {
    const row = rows.find((r) => r.imu === imu && r.reading === reading && r.range === range);
    if (!row) return "-";
    const error = short(row.error_100s_m);
    if (reading !== "complete") return error;
    return `${error} [${short(row.error_100s_p2_5_m)}, ${short(row.error_100s_p97_5_m)}]`;
  };
  return {
    caption: `3-D position error after ${kTableS} s, m`,
    headings: ["class", "paper", "its assumptions", "complete: low", "mid", "high"],
    rows: imus.map((imu) => [
      imu, cell(imu, "paper", "low"), cell(imu, "paper_assumptions", "low"),
      cell(imu, "complete", "low"), cell(imu, "complete", "mid"), cell(imu, "complete", "high"),
    ]),
  };
}

/** The cells of Table 2 are points of these curves: the error at 100 s, and the time to 100 m. */
function cells(rows: readonly Row[]): Series {
  const points = rows.filter((row) => row.reading === "paper").flatMap((row) => [
    { x: kTableS, y: row.error_100s_m, name: `${row.imu}: after ${kTableS} s` },
    { x: row.time_to_100m_s, y: kTableM, name: `${row.imu}: time to ${kTableM} m` },
  ]);
  const given = points.filter((p) => p.x !== null && p.y !== null);
  return {
    label: "Table 2 of the paper", style: "points", colour: 5,
    x: given.map((p) => p.x as number), y: given.map((p) => p.y as number),
    names: given.map((p) => p.name),
  };
}

function chart(
  report: Report, rows: readonly Row[], imus: readonly string[], reading: keyof typeof kReadings,
): Chart {
  const range = reading === "complete" ? "mid" : "low";
  const series = imus.flatMap((imu, colour): Series[] => {
    const table = report.series[`curve/${imu}/${range}/${reading}`];
    if (!table) return [];
    const x = table.column("t_s");
    const rms: Series = { label: imu, style: "line", colour, x, y: table.column("error_m") };
    if (reading !== "complete") return [rms];
    const [y, high] = [table.column("p2_5_m"), table.column("p97_5_m")];
    return [{ label: `${imu}, 95 % of trials`, style: "band", colour, x, y, high }, rms];
  });
  const isComplete = reading === "complete";
  return {
    id: `drift-${reading.replace("_", "-")}`,
    title: `Error against time, ${kReadings[reading]}`,
    caption: isComplete
      ? "RMS of the 3-D error of the middle of each class, with the range of 95 % of the trials. " +
        "Points: the paper's table."
      : "One run at the low end of each class, as in figure 2 of the paper. Points: its table.",
    x: { label: "time", unit: "s", log: true },
    y: { label: "3-D position error", unit: "m", log: true },
    series: [...series, cells(rows)],
    levels: [{ at: kTableM, label: `${kTableM} m` }], hover: "point",
  };
}
