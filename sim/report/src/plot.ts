/** A chart on a canvas: uPlot's axes, scales and cursor, with the window that is in sight. */
import uPlot from "uplot";
import { axesOf, rowHeightPx, scaleOf } from "./axes";
import { wholeOf, type Axis, type Chart, type Extent, type Series, type Window } from "./chart";
import { drawOver, drawUnder } from "./decorations";
import { lowerBound, pathsOf } from "./paths";
import { colour, onTheme } from "./theme";

export interface Pixel {
  readonly left: number;
  readonly top: number;
}

export class Plot {
  readonly chart: Chart;
  private readonly u: uPlot;
  private readonly whole: Window;
  /** What was asked for, and what is in sight: a map shows more to be true to scale. */
  private asked: Window;
  private window: Window;
  private readonly shown: boolean[];
  /** The pointer has moved over the chart, or left it. */
  onCursor: (at: Pixel | undefined) => void = () => undefined;
  onWindow: (window: Window) => void = () => undefined;

  constructor(chart: Chart, host: HTMLElement) {
    this.chart = chart;
    this.whole = wholeOf(chart);
    this.asked = this.whole;
    this.window = this.whole;
    this.shown = chart.series.map(() => true);
    this.u = new uPlot(this.options(host), this.emptyData(), host);
    onTheme(() => this.u.redraw());
    new ResizeObserver(() => this.fit(host)).observe(host);
  }

  private options(host: HTMLElement): uPlot.Options {
    const { chart } = this;
    return {
      ...sizeOf(chart, host),
      legend: { show: false },
      scales: { x: scaleOf(chart.x), y: { ...scaleOf(chart.y), dir: chart.y.categories ? -1 : 1 } },
      axes: axesOf(chart),
      series: [{}, ...chart.series.map(optionsOf)],
      cursor: {
        points: { show: false },
        drag: { x: true, y: chart.hover === "point", setScale: false, uni: 30 },
      },
      hooks: {
        drawAxes: [(u) => drawUnder(u, chart)],
        draw: [(u) => drawOver(u, chart)],
        setCursor: [(u) => this.onCursor(cursorOf(u))],
        setSize: [() => queueMicrotask(() => this.show(this.asked))],
        setSelect: [(u) => this.zoomToSelection(u)],
      },
    };
  }

  /** Series draw their own data; uPlot wants some. */
  private emptyData(): uPlot.AlignedData {
    return [[0, 1], ...this.chart.series.map(() => [null, null])] as uPlot.AlignedData;
  }

  private fit(host: HTMLElement): void {
    if (host.clientWidth === 0) return;
    this.u.setSize(sizeOf(this.chart, host));
  }

  show(window: Window): void {
    this.asked = window;
    this.window = this.chart.map ? this.trueToScale(window) : window;
    const { x, y } = this.window;
    this.u.batch(() => {
      this.u.setScale("x", { min: x.low, max: x.high });
      this.u.setScale("y", { min: y.low, max: y.high });
    });
    this.onWindow(this.window);
  }

  reset(): void {
    this.show(this.whole);
  }

  /** @param factor  below 1 to see more closely */
  zoom(factor: number): void {
    const { x, y } = this.window;
    const closer = scaled(this.chart.x, x, factor, 0);
    const both = this.chart.hover === "point";
    this.show({ x: closer, y: both ? scaled(this.chart.y, y, factor, 0) : this.fitted(closer) });
  }

  /** @param share  of the window's width, to the right */
  pan(share: number): void {
    const x = scaled(this.chart.x, this.window.x, 1, share);
    this.show({ x, y: this.chart.hover === "point" ? this.window.y : this.fitted(x) });
  }

  setShown(series: number, shown: boolean): void {
    this.shown[series] = shown;
    this.u.setSeries(series + 1, { show: shown });
  }

  isShown(series: number): boolean {
    return this.shown[series] ?? false;
  }

  isInSight(x: number, y: number): boolean {
    const { x: wx, y: wy } = this.window;
    return x >= wx.low && x <= wx.high && y >= wy.low && y <= wy.high;
  }

  inSight(): Window {
    return this.window;
  }

  toPixel(x: number, y: number): Pixel {
    return { left: this.u.valToPos(x, "x"), top: this.u.valToPos(y, "y") };
  }

  xAt(left: number): number {
    return this.u.posToVal(left, "x");
  }

  /** Of the area within the axes, in its frame. */
  area(): { left: number; top: number; width: number; height: number } {
    const { over } = this.u;
    const { offsetLeft: left, offsetTop: top, clientWidth: width, clientHeight: height } = over;
    return { left, top, width, height };
  }

  private zoomToSelection(u: uPlot): void {
    const { left, top, width, height } = u.select;
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    if (width < 5 && height < 5) return;
    const x = width < 5 ? this.window.x : between(u.posToVal(left, "x"), u.posToVal(left + width, "x"));
    const y = u.posToVal(top, "y");
    if (this.chart.hover === "x") this.show({ x, y: this.fitted(x) });
    else this.show({ x, y: height < 5 ? this.window.y : between(y, u.posToVal(top + height, "y")) });
  }

  /** y of what lies in this part of x. */
  private fitted(x: Extent): Extent {
    const series = this.chart.series.filter((_s, i) => this.isShown(i)).map((s) => cut(s, x));
    const y = wholeOf({ ...this.chart, series }).y;
    return { low: Math.max(y.low, this.whole.y.low), high: Math.min(y.high, this.whole.y.high) };
  }

  private trueToScale({ x, y }: Window): Window {
    const [width, height] = [this.u.bbox.width, this.u.bbox.height];
    if (!(width > 0 && height > 0)) return { x, y };
    const perPixel = Math.max((x.high - x.low) / width, (y.high - y.low) / height);
    const around = (e: Extent, px: number): Extent => {
      const middle = 0.5 * (e.low + e.high);
      return { low: middle - 0.5 * px * perPixel, high: middle + 0.5 * px * perPixel };
    };
    return { x: around(x, width), y: around(y, height) };
  }
}

function optionsOf(series: Series): uPlot.Series {
  const filled = series.style !== "line" && series.style !== "envelope";
  return {
    stroke: () => colour(series.colour),
    fill: () => colour(series.colour) + (series.style === "band" ? "38" : ""),
    width: filled ? 0 : series.style === "envelope" ? 1.25 : 2,
    ...(series.dashed && !filled ? { dash: [6, 4] } : {}),
    paths: pathsOf(series),
    points: { show: false },
  };
}

function sizeOf(chart: Chart, host: HTMLElement): { width: number; height: number } {
  const width = host.clientWidth;
  const rows = chart.y.categories;
  if (rows) return { width, height: 110 + rowHeightPx(rows, width) * rows.length };
  const ratio = chart.map ? 0.75 : 0.5;
  return { width, height: Math.round(Math.min(Math.max(ratio * width, 280), 460)) };
}

function cursorOf(u: uPlot): Pixel | undefined {
  const { left, top } = u.cursor;
  return left === undefined || top === undefined || left < 0 ? undefined : { left, top };
}

const between = (a: number, b: number): Extent => ({ low: Math.min(a, b), high: Math.max(a, b) });

function scaled(axis: Axis, e: Extent, factor: number, shift: number): Extent {
  const [to, from] = axis.log ? [Math.log, Math.exp] : [Number, Number];
  const [low, high] = [to(e.low), to(e.high)];
  const half = 0.5 * factor * (high - low);
  const middle = 0.5 * (low + high) + shift * (high - low);
  return { low: from(middle - half), high: from(middle + half) };
}

function cut(series: Series, x: Extent): Series {
  const from = Math.max(0, lowerBound(series.x, x.low) - 1);
  const to = lowerBound(series.x, x.high) + 1;
  const part = (v: ArrayLike<number>): number[] => Array.prototype.slice.call(v, from, to);
  return {
    ...series,
    x: part(series.x),
    y: part(series.y),
    ...(series.high ? { high: part(series.high) } : {}),
  };
}
