/** What a chart shows, apart from how it is drawn. */

/** Missing values are NaN. */
export type Values = ArrayLike<number>;

export interface Axis {
  readonly label: string;
  readonly unit: string;
  readonly log?: boolean;
  /** Names at 0, 1, 2, ... in place of numbers. */
  readonly categories?: readonly string[];
}

/**
 * line: in the order of its points; envelope: from y to high where points are close, x ascending;
 * band: filled from y to high; bars: along x from 0, at categories of y; cells: at categories of both.
 */
export type Style = "line" | "envelope" | "band" | "points" | "bars" | "cells";

export interface Series {
  readonly label: string;
  readonly style: Style;
  /** Of the palette. */
  readonly colour: number;
  readonly x: Values;
  readonly y: Values;
  readonly high?: Values;
  readonly dashed?: boolean;
  /** Bars that lie on wider ones. */
  readonly thin?: boolean;
  /** Markers on a line. */
  readonly marked?: boolean;
  /** What a point is called. */
  readonly names?: readonly string[];
  /** Text in cells. */
  readonly texts?: readonly string[];
}

export interface Level {
  readonly at: number;
  readonly label: string;
}

export interface Span {
  readonly from: number;
  readonly to: number;
  readonly label: string;
}

export interface Chart {
  readonly id: string;
  readonly title: string;
  readonly caption: string;
  readonly x: Axis;
  readonly y: Axis;
  readonly series: readonly Series[];
  /** Lines across at a y. */
  readonly levels?: readonly Level[];
  /** Parts of x that are shaded. */
  readonly spans?: readonly Span[];
  /** A map: a metre is as long both ways, with a scale bar and an arrow to north. */
  readonly map?: boolean;
  /** What a hover tells: all series at this x, or the nearest point. */
  readonly hover: "x" | "point";
}

export interface Extent {
  readonly low: number;
  readonly high: number;
}

export interface Window {
  readonly x: Extent;
  readonly y: Extent;
}

/** Everything in sight, with a margin. */
export function wholeOf(chart: Chart): Window {
  const origin = chart.series.some((s) => s.style === "bars") ? [[0]] : [];
  const levels = (chart.levels ?? []).map((level) => level.at);
  return {
    x: extent(chart.x, [...chart.series.map((s) => s.x), ...origin]),
    y: extent(chart.y, [...chart.series.flatMap((s) => (s.high ? [s.y, s.high] : [s.y])), levels]),
  };
}

function extent(axis: Axis, columns: readonly Values[]): Extent {
  if (axis.categories) return { low: -0.5, high: axis.categories.length - 0.5 };
  let low = Infinity;
  let high = -Infinity;
  for (const values of columns) {
    for (let i = 0; i < values.length; ++i) {
      const v = values[i] as number;
      if (!Number.isFinite(v) || (axis.log && v <= 0)) continue;
      if (v < low) low = v;
      if (v > high) high = v;
    }
  }
  if (low > high) return axis.log ? { low: 1, high: 10 } : { low: 0, high: 1 };
  return axis.log ? { low: low / 1.3, high: high * 1.3 } : withMargin(low, high);
}

function withMargin(low: number, high: number): Extent {
  const margin = 0.04 * (high - low) || 0.5;
  return { low: low - margin, high: high + margin };
}
