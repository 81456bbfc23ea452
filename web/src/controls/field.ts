// A number to type, drag at its label, or set by a slider, with its unit and its error message.

import { h } from "../dom";
import { parseNumber } from "../format";

export interface FieldOptions {
  id: string;
  label: string;
  unit: string;
  /** Range of the slider; other values can be typed. None: no slider. */
  range?: [number, number];
  step: number;
  /** Called for every value while it changes. */
  input: (value: number) => void;
  hint?: string;
}

export class NumberField {
  readonly root: HTMLElement;
  private readonly box: HTMLInputElement;
  private readonly slider: HTMLInputElement | null;
  private readonly error: HTMLElement;
  private value: number | null = null;
  /** The last value that was accepted. */
  private accepted: number | null = null;

  constructor(private readonly options: FieldOptions) {
    const { id, label, unit, range, step, hint } = options;
    this.box = h("input", { id, class: "number", type: "text", inputmode: "decimal", autocomplete: "off", spellcheck: "false", "aria-describedby": `${id}-error` });
    this.slider = range ? h("input", { type: "range", min: range[0], max: range[1], step, tabindex: "-1", "aria-label": `${label}, ${unit}` }) : null;
    this.error = h("p", { class: "field-error", id: `${id}-error`, role: "alert" });
    const name = h("label", { for: id, class: "scrub", title: hint ?? `Drag sideways to change; arrow keys step by ${step} ${unit}` }, label);
    this.root = h("div", { class: "field" }, name, h("span", { class: "entry" }, this.box, h("span", { class: "unit" }, unit)), this.slider, this.error);
    this.box.addEventListener("input", () => this.typed());
    this.box.addEventListener("blur", () => this.error.textContent === "" && this.write());
    this.box.addEventListener("keydown", (e) => this.key(e));
    this.slider?.addEventListener("input", () => this.take(Number(this.slider!.value)));
    this.scrub(name);
  }

  get id(): string {
    return this.options.id;
  }

  /** Value from the server; a value being typed is kept. */
  set(value: number | null): void {
    this.root.hidden = value === null;
    this.accepted = value;
    this.clear();
    if (document.activeElement === this.box && parseNumber(this.box.value) === value) return;
    if (document.activeElement === this.slider && this.slider) {
      this.value = value;
      if (value !== null) this.box.value = String(value);
      return;
    }
    this.value = value;
    this.write();
  }

  refuse(message: string, hint: string | HTMLElement | null): void {
    this.box.setAttribute("aria-invalid", "true");
    this.error.replaceChildren(message, ...(hint ? [h("span", { class: "hint" }, hint)] : []));
  }

  clear(): void {
    if (!this.error.hasChildNodes()) return;
    this.box.removeAttribute("aria-invalid");
    this.error.replaceChildren();
  }

  focus(): void {
    this.box.focus();
  }

  private write(): void {
    if (this.value === null) return;
    const text = String(this.value);
    // Writing an unchanged value would cost as much.
    if (this.box.value !== text) this.box.value = text;
    if (!this.slider || this.slider.value === text) return;
    // A value beyond the range doubles the range of the slider.
    if (this.value > Number(this.slider.max)) this.slider.max = String(2 * this.value);
    if (this.value < Number(this.slider.min)) this.slider.min = String(Math.min(this.value, 2 * this.value));
    this.slider.value = text;
  }

  private typed(): void {
    const value = parseNumber(this.box.value);
    if (value === null) {
      this.refuse(this.box.value.trim() === "" ? "A number is required." : `"${this.box.value}" is not a number.`, `In ${this.options.unit}, such as ${this.accepted ?? this.options.step}.`);
      return;
    }
    this.clear();
    this.value = value;
    if (this.slider) this.slider.value = String(value);
    this.options.input(value);
  }

  private take(value: number): void {
    const rounded = Number(value.toFixed(6));
    if (rounded === this.value) return;
    this.clear();
    this.value = rounded;
    this.write();
    this.options.input(rounded);
  }

  private key(event: KeyboardEvent): void {
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    event.preventDefault();
    const step = this.options.step * (event.shiftKey ? 10 : 1) * (event.key === "ArrowUp" ? 1 : -1);
    this.take((this.value ?? 0) + step);
  }

  private scrub(handle: HTMLElement): void {
    let from: { x: number; value: number } | null = null;
    handle.addEventListener("pointerdown", (e) => {
      from = { x: e.clientX, value: this.value ?? 0 };
      handle.setPointerCapture(e.pointerId);
    });
    handle.addEventListener("pointermove", (e) => {
      if (!from) return;
      const steps = Math.round((e.clientX - from.x) / 3);
      if (steps !== 0) this.take(from.value + steps * this.options.step);
    });
    for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => (from = null));
  }
}
