// The target of the robot as numbers: the keyboard alternative to a click in the scene, and a way to step along a path.

import { NumberField } from "../controls/field";
import { fill } from "../dom";
import type { Live } from "../live";
import { panel } from "./panel";

export function target(live: Live): HTMLElement {
  const { root, body } = panel("target", "Send the robot");
  let fields: NumberField[] = [];
  let made = "";

  const onMap = (): NumberField[] => {
    const { y_mm, z_mm } = live.map!.grid;
    const span = (list: number[]): [number, number] => [Math.min(...list), Math.max(...list)];
    const pitch = (list: number[]) => Math.abs((list[1] ?? 10) - (list[0] ?? 0)) || 10;
    let place = { y_mm: 0, z_mm: 0 };
    const go = (part: Partial<typeof place>) => {
      if (typeof live.at?.y_mm === "number" && typeof live.at.z_mm === "number") place = { y_mm: live.at.y_mm, z_mm: live.at.z_mm };
      place = { ...place, ...part };
      live.goTo(live.onPlate(place.y_mm, place.z_mm));
    };
    return [
      new NumberField({ id: "target-y", label: "y′ on the plate", unit: "mm", range: span(y_mm), step: pitch(y_mm), input: (v) => go({ y_mm: v }) }),
      new NumberField({ id: "target-z", label: "z′ on the plate", unit: "mm", range: span(z_mm), step: pitch(z_mm), input: (v) => go({ z_mm: v }) }),
    ];
  };
  const onPath = (): NumberField[] => {
    const n = live.scene!.points!.count;
    return [new NumberField({ id: "target-point", label: live.answer!.holes.length > 0 ? "Hole" : live.answer!.volumes.length > 0 ? "Point of the box" : "Point of the path", unit: "", range: [1, n], step: 1, input: (v) => live.goTo({ point: Math.min(n, Math.max(1, Math.round(v))) - 1 }) })];
  };
  const draw = () => {
    const { answer, scene, at } = live;
    if (!answer) return;
    const kind = answer.maps.length > 0 ? "map" : scene?.points ? "path" : "none";
    const key = `${kind} ${live.analysis} ${live.map?.grid.points} ${live.map?.grid.y_mm[0]} ${scene?.points?.count}`;
    root.hidden = kind === "none";
    if (key !== made) {
      made = key;
      fields = kind === "map" ? onMap() : kind === "path" ? onPath() : [];
      fill(body, ...fields.map((f) => f.root));
    }
    if (!at) return;
    if (typeof at.y_mm === "number" && kind === "map") {
      fields[0]!.set(at.y_mm);
      fields[1]!.set(at.z_mm ?? 0);
    }
    if (typeof at.point === "number" && kind === "path") fields[0]!.set(at.point + 1);
  };
  live.listen(["answer", "pose"], draw);
  return root;
}
