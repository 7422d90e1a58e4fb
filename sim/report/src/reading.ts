/** What a chart tells at a place: the nearest point, or every series at an x. */
import type { Axis, Series } from "./chart";
import { lowerBound } from "./paths";
import type { Pixel, Plot } from "./plot";
import { withUnit } from "./words";

/** A point of a series. */
export interface Place {
  readonly series: number;
  readonly index: number;
}

export interface Reading {
  readonly heading: string;
  readonly lines: readonly { readonly colour: number | undefined; readonly text: string }[];
}

const value = (axis: Axis, v: number): string => axis.categories?.[v] ?? withUnit(v, axis.unit);
const xOf = (s: Series, i: number): number => s.x[i] as number;
const yOf = (s: Series, i: number): number => s.y[i] as number;

export function placeNear(plot: Plot, at: Pixel): Place | undefined {
  return plot.chart.hover === "x" ? placeAtX(plot, plot.xAt(at.left)) : placeAround(plot, at);
}

function placeAtX(plot: Plot, x: number): Place | undefined {
  const series = longestShown(plot);
  if (series === undefined) return undefined;
  return { series, index: nearestIndex(plot.chart.series[series] as Series, x) };
}

/** The series whose points the keys walk along where all are read at once. */
function longestShown(plot: Plot): number | undefined {
  let longest: number | undefined;
  plot.chart.series.forEach((s, i) => {
    const length = longest === undefined ? 0 : (plot.chart.series[longest] as Series).x.length;
    if (plot.isShown(i) && s.x.length > length) longest = i;
  });
  return longest;
}

/** @pre the series has points; x ascends */
function nearestIndex(s: Series, x: number): number {
  const after = Math.min(lowerBound(s.x, x), s.x.length - 1);
  return after > 0 && x - xOf(s, after - 1) < xOf(s, after) - x ? after - 1 : after;
}

function placeAround(plot: Plot, at: Pixel): Place | undefined {
  let nearest: Place | undefined;
  let least = Infinity;
  plot.chart.series.forEach((s, series) => {
    if (!plot.isShown(series) || s.style === "band") return;
    for (let index = 0; index < s.x.length; ++index) {
      const [x, y] = [xOf(s, index), yOf(s, index)];
      if (!plot.isInSight(x, y) && s.style !== "bars") continue;
      const pixel = plot.toPixel(x, y);
      const dx = s.style === "bars" ? 0 : pixel.left - at.left;
      const distance = Math.hypot(dx, pixel.top - at.top);
      if (distance < least) [least, nearest] = [distance, { series, index }];
    }
  });
  return nearest;
}

export function readingAt(plot: Plot, place: Place): Reading {
  return plot.chart.hover === "x" ? readAllAt(plot, place) : readPoint(plot, place);
}

function readPoint({ chart }: Plot, { series, index }: Place): Reading {
  const s = chart.series[series] as Series;
  const lines = [
    { colour: undefined, text: `${chart.x.label}: ${value(chart.x, xOf(s, index))}` },
    { colour: undefined, text: `${chart.y.label}: ${value(chart.y, yOf(s, index))}` },
  ];
  const name = s.names?.[index];
  if (name) lines.unshift({ colour: undefined, text: name });
  return { heading: s.label, lines };
}

function readAllAt(plot: Plot, place: Place): Reading {
  const { chart } = plot;
  const x = xOf(chart.series[place.series] as Series, place.index);
  const lines = chart.series
    .map((s, i) => ({ s, i }))
    .filter(({ s, i }) => plot.isShown(i) && s.x.length > 0)
    .map(({ s }) => ({ colour: s.colour, text: `${s.label}: ${valueAt(chart.y, s, x)}` }));
  return { heading: `${chart.x.label}: ${value(chart.x, x)}`, lines };
}

function valueAt(axis: Axis, s: Series, x: number): string {
  const index = nearestIndex(s, x);
  const [low, high] = [yOf(s, index), s.high?.[index]];
  if (high === undefined || high === low) return value(axis, low);
  return `${value(axis, low)} to ${value(axis, high)}`;
}

/** The next point of the same series, or the same of another series. */
export function moved(plot: Plot, from: Place, dIndex: number, dSeries: number): Place {
  const { series: all } = plot.chart;
  let series = from.series;
  if (dSeries !== 0) {
    do series = (series + dSeries + all.length) % all.length;
    while (series !== from.series && !(plot.isShown(series) && all[series]?.x.length));
  }
  const last = (all[series] as Series).x.length - 1;
  return { series, index: Math.min(Math.max(from.index + dIndex, 0), last) };
}

/** How many points a press of a key goes on: a hundredth of what is in sight. */
export function stride(plot: Plot, { series }: Place): number {
  if (plot.chart.hover === "point") return 1;
  const { x } = plot.chart.series[series] as Series;
  const { low, high } = plot.inSight().x;
  return Math.max(1, Math.round((lowerBound(x, high) - lowerBound(x, low)) / 100));
}
