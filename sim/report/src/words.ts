/** Numbers and lists as text. */

/** Three significant digits, or "-" for what is not defined. */
export function short(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "-";
  const size = Math.abs(value);
  if (value !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(2);
  return String(Number(value.toPrecision(size >= 100 ? Math.ceil(Math.log10(size + 1)) : 3)));
}

/** "58.6 s", "4.7 min (283 s)", "4 h (14400 s)". */
export function duration(seconds: number): string {
  if (seconds < 120) return `${short(seconds)} s`;
  const [value, unit] = seconds < 7200 ? [seconds / 60, "min"] : [seconds / 3600, "h"];
  return `${Number(value.toPrecision(2))} ${unit} (${short(seconds)} s)`;
}

export function withUnit(value: number | null | undefined, unit: string): string {
  const text = short(value);
  return text === "-" || unit === "" ? text : `${text} ${unit}`;
}

/** "a, b and c". */
export function list(items: readonly string[]): string {
  if (items.length < 2) return items.join("");
  return `${items.slice(0, -1).join(", ")} and ${items.at(-1)}`;
}

export function percent(fraction: number): string {
  return `${short(100 * fraction)} %`;
}

export function count(n: number, one: string, many = `${one}s`): string {
  return `${n} ${n === 1 ? one : many}`;
}
