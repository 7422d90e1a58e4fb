/** A scene in words, from the input of a command that has one. */
import type { Report } from "../report";
import { count, duration, percent, withUnit } from "../words";

type Vector = readonly [number, number, number];

export interface SceneInput {
  readonly scene: string;
  readonly motion: string;
  readonly duration_s: number;
  readonly imu_rate_hz: number;
  readonly imu_model?: string;
  readonly gnss: {
    readonly interval_s: number;
    readonly position_sigma_ned_m: Vector;
    readonly velocity_sigma_ned_mps: Vector;
    readonly correlated_sigma_ned_m: Vector;
    readonly correlation_s: number;
    readonly latency_s: number;
    readonly outlier_probability: number;
    readonly outages: readonly { readonly start_s: number; readonly duration_s: number }[];
  };
  readonly metric: keyof typeof kMetrics;
  readonly limit_m?: number;
  /** Of a preset: the document. */
  readonly limit_source?: string | null;
  readonly trials: number;
}

const kMetrics = {
  drms: "the root mean square of the horizontal error (DRMS)",
  r95: "the radius that 95 % of the horizontal errors stay within (R95)",
  axis: "one sigma along the longest axis of the horizontal error",
  r50: "the radius that half of the horizontal errors stay within (CEP)",
  r68: "the radius that 68 % of the horizontal errors stay within (R68)",
  r99: "the radius that 99 % of the horizontal errors stay within (R99)",
  cross95: "what 95 % of the errors across the track stay within",
  along95: "what 95 % of the errors along the track stay within",
  vertical95: "what 95 % of the errors of the height stay within",
  "3d": "the root mean square of the error in space",
};

export const sceneOf = (report: Report): SceneInput => report.input as unknown as SceneInput;

export const metricOf = (scene: SceneInput): string => kMetrics[scene.metric];

/** @param withInterval  whether the time between fixes belongs to the scene */
export function sceneInWords(scene: SceneInput, withInterval = true): string[] {
  const imu = scene.imu_model ? `, IMU ${scene.imu_model}` : ", IMU";
  const words = [
    `“${scene.scene}”: ${scene.motion.replaceAll("_", " ")} motion for ` +
      `${duration(scene.duration_s)}${imu} at ${withUnit(scene.imu_rate_hz, "Hz")}.`,
    receiverInWords(scene, withInterval),
  ];
  const { outages } = scene.gnss;
  if (outages.length > 0) {
    const list = outages.map((o) => `${duration(o.duration_s)} from ${o.start_s} s`);
    words.push(`${count(outages.length, "outage")}: ${list.join(", ")}.`);
  }
  return words;
}

function receiverInWords({ gnss }: SceneInput, withInterval: boolean): string {
  const slow = gnss.correlated_sigma_ned_m;
  const parts = [
    `white errors of ${threeOf(gnss.position_sigma_ned_m, "m")} in position (north, east, down, ` +
      `1 sigma) and ${threeOf(gnss.velocity_sigma_ned_mps, "m/s")} in velocity`,
  ];
  if (slow.some((v) => v > 0)) {
    parts.push(`${threeOf(slow, "m")} that wander over ${withUnit(gnss.correlation_s, "s")}`);
  }
  if (gnss.latency_s > 0) parts.push(`fixes come ${withUnit(gnss.latency_s, "s")} late`);
  if (gnss.outlier_probability > 0) {
    parts.push(`${percent(gnss.outlier_probability)} of them are outliers`);
  }
  const often = withInterval ? ` every ${withUnit(gnss.interval_s, "s")}` : "";
  return `GNSS fixes${often} with ${parts.join("; ")}.`;
}

const threeOf = (v: Vector, unit: string): string => `${v.join(" / ")} ${unit}`;
