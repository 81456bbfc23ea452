// Buttons that choose a handle of the scene, whether it snaps, and its values, which can be typed.

import { h } from "../dom";
import { parseNumber } from "../format";
import type { Live } from "../live";
import { SNAP_DEG, SNAP_MM, type Handle, type HandleValues } from "./handles";
import type { SceneView } from "./view";

const HANDLES: [Handle, string, string][] = [
  ["move part", "Move part", "Handles that move the part"],
  ["turn part", "Turn part", "Handles that turn the part"],
  ["move tool", "Move tool", "Handles that move the tool on the flange"],
  ["turn tool", "Turn tool", "Handles that turn the tool on the flange"],
];

export function handleBar(view: SceneView, live: Live): HTMLElement {
  const { handles } = view;
  const buttons = HANDLES.map(([handle, text, title]) => h("button", { type: "button", title, "data-handle": handle, "aria-pressed": "false", onclick: () => handles.choose(handles.handle === handle ? null : handle) }, text));
  const box = h("input", { type: "checkbox", checked: true });
  box.addEventListener("change", () => handles.setSnap(box.checked));
  const snap = h("label", { class: "snap", title: `To ${SNAP_MM} mm and ${SNAP_DEG}°` }, box, " Snap");
  const values = new ValueFields((typed) => handles.write(typed));
  const chosen = h("div", { class: "handle-values", hidden: true }, values.root, snap);
  const draw = () => {
    HANDLES.forEach(([handle], i) => {
      buttons[i]!.setAttribute("aria-pressed", String(handles.handle === handle));
      buttons[i]!.disabled = !handles.possible(handle);
    });
    const now = handles.values;
    chosen.hidden = now === null;
    if (now && live.settled) values.fill(now);
  };
  handles.onChange = draw;
  live.listen(["answer", "pose", "study"], draw);
  return h("div", { class: "handles card", role: "group", "aria-label": "Handles" }, h("div", { class: "handle-buttons" }, buttons), chosen);
}

/** Up to three numbers. What is no number is not taken; the server refuses what is out of range, as anywhere. */
class ValueFields {
  readonly root = h("span", { class: "handle-fields" });
  private boxes: HTMLInputElement[] = [];
  private made = "";
  private values: number[] = [];

  constructor(private readonly typed: (values: number[]) => void) {}

  fill({ names, unit, values }: HandleValues): void {
    this.values = [...values];
    const kind = `${names.join()} ${unit}`;
    if (kind !== this.made) {
      this.made = kind;
      this.boxes = names.map((name, i) => {
        const box = h("input", { class: "number", type: "text", inputmode: "decimal", autocomplete: "off", "aria-label": `${name}, ${unit}` });
        box.addEventListener("input", () => this.take(i, box));
        return box;
      });
      this.root.replaceChildren(...names.flatMap((name, i) => [h("span", {}, name), this.boxes[i]!]), h("span", { class: "unit" }, unit));
    }
    this.boxes.forEach((box, i) => {
      if (document.activeElement === box && parseNumber(box.value) === values[i]) return;
      box.value = String(values[i]);
      box.removeAttribute("aria-invalid");
    });
  }

  private take(index: number, box: HTMLInputElement): void {
    const value = parseNumber(box.value);
    if (value === null) return box.setAttribute("aria-invalid", "true");
    box.removeAttribute("aria-invalid");
    this.values[index] = value;
    this.typed([...this.values]);
  }
}
