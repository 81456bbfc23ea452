// The plate with a path: plain and transparent, so that the path is visible.

import * as THREE from "three";
import type { Plate } from "../types";

export class Part {
  readonly group = new THREE.Group();

  draw(plate: Plate | null): void {
    for (const child of this.group.children) (child as THREE.Mesh).geometry.dispose();
    this.group.clear();
    if (!plate || plate.corners_mm.length < 4) return;
    const corners = plate.corners_mm.map((c) => new THREE.Vector3(...c));
    const face = new THREE.BufferGeometry().setFromPoints(corners).setIndex([0, 1, 2, 0, 2, 3]);
    this.group.add(new THREE.Mesh(face, new THREE.MeshBasicMaterial({ color: 0x8fa3b8, transparent: true, opacity: 0.22, side: THREE.DoubleSide, depthWrite: false })));
    const edge = new THREE.BufferGeometry().setFromPoints([...corners, corners[0]!]);
    this.group.add(new THREE.Line(edge, new THREE.LineBasicMaterial({ color: 0x7b8896 })));
  }
}
