// Arrows at the tool: the force of the load case, and where the tool goes under it, magnified.

import * as THREE from "three";
import type { Vec3 } from "../types";

export class Arrow {
  readonly group = new THREE.Group();
  private readonly shaft: THREE.Mesh;
  private readonly head: THREE.Mesh;

  constructor(colour: number) {
    const material = new THREE.MeshBasicMaterial({ color: colour, depthTest: false, transparent: true });
    this.shaft = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 18).translate(0, 0.5, 0), material);
    this.head = new THREE.Mesh(new THREE.ConeGeometry(1, 1, 24).translate(0, 0.5, 0), material);
    // Over everything: an arrow into the plate must not hide behind it.
    this.shaft.renderOrder = this.head.renderOrder = 10;
    this.group.add(this.shaft, this.head);
    this.group.visible = false;
  }

  get colour(): THREE.Color {
    return (this.shaft.material as THREE.MeshBasicMaterial).color;
  }

  /** From `tail` along `vector`, in mm of the scene; `towards`: the head is at `tail`, with the shaft behind it. */
  draw(tail: Vec3, vector: THREE.Vector3, thick: number, towards = false): void {
    const length = vector.length();
    this.group.visible = length > 1;
    if (!this.group.visible) return;
    const head = Math.min(length * 0.45, thick * 4.2);
    this.shaft.scale.set(thick * 0.5, length - head * 0.9, thick * 0.5);
    this.head.scale.set(thick * 1.35, head, thick * 1.35);
    this.head.position.set(0, length - head, 0);
    const way = vector.clone().divideScalar(length);
    this.group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way);
    this.group.position.set(...tail).addScaledVector(way, towards ? -length : 0);
  }

  get end(): THREE.Vector3 {
    return new THREE.Vector3(0, this.head.position.y + this.head.scale.y, 0).applyQuaternion(this.group.quaternion).add(this.group.position);
  }
  get start(): THREE.Vector3 {
    return this.group.position.clone();
  }
}
