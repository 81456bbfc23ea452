// Elements in one call: h("p", { class: "hint" }, "text", child).

export type Child = Node | string | number | null | undefined | false | Child[];
type Attributes = Record<string, string | number | boolean | null | undefined | ((event: never) => void)>;

export function h<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  set(element, attributes);
  add(element, children);
  return element;
}

const SVG = "http://www.w3.org/2000/svg";
export function s<K extends keyof SVGElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): SVGElementTagNameMap[K] {
  const element = document.createElementNS(SVG, tag);
  set(element, attributes);
  add(element, children);
  return element;
}

/** New children in place of the old. What had the focus has it again, if it has a data-key that is there again. */
export function fill(element: Element, ...children: Child[]): void {
  const focused = element.contains(document.activeElement) ? (document.activeElement as HTMLElement).dataset.key : undefined;
  element.replaceChildren();
  add(element, children);
  if (focused !== undefined) element.querySelector<HTMLElement>(`[data-key="${CSS.escape(focused)}"]`)?.focus({ preventScroll: true });
}

/**
 * As `fill`, with what is there already: nodes of the same kind stay and take on what is new, so that a number that changes
 * costs only its text. For children that are rebuilt each time, are not kept, and listen only to clicks.
 */
export function renew(element: Element, ...children: Child[]): void {
  const focused = element.contains(document.activeElement) ? (document.activeElement as HTMLElement).dataset.key : undefined;
  const made = document.createDocumentFragment();
  add(made, children);
  match(element, made);
  if (focused === undefined || (document.activeElement as HTMLElement).dataset.key === focused) return;
  element.querySelector<HTMLElement>(`[data-key="${CSS.escape(focused)}"]`)?.focus({ preventScroll: true });
}

/** The children of `made` in the place of those of `there`. */
function match(there: Node, made: Node): void {
  let old = there.firstChild;
  for (let node = made.firstChild; node !== null; ) {
    const following = node.nextSibling;
    if (old === null) there.appendChild(node);
    else {
      const next: ChildNode | null = old.nextSibling;
      if (old.nodeName === node.nodeName) take(old, node);
      else old.replaceWith(node);
      old = next;
    }
    node = following;
  }
  while (old !== null) {
    const next: ChildNode | null = old.nextSibling;
    old.remove();
    old = next;
  }
}

/** What is new in `made`. */
function take(old: Node, made: Node): void {
  if (!(old instanceof Element && made instanceof Element)) {
    if (old.nodeValue !== made.nodeValue) old.nodeValue = made.nodeValue;
    return;
  }
  for (const { name, value } of made.attributes) if (old.getAttribute(name) !== value) old.setAttribute(name, value);
  if (old.attributes.length > made.attributes.length) for (const { name } of [...old.attributes]) if (!made.hasAttribute(name)) old.removeAttribute(name);
  (old as HTMLElement).onclick = (made as HTMLElement).onclick;
  match(old, made);
}

function set(element: Element, attributes: Attributes): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") (element as unknown as Record<string, unknown>)[name] = value;
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, String(value));
  }
}

function add(element: Element | DocumentFragment, children: Child[]): void {
  for (const child of children) {
    if (Array.isArray(child)) add(element, child);
    else if (child instanceof Node) element.append(child);
    else if (child !== null && child !== undefined && child !== false) element.append(String(child));
  }
}
