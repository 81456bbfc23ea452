// Words in the scene: HTML laid over the picture, so that they stay sharp and take the page's font and theme.

import * as THREE from "three";

interface Label {
  at: THREE.Vector3;
  element: HTMLElement;
}

export class Labels {
  private readonly layer = document.createElement("div");
  private readonly hidden = new Set<string>();
  private readonly groups = new Map<string, Label[]>();

  constructor(host: HTMLElement) {
    this.layer.className = "labels";
    this.layer.setAttribute("aria-hidden", "true");
    host.append(this.layer);
  }

  /** Empties a group. */
  group(name: string): void {
    for (const { element } of this.groups.get(name) ?? []) element.remove();
    this.groups.set(name, []);
  }

  add(group: string, at: THREE.Vector3, text: string, kind: string): void {
    const element = document.createElement("span");
    element.className = `label ${kind}`;
    element.textContent = text;
    this.layer.append(element);
    if (!this.groups.has(group)) this.groups.set(group, []);
    this.groups.get(group)!.push({ at, element });
  }

  visible(name: string, on: boolean): void {
    if (on) this.hidden.delete(name);
    else this.hidden.add(name);
  }

  /**
   * Puts every label where its point is seen; of two that would cover each other the later one goes, and so does one of
   * what `covered` says lies behind something.
   */
  place(camera: THREE.Camera, size: THREE.Vector2, covered: (group: string, at: THREE.Vector3) => boolean): void {
    const taken: [number, number, number, number][] = [];
    const point = new THREE.Vector3();
    for (const [name, labels] of this.groups) {
      for (const { at, element } of labels) {
        point.copy(at).project(camera);
        const x = ((point.x + 1) / 2) * size.x;
        const y = ((1 - point.y) / 2) * size.y;
        const [w, h] = [element.textContent!.length * 6.2 + 10, 17];
        const box: [number, number, number, number] = [x - w / 2, y - h / 2, x + w / 2, y + h / 2];
        const outside = this.hidden.has(name) || point.z > 1 || point.z < -1 || box[0] < 0 || box[1] < 0 || box[2] > size.x || box[3] > size.y;
        const gone = outside || taken.some((t) => box[0] < t[2] && box[2] > t[0] && box[1] < t[3] && box[3] > t[1]) || covered(name, at);
        element.style.visibility = gone ? "hidden" : "visible";
        if (gone) continue;
        taken.push(box);
        element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
      }
    }
  }
}
