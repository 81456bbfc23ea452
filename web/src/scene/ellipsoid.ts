// Compliance of the arm at the tool: half axes along the principal directions, with the deflection per newton as length.

import * as THREE from "three";
import type { Posture, Vec3 } from "../types";

export class Ellipsoid {
  readonly group = new THREE.Group();
  private readonly body: THREE.Mesh;
  private readonly rings: THREE.LineLoop[];

  constructor() {
    this.body = new THREE.Mesh(
      new THREE.SphereGeometry(1, 48, 32),
      new THREE.MeshStandardMaterial({ color: 0x56b4e9, transparent: true, opacity: 0.28, roughness: 0.3, depthWrite: false }),
    );
    const circle = Array.from({ length: 72 }, (_, i) => new THREE.Vector3(Math.cos((i * Math.PI) / 36), Math.sin((i * Math.PI) / 36), 0));
    const line = new THREE.LineBasicMaterial({ color: 0x2b7fb8, transparent: true, opacity: 0.7 });
    this.rings = [0, 1, 2].map((i) => {
      const ring = new THREE.LineLoop(new THREE.BufferGeometry().setFromPoints(circle), line);
      if (i === 1) ring.rotation.x = Math.PI / 2;
      if (i === 2) ring.rotation.y = Math.PI / 2;
      return ring;
    });
    this.group.add(this.body, ...this.rings);
    this.group.matrixAutoUpdate = false;
    this.group.visible = false;
  }

  draw(at: Vec3, stiffness: Posture["stiffness"], mm_per_um_per_n: number): void {
    const lengths = stiffness?.principal_um_per_n;
    const rows = stiffness?.principal_direction;
    this.group.visible = !!lengths && !!rows && lengths.length >= 3;
    if (!this.group.visible) return;
    const axes = rows!.slice(0, 3).map((row, i) => new THREE.Vector3(row[0], row[1], row[2]).normalize().multiplyScalar(Math.max(2, lengths![i]! * mm_per_um_per_n)));
    this.group.matrix.makeBasis(axes[0]!, axes[1]!, axes[2]!).setPosition(...at);
    this.group.matrixWorldNeedsUpdate = true;
  }
}
