/** Elements made in one call. */

type Child = Node | string;

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Readonly<Record<string, string>> = {},
  ...children: readonly Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

export function button(label: string, hint: string, onClick: () => void): HTMLButtonElement {
  const made = element("button", { type: "button", title: hint, "aria-label": hint }, label);
  made.addEventListener("click", onClick);
  return made;
}
