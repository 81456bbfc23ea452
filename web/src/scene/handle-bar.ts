// Buttons that choose a handle of the scene, and whether it snaps. The values are in the settings, where they can be typed.

import { h } from "../dom";
import type { Live } from "../live";
import { SNAP_DEG, SNAP_MM, type Handle } from "./handles";
import type { SceneView } from "./view";

const HANDLES: [Handle, string, string][] = [
  ["move part", "Move part", "Handles that move the part"],
  ["turn part", "Turn part", "Handles that turn the part"],
  ["move tool", "Move tool", "Handles that move the tool on the flange"],
];

export function handleBar(view: SceneView, live: Live): HTMLElement {
  const { handles } = view;
  const buttons = HANDLES.map(([handle, text, title]) => h("button", { type: "button", title, "data-handle": handle, "aria-pressed": "false", onclick: () => handles.choose(handles.handle === handle ? null : handle) }, text));
  const box = h("input", { type: "checkbox", checked: true });
  box.addEventListener("change", () => handles.setSnap(box.checked));
  const snap = h("label", { class: "snap", hidden: true, title: `To ${SNAP_MM} mm and ${SNAP_DEG}°` }, box, " Snap");
  const draw = () => {
    HANDLES.forEach(([handle], i) => {
      buttons[i]!.setAttribute("aria-pressed", String(handles.handle === handle));
      buttons[i]!.disabled = !handles.possible(handle);
    });
    snap.hidden = handles.handle === null;
  };
  handles.onChange = draw;
  live.listen(["answer", "pose", "study"], draw);
  return h("div", { class: "handles card", role: "group", "aria-label": "Handles" }, buttons, snap);
}
