// The load cases as a small table: one force per row, in newton, base axes.

import { fill, h } from "../dom";
import { parseNumber } from "../format";
import type { Vec3 } from "../types";

export class Forces {
  readonly root: HTMLElement;
  readonly id = "field-forces";
  private readonly body = h("tbody");
  private readonly error = h("p", { class: "field-error", role: "alert" });
  private cases: Vec3[] = [];

  constructor(private readonly input: (cases: Vec3[]) => void) {
    this.root = h(
      "div",
      { class: "field forces" },
      h("span", { class: "field-name", id: "forces-name" }, "Load cases (N), one per row"),
      h("table", { "aria-labelledby": "forces-name" }, h("thead", {}, h("tr", {}, ["x", "y", "z", ""].map((t) => h("th", { scope: "col" }, t)))), this.body),
      h("button", { type: "button", class: "quiet small", onclick: () => this.put([...this.cases, this.cases.at(-1) ?? [0, 0, 0]]) }, "Add a case"),
      this.error,
    );
  }

  set(cases: Vec3[] | null): void {
    this.root.hidden = cases === null;
    if (cases === null) return;
    this.clear();
    const same = cases.length === this.cases.length && this.body.contains(document.activeElement);
    this.cases = cases.map((c) => [...c] as Vec3);
    if (same) return;
    fill(
      this.body,
      ...this.cases.map((force, row) =>
        h(
          "tr",
          {},
          force.map((value, axis) => h("td", {}, this.box(value, row, axis))),
          h("td", {}, h("button", { type: "button", class: "icon", "aria-label": `Remove case ${row + 1}`, disabled: this.cases.length === 1, onclick: () => this.put(this.cases.filter((_, i) => i !== row)) }, "×")),
        ),
      ),
    );
  }

  refuse(message: string, hint: string | HTMLElement | null): void {
    this.error.replaceChildren(message, ...(hint ? [h("span", { class: "hint" }, hint)] : []));
  }

  clear(): void {
    this.error.replaceChildren();
  }

  private put(cases: Vec3[]): void {
    this.input(cases);
  }

  private box(value: number, row: number, axis: number): HTMLInputElement {
    const box = h("input", { type: "text", inputmode: "decimal", class: "number", value, "aria-label": `Case ${row + 1}, force along ${"xyz"[axis]}, newton` });
    const take = (next: number | null) => {
      if (next === null) {
        box.setAttribute("aria-invalid", "true");
        return;
      }
      box.removeAttribute("aria-invalid");
      this.cases[row]![axis] = next;
      this.input(this.cases.map((c) => [...c] as Vec3));
    };
    box.addEventListener("input", () => take(parseNumber(box.value)));
    box.addEventListener("keydown", (e) => {
      if (e.key !== "ArrowUp" && e.key !== "ArrowDown") return;
      e.preventDefault();
      const next = (parseNumber(box.value) ?? 0) + (e.key === "ArrowUp" ? 1 : -1) * (e.shiftKey ? 10 : 1);
      box.value = String(next);
      take(next);
    });
    return box;
  }
}
