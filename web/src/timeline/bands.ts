// Operations and tools of the program as bands over the charts; a click goes to the first point of one. One of each band is a tab stop,
// arrow keys go to the others.

import { fill, h } from "../dom";
import type { OperationInView } from "../types";
import type { Axis } from "./axis";

export interface Band {
  first: number;
  end: number;
  text: string;
  about: string;
}

/** One band for each operation. */
export function operationBands(operations: OperationInView[]): Band[] {
  return operations.map(({ first, points, name, tool, line }, i) => {
    const text = name ?? `Operation ${i + 1}`;
    return { first, end: first + points, text, about: `${text}${tool === null ? "" : `, tool ${tool}`}, from line ${line}` };
  });
}

/** One band for consecutive operations with the same tool; none if no tool is given. */
export function toolBands(operations: OperationInView[]): Band[] {
  if (operations.every(({ tool }) => tool === null)) return [];
  const bands: Band[] = [];
  let before: number | null | undefined;
  for (const { first, points, tool } of operations) {
    const last = bands.at(-1);
    if (last && tool === before) last.end = first + points;
    else bands.push({ first, end: first + points, text: tool === null ? "–" : `T${tool}`, about: tool === null ? "Tool not given" : `Tool ${tool}` });
    before = tool;
  }
  return bands;
}

export class BandRow {
  readonly root: HTMLElement;
  private readonly host = h("div", { class: "band-buttons", role: "toolbar" });
  private buttons: HTMLButtonElement[] = [];
  private bands: Band[] = [];
  private current = -1;

  constructor(title: string, private readonly go: (index: number) => void) {
    this.host.setAttribute("aria-label", title);
    this.root = h("div", { class: "strip band" }, h("span", { class: "strip-name" }, title), this.host, h("span", { class: "strip-value" }));
    this.host.addEventListener("keydown", (event) => this.key(event));
  }

  show(bands: Band[], axis: Axis): void {
    this.bands = bands;
    this.current = -1;
    this.root.hidden = bands.length === 0;
    this.buttons = bands.map(({ first, end, text, about }, i) => {
      const [left, right] = [axis.place(first), i + 1 < bands.length ? axis.place(bands[i + 1]!.first) : axis.place(end - 1)];
      return h("button", { type: "button", tabindex: -1, title: about, style: `left:${100 * left}%;width:${100 * Math.max(0, right - left)}%`, onclick: () => this.go(first) }, text);
    });
    fill(this.host, ...this.buttons);
  }

  /** The band of this point is the current one. */
  at(index: number): void {
    const current = lastFrom(this.bands, index);
    if (current === this.current) return;
    this.mark(this.current, false);
    this.mark(current, true);
    this.current = current;
  }

  private mark(i: number, on: boolean): void {
    const button = this.buttons[i];
    if (!button) return;
    button.tabIndex = on ? 0 : -1;
    if (on) button.setAttribute("aria-current", "true");
    else button.removeAttribute("aria-current");
  }

  private key(event: KeyboardEvent): void {
    const step = { ArrowRight: 1, ArrowLeft: -1, Home: -Infinity, End: Infinity }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const i = Math.max(0, Math.min(this.bands.length - 1, this.current + step));
    this.go(this.bands[i]!.first);
    this.at(this.bands[i]!.first);
    this.buttons[i]!.focus();
  }
}

/** The last band that begins at or before this point; -1 if none does. */
export function lastFrom(bands: Pick<Band, "first">[], index: number): number {
  let [low, high] = [0, bands.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (bands[middle]!.first <= index) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
