// Elements of the page. Text goes in as text, never as markup: a case may be called anything.

type Child = Node | string | null | undefined | false;
type Properties = Record<string, unknown>;

/** An element with properties (`class`, `aria-...`, `data-...` and the like as attributes, `on...` as listeners). */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Properties = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value as EventListener);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children) if (child) element.append(child);
  return element;
}

export function by_id<E extends HTMLElement>(id: string): E {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no element ${id}`);
  return element as E;
}

/** A button that is on or off. */
export function toggle(label: string, title: string, is_on: boolean, change: (on: boolean) => void): HTMLLabelElement {
  const box = h("input", { type: "checkbox", onchange: () => change(box.checked) });
  box.checked = is_on;
  return h("label", { class: "toggle", title }, box, label);
}

export function choice(
  label: string,
  options: readonly (readonly [value: string, text: string])[],
  chosen: string,
  change: (value: string) => void,
): { label: HTMLLabelElement; select: HTMLSelectElement } {
  const select = h("select", { onchange: () => change(select.value) });
  for (const [value, text] of options) select.append(h("option", { value }, text));
  select.value = chosen;
  return { label: h("label", { class: "choice" }, h("span", {}, label), select), select };
}

/** What words of tables and plots mean; docs/theory.md and docs/glossary.md say it exactly. */
const meanings: Record<string, string> = {
  "first touch": "when a contact force acts for the first time",
  left: "when the last contact force has ended",
  "99 % of push": "time from the first touch until 99 % of the final impulse",
  "peak force": "largest sum of the contact forces",
  "impulse, N s": "x and y, on the bodies; of two bodies on the first one",
  e: "restitution: velocity away over velocity towards each other, of the centres of mass of what touched",
  "e along": "restitution along the boundary: -1 without friction, 0 where it ends up rolling, 1 where it is thrown back",
  elastic: "stress work that was not plastic",
  dropped: "energy in contact springs that were let go while loaded",
  total: "kinetic + elastic + plastic + contact + ties + friction + dropped + damping; gravity, loads, supports and moving obstacles bring energy in from outside",
  error: "total less what was there at the start and what came in from outside",
  "momentum error": "largest over time: momentum less impulses, part of the momentum",
  "energy error": "largest over time: part of the energy that the books do not account for",
  penetration: "deepest penetration of a node over the size of the boundary there",
};

export const meaning = (words: string): string | undefined => meanings[words];

/** A table with a heading row; the first column names the row, numbers stand on the right. */
export function table(caption: string, heads: string[], rows: string[][]): HTMLElement {
  const row = (cells: string[]) =>
    h("tr", {}, ...cells.map((cell, k) => (k === 0 ? h("th", { scope: "row" }, cell) : h("td", {}, cell))));
  return h(
    "div",
    { class: "scroll", tabindex: "0", role: "region", "aria-label": caption },
    h(
      "table",
      {},
      h("caption", {}, caption),
      h("thead", {}, h("tr", {}, ...heads.map((head) => h("th", { scope: "col", title: meaning(head) }, head)))),
      h("tbody", {}, ...rows.map(row)),
    ),
  );
}
