/** leeway fuse: the solution of each run, its error, and what became of the fixes. */
import type { Report } from "../report";
import type { Grid, View } from "../view";
import { count, duration, list, short, withUnit } from "../words";
import { chartsOfRun } from "./run_charts";

interface Rms {
  readonly epochs: number;
  readonly horizontal_m: number | null;
  readonly vertical_m: number | null;
  readonly velocity_mps: number | null;
  readonly attitude_deg: number | null;
}

interface Solution {
  readonly first_s: number;
  readonly last_s: number;
}

export interface Outage {
  readonly drive?: string;
  readonly start_s: number;
  readonly duration_s: number;
  readonly end_error_h_m: number | null;
  readonly end_sigma_h_m: number | null;
  readonly max_error_h_m: number | null;
  readonly against: "reference" | "gnss" | null;
}

interface Summary {
  readonly duration_s: number;
  readonly count: number;
  readonly rms_end_h_m: number | null;
  readonly median_end_h_m: number | null;
  readonly max_end_h_m: number | null;
  readonly rms_over_sigma_h: number | null;
}

interface Results {
  readonly outages: readonly Outage[];
  readonly outage_summary: readonly Summary[];
  readonly verdicts: Readonly<Record<string, number>>;
  readonly nis_mean: number | null;
  readonly nis_dof_mean: number | null;
  readonly rms?: Rms;
  readonly solution?: Solution | null;
  readonly drives?: readonly { readonly drive: string; readonly solution: Solution | null }[];
}

export function fuseView(report: Report): View {
  const results = report.results as Results;
  const runs = results.drives?.map((d) => d.drive) ?? [""];
  return {
    title: "The fused solution, and how far it is off",
    scene: scene(report, results),
    answer: answer(results),
    tables: outageGrid(results.outage_summary),
    trust: trust(results),
    charts: runs.flatMap((run) =>
      chartsOfRun(report, run, results.outages.filter((o) => (o.drive ?? "") === run)),
    ),
  };
}

function scene({ input }: Report, results: Results): string[] {
  const text = (key: string): string => String(input[key]);
  const logs = results.drives
    ? `${count(results.drives.length, "recorded drive")}: ${list(results.drives.map((d) => d.drive))}`
    : `IMU log ${text("imu")}, GNSS log ${text("gnss")}` +
      (input["truth"] ? `, errors against ${text("truth")}` : "");
  const { solution } = results;
  return [
    `${logs}.`,
    `IMU model ${text("imu_model")}, strapdown ${text("scheme")}, vehicle aiding ${text("vehicle")}.`,
    ...(solution ? [`Solution from ${short(solution.first_s)} s to ${short(solution.last_s)} s.`] : []),
  ];
}

function answer(results: Results): string[] {
  const { rms, outage_summary: outages } = results;
  const words: string[] = [];
  if (rms && rms.epochs > 0) {
    words.push(
      `The position is off by ${withUnit(rms.horizontal_m, "m")} horizontally and ` +
        `${withUnit(rms.vertical_m, "m")} vertically (RMS over ${count(rms.epochs, "epoch")}).`,
    );
  } else {
    words.push("There is no truth to measure the solution against; its claims are shown instead.");
  }
  for (const s of outages.filter((o) => o.count > 0)) {
    words.push(
      `Without fixes for ${duration(s.duration_s)} the error grows to ` +
        `${withUnit(s.rms_end_h_m, "m")} (RMS of ${count(s.count, "outage")}; the largest ` +
        `${withUnit(s.max_end_h_m, "m")}).`,
    );
  }
  const { fused, gated } = results.verdicts;
  words.push(`${fused ?? 0} fixes were used, ${gated ?? 0} refused by the gate.`);
  return words;
}

function outageGrid(summary: readonly Summary[]): Grid[] {
  if (summary.length === 0) return [];
  return [
    {
      caption: "Horizontal error at the end of outages, each withheld alone",
      headings: ["duration, s", "outages", "RMS, m", "median, m", "largest, m", "RMS / sigma"],
      rows: summary.map((s) => [
        short(s.duration_s), String(s.count), short(s.rms_end_h_m), short(s.median_end_h_m),
        short(s.max_end_h_m), short(s.rms_over_sigma_h),
      ]),
    },
  ];
}

function trust({ nis_mean, nis_dof_mean, outages }: Results): string[] {
  const words = [
    `Mean NIS of the fixes used: ${short(nis_mean)}, where an honest filter has ` +
      `${short(nis_dof_mean)}. Below, the receiver errs less than it says; above, more.`,
    "Bands are three sigma as the filter claims them: an honest error is outside 0.3 % of the time.",
  ];
  if (outages.length > 0) {
    const gnss = outages.some((o) => o.against === "gnss");
    words.push(
      `Outages are measured against ${gnss ? "the withheld fixes" : "the truth"}; the solution ` +
        "itself goes on with all fixes.",
    );
  }
  return words;
}
