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
      h("thead", {}, h("tr", {}, ...heads.map((head) => h("th", { scope: "col" }, head)))),
      h("tbody", {}, ...rows.map(row)),
    ),
  );
}
