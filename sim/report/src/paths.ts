/** The marks of a series as paths in pixels of the canvas. */
import type uPlot from "uplot";
import type { Series, Values } from "./chart";

const kMarkerPx = 3.5;
const kCrowd = 500;

export function pathsOf(series: Series): uPlot.Series.PathBuilder {
  const build = kBuilders[series.style];
  return (u) => ({ stroke: null, fill: null, clip: null, ...build(u, series) });
}

type Build = (u: uPlot, series: Series) => { stroke?: Path2D; fill?: Path2D };

const kBuilders: Record<Series["style"], Build> = {
  line: (u, s) => ({ stroke: line(u, s), ...(s.marked ? { fill: markers(u, s) } : {}) }),
  envelope: (u, s) => ({ stroke: s.high ? columns(u, s, s.high) : line(u, s) }),
  band: (u, s) => ({ fill: band(u, s, s.high ?? s.y) }),
  points: (u, s) => ({ fill: markers(u, s) }),
  bars: (u, s) => ({ fill: bars(u, s) }),
  cells: (u, s) => ({ fill: cells(u, s) }),
};

const at = (values: Values, i: number): number => values[i] as number;
const xPx = (u: uPlot, v: number): number => u.valToPos(v, "x", true);
const yPx = (u: uPlot, v: number): number => u.valToPos(v, "y", true);

/** Whether a value has a place on the scale: a number, and positive on a logarithmic one. */
function isOn(u: uPlot, scale: "x" | "y", value: number): boolean {
  return Number.isFinite(value) && (u.scales[scale]?.distr !== 3 || value > 0);
}

function line(u: uPlot, s: Series): Path2D {
  const path = new Path2D();
  let open = false;
  for (let i = 0; i < s.x.length; ++i) {
    const [x, y] = [at(s.x, i), at(s.y, i)];
    const shown = isOn(u, "x", x) && isOn(u, "y", y);
    if (shown && open) path.lineTo(xPx(u, x), yPx(u, y));
    else if (shown) path.moveTo(xPx(u, x), yPx(u, y));
    open = shown;
  }
  return path;
}

/** First index with x >= wanted. @param x  ascending */
export function lowerBound(x: Values, wanted: number): number {
  let low = 0;
  let high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (at(x, middle) < wanted) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Least and greatest of each column of pixels, so that no peak is lost, joined to a line. */
function columns(u: uPlot, s: Series, highs: Values): Path2D {
  const path = new Path2D();
  const scale = u.scales["x"];
  const end = Math.min(s.x.length, lowerBound(s.x, scale?.max ?? Infinity) + 1);
  let i = Math.max(0, lowerBound(s.x, scale?.min ?? -Infinity) - 1);
  while (i < end) {
    const px = Math.round(xPx(u, at(s.x, i)));
    let low = Infinity;
    let high = -Infinity;
    for (; i < end && Math.round(xPx(u, at(s.x, i))) === px; ++i) {
      low = Math.min(low, Number.isNaN(at(s.y, i)) ? Infinity : at(s.y, i));
      high = Math.max(high, Number.isNaN(at(highs, i)) ? -Infinity : at(highs, i));
    }
    if (low > high) continue;
    path.moveTo(px, yPx(u, low));
    path.lineTo(px, yPx(u, high) - 1);
    const next = i < end ? Math.round(xPx(u, at(s.x, i))) : px;
    if (next > px + 1 && Number.isFinite(at(s.y, i))) {
      path.moveTo(px, yPx(u, 0.5 * (low + high)));
      path.lineTo(next, yPx(u, 0.5 * (at(s.y, i) + at(highs, i))));
    }
  }
  return path;
}

function band(u: uPlot, s: Series, highs: Values): Path2D {
  const path = new Path2D();
  const isShown = (i: number): boolean =>
    isOn(u, "x", at(s.x, i)) && isOn(u, "y", at(s.y, i)) && isOn(u, "y", at(highs, i));
  for (let begin = 0; begin < s.x.length; ) {
    if (!isShown(begin)) {
      ++begin;
      continue;
    }
    let end = begin;
    while (end < s.x.length && isShown(end)) ++end;
    path.moveTo(xPx(u, at(s.x, begin)), yPx(u, at(highs, begin)));
    for (let i = begin + 1; i < end; ++i) path.lineTo(xPx(u, at(s.x, i)), yPx(u, at(highs, i)));
    for (let i = end - 1; i >= begin; --i) path.lineTo(xPx(u, at(s.x, i)), yPx(u, at(s.y, i)));
    path.closePath();
    begin = end;
  }
  return path;
}

/** Shapes differ as colours do. */
function markers(u: uPlot, s: Series): Path2D {
  const path = new Path2D();
  const crowded = s.x.length > kCrowd;
  const r = kMarkerPx * devicePixelRatio * (s.style !== "points" ? 1 : crowded ? 0.5 : 1.2);
  for (let i = 0; i < s.x.length; ++i) {
    if (!isOn(u, "x", at(s.x, i)) || !isOn(u, "y", at(s.y, i))) continue;
    marker(path, s.colour % 4, xPx(u, at(s.x, i)), yPx(u, at(s.y, i)), r);
  }
  return path;
}

function marker(path: Path2D, shape: number, x: number, y: number, r: number): void {
  path.moveTo(x + r, y);
  if (shape === 0) {
    path.arc(x, y, r, 0, 2 * Math.PI);
  } else if (shape === 1) {
    path.rect(x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r);
  } else {
    const corners = shape === 2 ? 3 : 4;
    for (let k = 0; k <= corners; ++k) {
      const angle = (2 * Math.PI * k) / corners - Math.PI / 2;
      const [cx, cy] = [x + 1.25 * r * Math.cos(angle), y + 1.25 * r * Math.sin(angle)];
      if (k === 0) path.moveTo(cx, cy);
      else path.lineTo(cx, cy);
    }
  }
}

function bars(u: uPlot, s: Series): Path2D {
  const path = new Path2D();
  const origin = u.scales["x"]?.distr === 3 ? (u.scales["x"].min ?? 1) : 0;
  const half = Math.abs(yPx(u, 1) - yPx(u, 0)) * (s.thin ? 0.12 : 0.34);
  for (let i = 0; i < s.x.length; ++i) {
    if (!isOn(u, "x", at(s.x, i))) continue;
    const [from, to] = [xPx(u, origin), xPx(u, at(s.x, i))];
    path.rect(Math.min(from, to), yPx(u, at(s.y, i)) - half, Math.abs(to - from), 2 * half);
  }
  return path;
}

function cells(u: uPlot, s: Series): Path2D {
  const path = new Path2D();
  const width = Math.abs(xPx(u, 1) - xPx(u, 0)) - 2;
  const height = Math.abs(yPx(u, 1) - yPx(u, 0)) - 2;
  for (let i = 0; i < s.x.length; ++i) {
    path.rect(xPx(u, at(s.x, i)) - width / 2, yPx(u, at(s.y, i)) - height / 2, width, height);
  }
  return path;
}
