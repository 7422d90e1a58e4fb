/** leeway reduce: what each term of the model is worth in a scene, and the cheapest filter. */
import type { Chart, Series } from "../chart";
import type { Report } from "../report";
import type { Grid, View } from "../view";
import { list, short, withUnit } from "../words";
import { sceneInWords, sceneOf } from "./scene";

interface Term {
  readonly term: string;
  readonly substitute?: string;
  readonly predicted_m: number | null;
  readonly measured_m: number | null;
  readonly cost_ns_per_s: number | null;
  readonly kept: boolean;
}

interface Model {
  readonly cost_ns_per_s: number;
  readonly predicted_m: number;
  readonly measured_m: number;
  readonly rms_over_sigma: number;
  readonly nees: number;
}

interface Results {
  readonly limit_m: number;
  readonly terms: readonly Term[];
  readonly full: Model;
  readonly reduced: Model;
  readonly keeps_limit?: boolean;
  readonly as_honest?: boolean;
}

export function reduceView(report: Report): View {
  const results = report.results as Results;
  const terms = [...results.terms].sort((a, b) => (b.measured_m ?? 0) - (a.measured_m ?? 0));
  return {
    title: "How little model is enough for this scene?",
    scene: sceneInWords(sceneOf(report)),
    answer: answer(results),
    tables: [modelGrid(results)],
    trust: [
      "Predicted: by covariance or in closed form, without running the filter. Measured: by paired " +
        "runs on the same noise, with the term and without.",
      `Costs are measured on this machine, per second of IMU data; both models ran the same ` +
        `${report.input["trials"]} trials.`,
      honesty(results),
    ],
    charts: [errorChart(terms, results.limit_m), costChart(terms)],
    details: [termGrid(terms)],
  };
}

function answer({ limit_m, full, reduced, terms, keeps_limit }: Results): string[] {
  const kept = terms.filter((term) => term.kept).map((term) => term.term);
  const keeps = keeps_limit ?? reduced.measured_m <= limit_m;
  const factor = full.cost_ns_per_s / reduced.cost_ns_per_s;
  return [
    `The cheapest model ${keeps ? "keeps" : "misses"} the limit of ${withUnit(limit_m, "m")}: it errs ` +
      `by ${withUnit(reduced.measured_m, "m")}, the full model by ${withUnit(full.measured_m, "m")}.`,
    `It costs ${withUnit(reduced.cost_ns_per_s / 1000, "µs")} per second of IMU data, ` +
      `${short(factor)} times less than everything on.`,
    kept.length > 0 ? `What this scene needs: ${list(kept)}.` : "This scene needs none of the terms.",
  ];
}

function honesty({ full, reduced, as_honest }: Results): string {
  const verdict = as_honest === false ? "; it claims more than it keeps" : "";
  return (
    `RMS error over the claimed sigma: ${short(reduced.rms_over_sigma)}, with the full model ` +
    `${short(full.rms_over_sigma)}${verdict}.`
  );
}

function modelGrid({ full, reduced }: Results): Grid {
  const row = (name: string, model: Model): string[] => [
    name, short(model.predicted_m), short(model.measured_m), short(model.cost_ns_per_s / 1000),
    short(model.rms_over_sigma), short(model.nees),
  ];
  return {
    caption: "The full model and the cheapest",
    headings: ["model", "predicted, m", "measured, m", "cost, µs/s", "RMS / sigma", "NEES"],
    rows: [row("everything on", full), row("cheapest", reduced)],
  };
}

function termGrid(terms: readonly Term[]): Grid {
  return {
    caption: "The terms, by what leaving them out costs in error",
    headings: ["term", "in its place", "predicted, m", "measured, m", "cost, ns/s", "kept"],
    rows: terms.map((term) => [
      term.term, term.substitute ?? "", short(term.predicted_m), short(term.measured_m),
      short(term.cost_ns_per_s), term.kept ? "yes" : "no",
    ]),
  };
}

function errorChart(terms: readonly Term[], limit_m: number): Chart {
  // A logarithmic axis has no place for nothing.
  const bars = (label: string, colour: number, thin: boolean, pick: (t: Term) => number | null): Series => {
    const shown = terms.map((_term, i) => i).filter((i) => pick(terms[i]!));
    return {
      label, style: "bars", colour, thin, y: shown,
      x: shown.map((i) => pick(terms[i]!)!),
      names: shown.map((i) => (terms[i]!.kept ? "kept" : "left out")),
    };
  };
  return {
    id: "terms-error",
    title: "The error that each term saves",
    caption: `Added to the error at the next fix when the term is left out; the limit is ${withUnit(limit_m, "m")}.`,
    x: { label: "error without the term", unit: "m", log: true },
    y: { label: "", unit: "", categories: terms.map((t) => (t.kept ? `${t.term} (kept)` : t.term)) },
    series: [
      bars("measured", 6, false, (term) => term.measured_m),
      bars("predicted", 1, true, (term) => term.predicted_m),
    ],
    hover: "point",
  };
}

function costChart(terms: readonly Term[]): Chart {
  const costly = terms.filter((term) => term.cost_ns_per_s !== null);
  return {
    id: "terms-cost",
    title: "What each term costs",
    caption: "Processor time of the filter, per second of IMU data, that leaving the term out saves.",
    x: { label: "cost per second of IMU data", unit: "ns" },
    y: { label: "", unit: "", categories: costly.map((t) => (t.kept ? `${t.term} (kept)` : t.term)) },
    series: [
      {
        label: "cost", style: "bars", colour: 2, y: costly.map((_term, i) => i),
        x: costly.map((term) => term.cost_ns_per_s as number),
      },
    ],
    hover: "point",
  };
}
