/** leeway campaign: Monte Carlo trials of the whole filter. */
import type { Chart, Series } from "../chart";
import type { Report, Table } from "../report";
import type { View } from "../view";
import { count, percent, short, withUnit } from "../words";
import { sceneInWords, sceneOf, type SceneInput } from "./scene";

interface Results {
  readonly trials: number;
  readonly epochs: number;
  readonly rms_horizontal_m: number;
  readonly sigma_horizontal_m: number;
  readonly rms_over_sigma: number;
  readonly rms_ned_m: readonly [number, number, number];
  readonly sigma_ned_m: readonly [number, number, number];
  readonly nees: number;
  readonly nees_band: readonly [number, number];
  readonly nis_over_dof: number;
  readonly beyond_r95: number;
  readonly fixes_fused: number;
  readonly fixes_gated: number;
  readonly trials_diverged: number;
  readonly worst_horizontal_m: number;
  readonly worst_seed: number;
}

export function campaignView(report: Report): View {
  const results = report.results as Results;
  const scene = sceneOf(report);
  const fan = report.series["fan"];
  return {
    title: "Does the filter err as much as it claims?",
    scene: sceneInWords(scene),
    answer: answer(results),
    tables: [
      {
        caption: "Error just before a fix is used",
        headings: ["axis", "RMS, m", "claimed sigma, m", "RMS / sigma"],
        rows: ["north", "east", "down"].map((axis, i) => {
          const [rms, sigma] = [results.rms_ned_m[i] as number, results.sigma_ned_m[i] as number];
          return [axis, short(rms), short(sigma), (rms / sigma).toFixed(3)];
        }),
      },
    ],
    trust: trust(results),
    charts: [...(fan ? [fanChart(fan, scene)] : []), axesChart(results)],
  };
}

function answer(r: Results): string[] {
  const [low, high] = r.nees_band;
  const verdict = r.nees < low ? "The filter errs less than it claims"
    : r.nees > high ? "The filter errs more than it claims" : "The filter errs as much as it claims";
  return [
    `${verdict}: NEES is ${short(r.nees)} for 15 states, where 95 % of honest campaigns have ` +
      `${short(low)} to ${short(high)}.`,
    `Horizontal error: RMS ${withUnit(r.rms_horizontal_m, "m")}, ${r.rms_over_sigma.toFixed(3)} of ` +
      `the ${withUnit(r.sigma_horizontal_m, "m")} claimed.`,
    r.trials_diverged === 0
      ? "No trial diverged."
      : `${count(r.trials_diverged, "trial")} of ${r.trials} diverged.`,
  ];
}

function trust(r: Results): string[] {
  return [
    `${count(r.trials, "trial")} of the whole nonlinear filter, ${count(r.epochs, "scored epoch")}.`,
    `NIS of the fixes over its degrees of freedom: ${r.nis_over_dof.toFixed(3)}; an honest filter has 1.`,
    `Errors beyond the claimed R95 radius: ${percent(r.beyond_r95)}; an honest filter has 5 %.`,
    `Fixes: ${r.fixes_fused} fused, ${r.fixes_gated} refused by the gate.`,
    `The largest error was ${withUnit(r.worst_horizontal_m, "m")}, in the trial of seed ` +
      `${r.worst_seed}; --first-seed ${r.worst_seed} --trials 1 runs it again.`,
  ];
}

function fanChart(fan: Table, scene: SceneInput): Chart {
  const x = fan.column("t_s");
  const band = (label: string, colour: number, low: string, high: string): Series => ({
    label, style: "band", colour, x, y: fan.column(low), high: fan.column(high),
  });
  const line = (label: string, colour: number, column: string, dashed = false): Series => ({
    label, style: "line", colour, dashed, x, y: fan.column(column),
  });
  return {
    id: "fan",
    title: "The trials, fanned out",
    caption:
      "Horizontal error before each fix, over the trials: half of them are in the dark band, 95 % " +
      "in the light one. Dashed: the radius that 95 % should be within, as the filter claims.",
    x: { label: "time", unit: "s" },
    y: { label: "horizontal error", unit: "m" },
    series: [
      band("95 % of trials", 6, "p2_5_m", "p97_5_m"),
      band("half of the trials", 0, "p25_m", "p75_m"),
      line("median", 0, "p50_m"),
      line("95 % are below", 2, "p95_m"),
      line("claimed R95", 1, "claimed_r95_m", true),
    ],
    spans: scene.gnss.outages.map((o) => ({
      from: o.start_s, to: o.start_s + o.duration_s, label: "outage",
    })),
    hover: "x",
  };
}

function axesChart(r: Results): Chart {
  const bars = (label: string, colour: number, x: readonly number[], thin: boolean): Series => ({
    label, style: "bars", colour, thin, x, y: [0, 1, 2],
  });
  return {
    id: "axes",
    title: "Found and claimed, by axis",
    caption: "RMS error before a fix over all trials, and what the filter claims.",
    x: { label: "error before a fix", unit: "m" },
    y: { label: "", unit: "", categories: ["north", "east", "down"] },
    series: [
      bars("claimed sigma", 6, r.sigma_ned_m, false),
      bars("RMS found", 1, r.rms_ned_m, true),
    ],
    hover: "point",
  };
}
