// Choice of one option by name, with its error message.

import { fill, h } from "../dom";

export class Choice {
  readonly root: HTMLElement;
  private readonly select: HTMLSelectElement;
  private readonly error: HTMLElement;

  constructor(readonly id: string, label: string, input: (value: string) => void) {
    this.select = h("select", { id, "aria-describedby": `${id}-error` });
    this.error = h("p", { class: "field-error", id: `${id}-error`, role: "alert" });
    this.root = h("div", { class: "field choice" }, h("label", { for: id }, label), this.select, this.error);
    this.select.addEventListener("change", () => {
      this.clear();
      input(this.select.value);
    });
  }

  set(value: string | null, options: { value: string; text: string }[]): void {
    this.root.hidden = value === null;
    this.clear();
    const list = value !== null && !options.some((o) => o.value === value) ? [{ value, text: value }, ...options] : options;
    const key = JSON.stringify(list);
    if (this.select.dataset.key !== key) {
      this.select.dataset.key = key;
      fill(this.select, ...list.map((o) => h("option", { value: o.value }, o.text)));
    }
    if (value !== null) this.select.value = value;
  }

  refuse(message: string, hint: string | HTMLElement | null): void {
    this.select.setAttribute("aria-invalid", "true");
    this.error.replaceChildren(message, ...(hint ? [h("span", { class: "hint" }, hint)] : []));
  }

  clear(): void {
    this.select.removeAttribute("aria-invalid");
    this.error.replaceChildren();
  }
}
