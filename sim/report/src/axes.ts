/** Axes and scales of a chart for uPlot. */
import type uPlot from "uplot";
import type { Axis, Chart } from "./chart";
import { theme } from "./theme";
import { short } from "./words";

export const kFont = "12px system-ui, sans-serif";
const kLabelFont = "bold 12px system-ui, sans-serif";
const kCharacterPx = 6.6;
const kLinePx = 18;

export function scaleOf(axis: Axis): uPlot.Scale {
  return {
    time: false,
    auto: false,
    distr: axis.log ? 3 : 1,
    range: (_u, min, max) => [min, max],
  };
}

export function axesOf(chart: Chart): uPlot.Axis[] {
  const x = { ...axisOf(chart.x), size: 32 };
  const y = axisOf(chart.y);
  return [
    chart.x.categories ? { ...x, ...columnNames(chart.x.categories) } : x,
    chart.y.categories ? { ...y, ...rowNames(chart.y.categories) } : y,
  ];
}

/** Upright where there is room, else from below. */
function columnNames(names: readonly string[]): Partial<uPlot.Axis> {
  const isNarrow = (u: uPlot): boolean => u.width / (names.length + 2) < 9 * kCharacterPx;
  const shown = (u: uPlot): string[] => names.map((name) => (isNarrow(u) ? name : wrapped(name, 9)));
  return {
    values: (u, splits) => splits.map((i) => shown(u)[i] ?? ""),
    rotate: (u) => (isNarrow(u) ? -90 : 0),
    size: (u) =>
      isNarrow(u) ? 20 + kCharacterPx * longest(names) : 16 + kLinePx * Math.max(...shown(u).map(lines)),
  };
}

function rowNames(names: readonly string[]): Partial<uPlot.Axis> {
  return {
    values: (u, splits) => splits.map((i) => rowName(names[i] ?? "", u.width)),
    size: (u) =>
      16 + kCharacterPx * longest(names.flatMap((name) => rowName(name, u.width).split("\n"))),
  };
}

function rowName(name: string, widthPx: number): string {
  return wrapped(name, Math.min(Math.max(10, Math.floor((0.36 * widthPx) / kCharacterPx)), 34));
}

/** Of a chart with categories down its side. */
export function rowHeightPx(names: readonly string[], widthPx: number): number {
  return 8 + kLinePx * Math.max(...names.map((name) => lines(rowName(name, widthPx))));
}

const lines = (text: string): number => text.split("\n").length;
const longest = (texts: readonly string[]): number => Math.max(...texts.map((t) => t.length));

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
    size: (_u, values) => 20 + kCharacterPx * Math.max(...(values ?? ["0"]).map((v) => v.length)),
    ...(axis.log ? logTicks : {}),
    ...(axis.categories ? { splits: axis.categories.map((_name, i) => i) } : {}),
    ...(axis.label === "" ? { labelSize: 0 } : {}),
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
  splits: (u, axis, min, max) => {
    const roomPx = (axis === 0 ? u.bbox.width / 48 : u.bbox.height / 24) / devicePixelRatio;
    return logSplits(min, max, Math.max(3, roomPx));
  },
  filter: (_u, splits) => splits,
};

/** As many round numbers in every decade as there is room for; of a part of one, even steps. */
function logSplits(min: number, max: number, most: number): number[] {
  if (max / min < 6) return evenSplits(min, max);
  const choices = [[1, 1.5, 2, 3, 4, 5, 7], [1, 2, 5], [1]].map((steps) => inDecades(steps, min, max));
  const decades = choices.at(-1) as number[];
  const every = Math.ceil(decades.length / most);
  return choices.find((splits) => splits.length <= most) ?? decades.filter((_v, i) => i % every === 0);
}

function inDecades(steps: readonly number[], min: number, max: number): number[] {
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
