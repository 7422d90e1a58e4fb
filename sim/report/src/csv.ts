/** The data of a chart as text that a spreadsheet opens: a row for each point. */
import type { Axis, Chart, Values } from "./chart";

export function csvOf(chart: Chart): string {
  const named = chart.series.some((s) => s.names);
  const high = chart.series.some((s) => s.high);
  const heading = ["series", ...(named ? ["name"] : []), head(chart.x), head(chart.y)];
  if (high) heading.push(`${head(chart.y)}, to`);
  const lines = [heading.map(field).join(",")];
  for (const series of chart.series) {
    for (let i = 0; i < series.x.length; ++i) {
      const row = [field(series.label), ...(named ? [field(series.names?.[i] ?? "")] : [])];
      row.push(value(chart.x, series.x, i), value(chart.y, series.y, i));
      if (high) row.push(series.high ? number(series.high, i) : "");
      lines.push(row.join(","));
    }
  }
  return `${lines.join("\n")}\n`;
}

const head = (axis: Axis): string => (axis.unit ? `${axis.label}, ${axis.unit}` : axis.label);

function value(axis: Axis, values: Values, i: number): string {
  return axis.categories ? field(axis.categories[values[i] as number] ?? "") : number(values, i);
}

/** As short as reads back as the same number of its precision. */
function number(values: Values, i: number): string {
  const v = values[i] as number;
  if (!Number.isFinite(v)) return "";
  if (!(values instanceof Float32Array)) return String(v);
  for (let digits = 6; digits < 9; ++digits) {
    const text = Number(v.toPrecision(digits));
    if (Math.fround(text) === v) return String(text);
  }
  return String(Number(v.toPrecision(9)));
}

const field = (text: string): string =>
  /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
