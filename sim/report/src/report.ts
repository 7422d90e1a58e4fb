/** What the program wrote into the page: its --json answer, how it was asked, and long series. */

export type Numbers = Float32Array | Float64Array;

export interface Report {
  readonly leeway: string;
  readonly command: string;
  readonly command_line: string;
  readonly input: Readonly<Record<string, unknown>>;
  readonly results: unknown;
  /** Of leeway interval: outages that the scene scripts, and what aiding gives. */
  readonly outages?: unknown;
  readonly aiding?: unknown;
  readonly series: Readonly<Record<string, Table>>;
}

/**
 * Columns of equal length. Where rows were taken together to keep the page small, a column `a` has
 * the least and a column `a_max` the greatest of each group, and the first column its begin.
 */
export class Table {
  private readonly columns: Map<string, Numbers>;
  /** How many rows are behind each row here. */
  readonly taken_together: number;

  constructor(encoded: EncodedTable) {
    this.taken_together = encoded.taken_together;
    this.columns = new Map(
      Object.entries(encoded.columns).map(([name, column]) => [name, numbersOf(column)]),
    );
  }


  column(name: string): Numbers {
    const found = this.columns.get(name);
    if (!found) throw new Error(`the report has no column '${name}'`);
    return found;
  }

  /** Greatest values where rows were taken together. */
  highest(name: string): Numbers | undefined {
    return this.columns.get(`${name}_max`);
  }
}

/** Base64 of little-endian numbers, as on every machine that runs a browser. */
type EncodedColumn = { readonly f32: string } | { readonly f64: string };

interface EncodedTable {
  readonly taken_together: number;
  readonly columns: Readonly<Record<string, EncodedColumn>>;
}

type EncodedReport = Omit<Report, "series"> & {
  readonly series: Readonly<Record<string, EncodedTable>>;
};

/** @param text  as the program wrote it */
export function parseReport(text: string): Report {
  const encoded = JSON.parse(text) as EncodedReport;
  const tables = Object.entries(encoded.series).map(
    ([name, table]) => [name, new Table(table)] as const,
  );
  return { ...encoded, series: Object.fromEntries(tables) };
}

function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

function numbersOf(column: EncodedColumn): Numbers {
  return "f64" in column
    ? new Float64Array(bytesOf(column.f64))
    : new Float32Array(bytesOf(column.f32));
}
