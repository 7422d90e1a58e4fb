/** What a page says: in words, in tables, in charts. */
import type { Chart } from "./chart";
import type { Report } from "./report";

export interface Grid {
  readonly caption: string;
  readonly headings: readonly string[];
  readonly rows: readonly (readonly string[])[];
}

export interface View {
  /** The question that the command answers. */
  readonly title: string;
  readonly scene: readonly string[];
  /** The answer in sentences, the most important first. */
  readonly answer: readonly string[];
  readonly tables: readonly Grid[];
  /** What the answer rests on, and how sure it is. */
  readonly trust: readonly string[];
  readonly charts: readonly Chart[];
  /** Tables too long to stand above the charts. */
  readonly details?: readonly Grid[];
}

export type MakeView = (report: Report) => View;
