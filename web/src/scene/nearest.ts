// The two nearest bodies of the cell: a line between their nearest points, with the distance and the names. Red where they are nearer
// than demanded.

import * as THREE from "three";
import { fixed } from "../format";
import type { DrawnCell, Posture } from "../types";
import type { Labels } from "./labels";
import { Segments } from "./segments";

const [FREE, NEAR] = [0x10707f, 0xd0312d];
const GROUP = "nearest";
/** The label is so many radii of an end above the middle. */
const ABOVE = 9;

/** "12.3 mm  spindle – fence". */
export function nearestText({ clearance_mm, nearest }: Pick<Posture, "clearance_mm" | "nearest">): string | null {
  return clearance_mm === null || nearest === null ? null : `${fixed(clearance_mm, 1)} mm  ${nearest.join(" – ")}`;
}

export class NearestPair {
  readonly group = new THREE.Group();
  private readonly line = new Segments({ width: 3, colour: FREE, opacity: 1 });
  private readonly ends: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>[];

  constructor(private readonly labels: Labels) {
    // Before others: its label has the place.
    labels.group(GROUP);
    const ball = new THREE.SphereGeometry(1, 20, 14);
    this.ends = [0, 1].map(() => new THREE.Mesh(ball, new THREE.MeshBasicMaterial({ depthTest: false, transparent: true })));
    this.line.object.material.depthTest = false;
    for (const object of [this.line.object, ...this.ends]) {
      object.renderOrder = 5;
      this.group.add(object);
    }
    this.group.visible = false;
  }

  /** `size`: radius of the ends, mm. */
  draw(cell: DrawnCell | null, posture: Posture | null, size: number): void {
    this.labels.group(GROUP);
    const points = cell?.nearest_mm;
    const text = posture && nearestText(posture);
    this.group.visible = Boolean(points && text);
    if (!points || !text || !cell) return;
    const [a, b] = points.map((at) => new THREE.Vector3(...at)) as [THREE.Vector3, THREE.Vector3];
    const colour = cell.keeps_clearance ? FREE : NEAR;
    this.line.begin();
    this.line.add(points[0], 0, points[1], 0);
    this.line.end();
    this.line.object.material.color.set(colour);
    this.ends.forEach((end, i) => {
      end.position.copy(i === 0 ? a : b);
      end.scale.setScalar(size);
      end.material.color.set(colour);
    });
    // Above the line, which it would hide.
    const above = a.clone().add(b).multiplyScalar(0.5);
    above.z += ABOVE * size;
    this.labels.add(GROUP, above, text, cell.keeps_clearance ? "clear" : "near");
  }
}
