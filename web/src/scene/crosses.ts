// Holes that cannot be drilled: a cross over each, with its number.

import * as THREE from "three";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { LostHole } from "../headline";
import type { Vec3 } from "../types";
import type { Labels } from "./labels";
import { fat } from "./lines";

const GROUP = "lost";

export class Crosses {
  readonly group = new THREE.Group();
  private readonly casing = fat({ width: 7, colour: 0xffffff, opacity: 0.95 });
  private readonly cross = fat({ width: 3.6, colour: 0xc2185b, opacity: 1 });

  constructor(private readonly labels: Labels) {
    for (const line of [this.casing, this.cross]) {
      line.material.depthTest = false;
      this.group.add(line);
    }
    [this.casing.renderOrder, this.cross.renderOrder] = [8, 9];
  }

  /** `at`: the points of all holes; `size_mm`: half a diagonal of a cross. */
  draw(lost: LostHole[], at: Vec3[], normals: (Vec3 | null)[], size_mm: number): void {
    this.labels.group(GROUP);
    const ends: number[] = [];
    for (const [i, { hole }] of lost.entries()) {
      const centre = at[hole - 1];
      if (!centre) continue;
      const middle = new THREE.Vector3(...centre);
      const normal = new THREE.Vector3(...(normals[i] ?? [0, 0, 1])).normalize();
      const across = new THREE.Vector3(0, 0, 1).cross(normal);
      if (across.length() < 1e-3) across.set(1, 0, 0);
      const up = normal.clone().cross(across.normalize());
      for (const side of [1, -1]) {
        const arm = across.clone().addScaledVector(up, side).multiplyScalar(size_mm * Math.SQRT1_2);
        ends.push(...middle.clone().sub(arm).toArray(), ...middle.clone().add(arm).toArray());
      }
      this.labels.add(GROUP, middle.clone().addScaledVector(up, 1.9 * size_mm), String(hole), "lost");
    }
    for (const line of [this.casing, this.cross]) {
      line.visible = ends.length > 0;
      if (ends.length > 0) line.geometry = new LineSegmentsGeometry().setPositions(ends);
    }
  }
}
