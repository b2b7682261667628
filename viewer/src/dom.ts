// Elements of the page.

type Child = Node | string;

/** An element with attributes and children. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

export function button(caption: string, title: string, pressed: () => void): HTMLButtonElement {
  const element = make("button", { type: "button", title }, caption);
  element.addEventListener("click", pressed);
  return element;
}

/** A menu with its label; entries are [value, caption] or groups of them. */
export function menu(
  id: string,
  label: string,
  entries: ([string, string] | { group: string; entries: [string, string][] })[],
  chosen: (value: string) => void,
): HTMLSelectElement {
  const option = ([value, caption]: [string, string]) => make("option", { value }, caption);
  const select = make("select", { id });
  for (const entry of entries) {
    select.append(
      Array.isArray(entry) ? option(entry) : make("optgroup", { label: entry.group }, ...entry.entries.map(option)),
    );
  }
  select.setAttribute("aria-label", label);
  select.addEventListener("change", () => chosen(select.value));
  return select;
}

export function labelled(caption: string, ...controls: Child[]): HTMLLabelElement {
  return make("label", {}, make("span", {}, caption), ...controls);
}

/** Gives the reader a file. */
export function save(name: string, content: Blob): void {
  const link = make("a", { href: URL.createObjectURL(content), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** What is printed is on white paper, whatever the screen is. */
const PAPER: Record<string, string> = {
  "--paper": "#ffffff",
  "--ink": "#000000",
  "--line": "#c8cdd2",
  "--ground": "#ffffff",
  "--mesh": "#26323f",
};
let printing = false;
addEventListener("beforeprint", () => (printing = true));
addEventListener("afterprint", () => (printing = false));

/** A colour of the page's style. */
export function style(name: string): string {
  return (printing && PAPER[name]) || getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
