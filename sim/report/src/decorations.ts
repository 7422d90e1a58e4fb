/** What is drawn beside the series: shaded spans, lines across, texts, scale bar and north. */
import type uPlot from "uplot";
import type { Chart, Series } from "./chart";
import { kFont } from "./axes";
import { theme } from "./theme";
import { withUnit } from "./words";

/** Under the series. */
export function drawUnder(u: uPlot, chart: Chart): void {
  inside(u, (ctx) => {
    ctx.fillStyle = theme().shade;
    for (const span of chart.spans ?? []) {
      const from = u.valToPos(span.from, "x", true);
      const width = Math.max(u.valToPos(span.to, "x", true) - from, devicePixelRatio);
      ctx.fillRect(from, u.bbox.top, width, u.bbox.height);
    }
    ctx.strokeStyle = theme().level;
    ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
    for (const level of chart.levels ?? []) {
      const y = u.valToPos(level.at, "y", true);
      ctx.beginPath();
      ctx.moveTo(u.bbox.left, y);
      ctx.lineTo(u.bbox.left + u.bbox.width, y);
      ctx.stroke();
    }
  });
}

/** Over the series. */
export function drawOver(u: uPlot, chart: Chart): void {
  inside(u, (ctx) => {
    ctx.fillStyle = theme().text;
    const px = devicePixelRatio;
    let free = Infinity; // of labels, from the bottom up
    for (const level of [...(chart.levels ?? [])].sort((a, b) => a.at - b.at)) {
      const y = u.valToPos(level.at, "y", true);
      if (free - y < 14 * px) continue;
      free = y;
      const above = y - 4 * px > u.bbox.top + 12 * px;
      ctx.fillText(level.label, u.bbox.left + 6 * px, above ? y - 4 * px : y + 14 * px);
    }
    for (const series of chart.series) if (series.texts) cellTexts(u, ctx, series);
    if (chart.map) mapMarks(u, ctx);
  });
}

function inside(u: uPlot, draw: (ctx: CanvasRenderingContext2D) => void): void {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.font = kFont.replace("12px", `${12 * devicePixelRatio}px`);
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([]);
  ctx.textAlign = "left";
  ctx.textBaseline = "alphabetic";
  draw(ctx);
  ctx.restore();
}

function cellTexts(u: uPlot, ctx: CanvasRenderingContext2D, series: Series): void {
  const room = Math.abs(u.valToPos(1, "x", true) - u.valToPos(0, "x", true)) - 6;
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.fillStyle = theme().onMark;
  series.texts?.forEach((text, i) => {
    if (ctx.measureText(text).width > room) return;
    const x = u.valToPos(series.x[i] as number, "x", true);
    ctx.fillText(text, x, u.valToPos(series.y[i] as number, "y", true));
  });
}

/** A bar of a round length in the lower left corner, an arrow to north in the upper right. */
function mapMarks(u: uPlot, ctx: CanvasRenderingContext2D): void {
  const px = devicePixelRatio;
  const pxPerMetre = u.valToPos(1, "x", true) - u.valToPos(0, "x", true);
  const wanted = (0.25 * u.bbox.width) / pxPerMetre;
  const decade = 10 ** Math.floor(Math.log10(wanted));
  const metres = decade * ([5, 2, 1].find((m) => m * decade <= wanted) ?? 1);
  const [x, y] = [u.bbox.left + 12 * px, u.bbox.top + u.bbox.height - 12 * px];
  const length = metres * pxPerMetre;
  ctx.strokeStyle = theme().text;
  ctx.lineWidth = 2 * px;
  ctx.beginPath();
  ctx.moveTo(x, y - 5 * px);
  ctx.lineTo(x, y);
  ctx.lineTo(x + length, y);
  ctx.lineTo(x + length, y - 5 * px);
  ctx.stroke();
  const text = metres >= 1000 ? withUnit(metres / 1000, "km") : withUnit(metres, "m");
  ctx.textAlign = "center";
  ctx.fillText(text, x + length / 2, y - 6 * px);
  const [nx, ny] = [u.bbox.left + u.bbox.width - 16 * px, u.bbox.top + 12 * px];
  ctx.beginPath();
  ctx.moveTo(nx - 6 * px, ny + 14 * px);
  ctx.lineTo(nx, ny);
  ctx.lineTo(nx + 6 * px, ny + 14 * px);
  ctx.stroke();
  ctx.fillText("N", nx, ny + 28 * px);
}
