// The arm of the pinned state: translucent, in one colour, next to the arm of the present one.

import * as THREE from "three";
import type { ArmDrawing } from "../types";
import { Arm } from "./arm";

const TINT = 0x4a7fd0;
// Behind parts of the present arm that are at the same place.
const paint = new THREE.MeshStandardMaterial({ color: TINT, roughness: 0.6, transparent: true, opacity: 0.3, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 });

export class GhostArm {
  readonly group = new THREE.Group();
  private readonly arm = new Arm({ body: paint, housing: paint, steel: paint, tip: paint });

  constructor() {
    this.group.add(this.arm.group);
    this.group.visible = false;
  }

  /** The tip of the arm drawn; null if none is. */
  draw(drawing: ArmDrawing | null, present: ArmDrawing | null): THREE.Vector3 | null {
    // In the same posture one would hide the other.
    this.group.visible = drawing !== null && !isSame(drawing, present);
    if (!drawing || !this.group.visible) return null;
    const quiet = new THREE.Color(TINT);
    this.arm.draw(drawing, [], quiet, quiet);
    this.arm.rings.forEach((ring) => {
      ring.transparent = true;
      ring.opacity = 0.3;
      ring.depthWrite = false;
    });
    return new THREE.Vector3(...drawing.tool_mm);
  }
}

/** Links that are apart by less, mm, are drawn in one place. */
const APART_MM = 0.5;

function isSame(a: ArmDrawing, b: ArmDrawing | null): boolean {
  if (!b || a.links_mm.length !== b.links_mm.length) return false;
  const far = (p: number[], q: number[]) => Math.hypot(...p.map((v, k) => v - q[k]!)) > APART_MM;
  return !a.links_mm.some((p, i) => far(p, b.links_mm[i]!)) && !far(a.tool_mm, b.tool_mm);
}
