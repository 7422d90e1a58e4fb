/** leeway atlas: scenes that break methods, against every variant. */
import type { Chart, Series } from "../chart";
import type { Report } from "../report";
import type { Grid, View } from "../view";
import { count, short, withUnit } from "../words";

interface Cell {
  readonly scene: string;
  readonly title?: string;
  readonly group: string;
  readonly variant: string;
  readonly condition: string;
  readonly figure: number | null;
  readonly figure_unit: string;
  readonly verdict: Verdict;
  readonly reported: string;
  readonly silent: boolean;
}

type Verdict = "survives" | "degrades" | "fails";

interface Results {
  readonly cells: readonly Cell[];
  readonly unexpected: readonly Readonly<Record<string, string>>[];
}

const kVerdicts: readonly Verdict[] = ["survives", "degrades", "fails"];
const kColours: Readonly<Record<Verdict, number>> = { survives: 2, degrades: 4, fails: 1 };
const kNotOffered = "not offered";

export function atlasView(report: Report): View {
  const { cells, unexpected } = report.results as Results;
  const scenes = [...new Set(cells.map((cell) => cell.scene))];
  return {
    title: "Where methods break, and what survives",
    scene: [
      `${count(scenes.length, "scene")}, each built to break a method, and ` +
        `${count(cells.length, "run")} of variants in them.`,
    ],
    answer: answer(cells),
    tables: [],
    trust: [
      "Verdicts are by limits that each scene states with a reason, and are compared with those " +
        "that were committed.",
      unexpected.length === 0
        ? "All verdicts are as committed."
        : `${count(unexpected.length, "verdict")} not as committed: ` +
          `${unexpected.map((u) => `${u["scene"]}: ${u["variant"]}`).join(", ")}.`,
      "“Not offered” are methods that the library does not have: what the scenes show failing.",
    ],
    charts: [matrix(cells, scenes)],
    details: scenes.map((scene) => sceneGrid(cells.filter((cell) => cell.scene === scene))),
  };
}

function answer(cells: readonly Cell[]): string[] {
  const offered = cells.filter((cell) => cell.group !== kNotOffered);
  const failing = offered.filter((cell) => cell.verdict === "fails");
  const silent = failing.filter((cell) => cell.silent);
  const tally = (verdict: Verdict): number => offered.filter((c) => c.verdict === verdict).length;
  return [
    silent.length === 0
      ? "Nothing that the library offers fails silently: where a variant fails, a detector says so."
      : `${count(silent.length, "run")} of the library's variants fail and nothing says so.`,
    `Of ${count(offered.length, "run")} of what the library offers: ${tally("survives")} survive, ` +
      `${tally("degrades")} degrade, ${tally("fails")} fail.`,
  ];
}

/** The worst of each group of variants. */
function worstOf(cells: readonly Cell[]): Cell {
  const badness = (cell: Cell): number =>
    10 * kVerdicts.indexOf(cell.verdict) + (cell.silent ? 5 : 0);
  return cells.reduce((worst, cell) => {
    const worse = badness(cell) - badness(worst);
    return worse > 0 || (worse === 0 && (cell.figure ?? Infinity) > (worst.figure ?? Infinity))
      ? cell : worst;
  });
}

function matrix(cells: readonly Cell[], scenes: readonly string[]): Chart {
  const groups = [...new Set(cells.map((cell) => cell.group))];
  const worst = scenes.flatMap((scene, y) =>
    groups.flatMap((group, x) => {
      const here = cells.filter((cell) => cell.scene === scene && cell.group === group);
      return here.length > 0 ? [{ x, y, cell: worstOf(here) }] : [];
    }),
  );
  const of = (label: string, colour: number, picked: typeof worst): Series => ({
    label, style: "cells", colour,
    x: picked.map(({ x }) => x), y: picked.map(({ y }) => y),
    names: picked.map(({ cell }) => inWords(cell)),
    texts: picked.map(({ cell }) => withUnit(cell.figure, cell.figure_unit)),
  });
  const series = kVerdicts.map((verdict) =>
    of(verdict, kColours[verdict], worst.filter(({ cell }) => cell.verdict === verdict && !cell.silent)),
  );
  const silent = worst.filter(({ cell }) => cell.silent);
  if (silent.length > 0) series.push(of("fails silently", 5, silent));
  return {
    id: "matrix", title: "Scene by variant",
    caption: "The worst of each group of variants, with its figure; a larger figure is worse.",
    x: { label: "variants", unit: "", categories: groups },
    y: { label: "", unit: "", categories: scenes },
    series: series.filter((s) => s.x.length > 0), hover: "point",
  };
}

function inWords(cell: Cell): string {
  const where = cell.condition ? ` at ${cell.condition}` : "";
  const reported = cell.reported ? `; reported by ${cell.reported}` : "";
  return `${cell.variant}${where}: ${withUnit(cell.figure, cell.figure_unit)}${reported}`;
}

function sceneGrid(cells: readonly Cell[]): Grid {
  const first = cells[0] as Cell;
  const unit = first.figure_unit ? `figure, ${first.figure_unit}` : "figure";
  return {
    caption: first.title ?? first.scene,
    headings: ["variant", "of", "condition", unit, "verdict", "reported"],
    rows: cells.map((cell) => [
      cell.variant, cell.group, cell.condition, short(cell.figure), cell.verdict,
      cell.silent ? "NOTHING" : cell.reported,
    ]),
  };
}
