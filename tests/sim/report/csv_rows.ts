/** A CSV file as rows by column. */

export type Row = Readonly<Record<string, string>>;

export function rowsOf(text: string): Row[] {
  const [head, ...lines] = text.trimEnd().split("\n").map(fieldsOf);
  return lines.map((fields) =>
    Object.fromEntries((head ?? []).map((name, i) => [name, fields[i] ?? ""])),
  );
}

function fieldsOf(line: string): string[] {
  const fields = line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g);
  return [...fields].map((field) => field[1]?.replaceAll('""', '"') ?? field[2] ?? "");
}

export function numberIn(row: Row | undefined, column: string): number {
  const text = row?.[column];
  return text === undefined || text === "" ? NaN : Number(text);
}
