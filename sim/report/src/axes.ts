/** Axes and scales of a chart for uPlot. */
import type uPlot from "uplot";
import type { Axis, Chart } from "./chart";
import { theme } from "./theme";
import { short } from "./words";

export const kFont = "12px system-ui, sans-serif";
const kLabelFont = "bold 12px system-ui, sans-serif";
const kCharacterPx = 6.6;
const kLinePx = 14;

export function scaleOf(axis: Axis): uPlot.Scale {
  return {
    time: false,
    auto: false,
    distr: axis.log ? 3 : 1,
    range: (_u, min, max) => [min, max],
  };
}

export function axesOf(chart: Chart, widthPx: number): uPlot.Axis[] {
  const x = axisOf(chart.x);
  x.size = 32;
  const y = { ...axisOf(chart.y), ...(chart.y.categories ? categoryY(chart.y, widthPx) : {}) };
  if (chart.x.categories) {
    const texts = chart.x.categories.map((name) => wrapped(name, 9));
    x.values = (_u, splits) => splits.map((i) => texts[i] ?? "");
    x.size = 12 + kLinePx * Math.max(...texts.map((text) => text.split("\n").length));
  }
  return [x, y];
}

function axisOf(axis: Axis): uPlot.Axis {
  return {
    label: axis.unit ? `${axis.label}, ${axis.unit}` : axis.label,
    labelFont: kLabelFont,
    labelSize: 20,
    font: kFont,
    stroke: () => theme().text,
    grid: { stroke: () => theme().grid, width: 1, show: !axis.categories },
    ticks: { stroke: () => theme().grid, width: 1, size: 5 },
    values: (_u, splits) => splits.map((v) => short(Math.abs(v) < 1e-12 ? 0 : v)),
    size: (_u, values) => 14 + kCharacterPx * Math.max(...(values ?? ["0"]).map((v) => v.length)),
    ...(axis.log ? logTicks : {}),
    ...(axis.categories ? { splits: axis.categories.map((_name, i) => i) } : {}),
    ...(axis.label === "" ? { labelSize: 0 } : {}),
  };
}

function categoryY(axis: Axis, widthPx: number): Partial<uPlot.Axis> {
  const characters = Math.max(10, Math.floor((0.36 * widthPx) / kCharacterPx));
  const texts = (axis.categories ?? []).map((name) => wrapped(name, Math.min(characters, 30)));
  const longest = Math.max(...texts.flatMap((text) => text.split("\n")).map((t) => t.length));
  return {
    values: (_u, splits) => splits.map((i) => texts[i] ?? ""),
    size: 14 + kCharacterPx * longest,
  };
}

function wrapped(text: string, characters: number): string {
  const lines: string[] = [];
  for (const word of text.split(/(?<=[ _/-])/)) {
    const last = lines.at(-1);
    if (last !== undefined && last.length + word.length <= characters) {
      lines[lines.length - 1] = last + word;
    } else {
      lines.push(word);
    }
  }
  return lines.join("\n");
}

const logTicks: Partial<uPlot.Axis> = {
  splits: (_u, _axis, min, max) => logSplits(min, max),
  filter: (_u, splits) => splits,
};

/** 1, 2, 5 in every decade, fewer where there are many decades, more where there is a part of one. */
export function logSplits(min: number, max: number): number[] {
  if (max / min < 6) return evenSplits(min, max);
  const steps = max / min > 2000 ? [1] : max / min > 50 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 7];
  const splits: number[] = [];
  for (let e = Math.floor(Math.log10(min)); e <= Math.ceil(Math.log10(max)); ++e) {
    for (const step of steps) splits.push(Number(`${step}e${e}`));
  }
  return splits.filter((v) => v >= min && v <= max);
}

function evenSplits(min: number, max: number): number[] {
  const rough = (max - min) / 5;
  const decade = 10 ** Math.floor(Math.log10(rough));
  const step = decade * ([1, 2, 5, 10].find((m) => m * decade >= rough) ?? 10);
  const splits: number[] = [];
  for (let k = Math.ceil(min / step); k * step <= max; ++k) {
    splits.push(Number((k * step).toPrecision(10)));
  }
  return splits;
}
