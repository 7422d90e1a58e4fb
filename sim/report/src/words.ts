/** Numbers and lists as text. */

/** Three significant digits or whole numbers, or "-" for what is not defined. */
export function short(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "-";
  const size = Math.abs(value);
  if (size >= 100 && size < 1e6) return String(Math.round(value));
  const digits = Number(value.toPrecision(3));
  return value !== 0 && (size < 1e-3 || size >= 1e6) ? digits.toExponential() : String(digits);
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
  return fraction > 0 && fraction < 1e-4 ? "< 0.01 %" : `${short(100 * fraction)} %`;
}

export function count(n: number, one: string, many = `${one}s`): string {
  return `${n} ${n === 1 ? one : many}`;
}
