// Labels of the scene: HTML over the picture, to be sharp and to use the font and theme of the page.

import * as THREE from "three";

interface Label {
  at: THREE.Vector3;
  element: HTMLElement;
  /** Values in the element: unchanged values are not written again. */
  text: string;
  kind: string;
  place: string;
  shown: boolean;
}
/** Labels of one kind of thing; of `all` the first `used` are in use. */
interface Group {
  all: Label[];
  used: number;
}

/** Left, top, right, bottom in the picture. */
export type Box = [number, number, number, number];

export class Labels {
  /** Areas without labels: elements over the picture. */
  keep_out: Box[] = [];
  private readonly layer = document.createElement("div");
  private readonly hidden = new Set<string>();
  private readonly groups = new Map<string, Group>();

  constructor(host: HTMLElement) {
    this.layer.className = "labels";
    this.layer.setAttribute("aria-hidden", "true");
    host.append(this.layer);
  }

  /** Empties a group. */
  group(name: string): void {
    const group = this.groups.get(name);
    if (group) group.used = 0;
    else this.groups.set(name, { all: [], used: 0 });
  }

  add(name: string, at: THREE.Vector3, text: string, kind: string): void {
    if (!this.groups.has(name)) this.group(name);
    const group = this.groups.get(name)!;
    const label = (group.all[group.used++] ??= this.made());
    label.at = at;
    if (label.text !== text) label.element.textContent = label.text = text;
    if (label.kind !== kind) label.element.className = `label ${(label.kind = kind)}`;
  }

  private made(): Label {
    const element = document.createElement("span");
    this.layer.append(element);
    return { at: new THREE.Vector3(), element, text: "", kind: "", place: "", shown: true };
  }

  visible(name: string, on: boolean): void {
    if (on) this.hidden.delete(name);
    else this.hidden.add(name);
  }

  /**
   * Puts every label where its point is seen; of two that would cover each other the later one goes, and so does one of
   * points that are hidden according to `covered`.
   */
  place(camera: THREE.Camera, size: THREE.Vector2, covered: (group: string, at: THREE.Vector3) => boolean): void {
    const taken: Box[] = [...this.keep_out];
    const point = new THREE.Vector3();
    for (const [name, { all, used }] of this.groups) {
      all.forEach((label, i) => {
        const { at, text } = label;
        point.copy(at).project(camera);
        const x = ((point.x + 1) / 2) * size.x;
        const y = ((1 - point.y) / 2) * size.y;
        const [w, h] = [text.length * 6.2 + 10, 17];
        const box: Box = [x - w / 2, y - h / 2, x + w / 2, y + h / 2];
        const outside = i >= used || this.hidden.has(name) || point.z > 1 || point.z < -1 || box[0] < 0 || box[1] < 0 || box[2] > size.x || box[3] > size.y;
        const shown = !(outside || taken.some((t) => box[0] < t[2] && box[2] > t[0] && box[1] < t[3] && box[3] > t[1]) || covered(name, at));
        if (shown !== label.shown) label.element.style.visibility = (label.shown = shown) ? "visible" : "hidden";
        if (!shown) return;
        taken.push(box);
        const place = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
        if (place !== label.place) label.element.style.transform = label.place = place;
      });
    }
  }
}
