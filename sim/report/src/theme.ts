/** Colours, light and dark. The palette is that of Okabe and Ito, made to be told apart by all. */

const kLight = ["#0072b2", "#d55e00", "#00805f", "#a8468c", "#b27700", "#2f2f2f", "#2b93d1"];
const kDark = ["#56b4e9", "#ff8a4c", "#2fc79b", "#e39ac6", "#e9b93b", "#d8d8d8", "#9fd3ff"];

export interface Theme {
  readonly text: string;
  readonly grid: string;
  readonly level: string;
  readonly shade: string;
  /** Of text on a mark. */
  readonly onMark: string;
  readonly palette: readonly string[];
}

const kThemes: Record<"light" | "dark", Theme> = {
  light: {
    text: "#333",
    grid: "#0000001c",
    level: "#777",
    shade: "#8888882e",
    onMark: "#fff",
    palette: kLight,
  },
  dark: {
    text: "#ccc",
    grid: "#ffffff22",
    level: "#999",
    shade: "#aaaaaa30",
    onMark: "#16171a",
    palette: kDark,
  },
};

const prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
const listeners: (() => void)[] = [];
let chosen: "light" | "dark" | undefined;

function current(): "light" | "dark" {
  return chosen ?? (prefersDark.matches ? "dark" : "light");
}

export function theme(): Theme {
  return kThemes[current()];
}

export function colour(index: number): string {
  const palette = theme().palette;
  return palette[index % palette.length] as string;
}

/** Called whenever the colours have changed. */
export function onTheme(listener: () => void): void {
  listeners.push(listener);
}

function apply(): void {
  document.documentElement.dataset["theme"] = current();
  for (const listener of listeners) listener();
}

export function startTheme(): void {
  prefersDark.addEventListener("change", apply);
  apply();
}

export function switchTheme(): void {
  chosen = current() === "dark" ? "light" : "dark";
  apply();
}
