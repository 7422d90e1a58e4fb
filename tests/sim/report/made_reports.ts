/** A report of every command, of scenes that take a second or so. */
import { execFileSync } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";

export interface MadeReport {
  readonly name: string;
  readonly path: string;
  /** What --json said in the same run. */
  readonly json: { readonly results: unknown };
  readonly charts: readonly string[];
}

export function makeReports(program: string, scenes: string, work: string): MadeReport[] {
  mkdirSync(work, { recursive: true });
  const leeway = (...words: string[]): string =>
    execFileSync(program, words, { encoding: "utf8", maxBuffer: 1e9 });
  const made = (name: string, charts: string[], ...words: string[]): MadeReport => {
    const path = join(work, `${name}.html`);
    const json = leeway(name, ...words, "--json", "--report", path);
    return { name, path, json: JSON.parse(json) as MadeReport["json"], charts };
  };
  const loop = join(scenes, "square-loop.toml");
  return [
    made(
      "analyze", ["sigma-horizontal", "sigma-down", "sources"],
      "--scene", join(scenes, "tunnel.toml"), "--interval-s", "5",
    ),
    made("atlas", ["matrix"], "--scene", "frozen-transition,dead-row,coning", "--short"),
    made(
      "reduce", ["terms-error", "terms-cost"],
      "--scene", join(scenes, "tunnel-60s.toml"), "--trials", "20", "--repeat", "1",
    ),
    made(
      "campaign", ["fan", "axes"],
      "--scene", loop, "--interval-s", "10", "--at", "300", "--trials", "20",
    ),
    made("drift", ["drift-complete", "drift-paper-assumptions"], "--trials", "10"),
    made(
      "interval",
      ["error-over-interval", "free-against-calibrated", "free-inertial", "claimed-against-true"],
      "--scene", loop, "--at", "1200", "--imu", "tactical,automotive", "--limit", "10,30",
      "--confirm", "4",
    ),
    made(
      "fuse",
      ["track", "error-north", "error-east", "error-down", "outages", "bias-accelerometer",
        "bias-gyro", "nis", "verdicts"],
      ...simulatedDrive(leeway, work),
    ),
    made(
      "replay", ["error-since-fix", "error-over-interval"],
      ...simulatedDrive(leeway, work).slice(0, -2), "--phases", "1",
    ),
    made(
      "compare", ["cost-against-error"],
      "--scene", loop, "--interval-s", "10", "--at", "120", "--trials", "2", "--repeat", "1",
    ),
  ];
}

/** @returns what fuses it */
function simulatedDrive(leeway: (...words: string[]) => string, work: string): string[] {
  const drive = join(work, "drive");
  const outages = join(work, "outages.json");
  mkdirSync(drive, { recursive: true });
  writeFileSync(outages, '[{"start_s": 150, "duration_s": 30}]');
  leeway(
    "simulate", "--trajectory", "car", "--imu-class", "tactical", "--duration-s", "300",
    "--imu-rate-hz", "100", "--seed", "1", "--out", drive, "--force",
  );
  return [
    "--imu", join(drive, "imu.csv"), "--gnss", join(drive, "gnss.csv"),
    "--truth", join(drive, "truth.csv"), "--imu-class", "tactical", "--outages", outages,
  ];
}
