// The geometry of a body in its own frame, mm: a box, a cylinder, a capsule; of a mesh the box around it, until its triangles are there.

import * as THREE from "three";
import type { BodyShape, Vec3 } from "../types";

const ALONG = new THREE.Vector3(0, 1, 0);
/** Sides of a round body. */
const ROUND = 48;

export function geometryOf(shape: BodyShape): THREE.BufferGeometry {
  const [from, to] = [new THREE.Vector3(...(shape.from_mm as Vec3)), new THREE.Vector3(...(shape.to_mm as Vec3))];
  const middle = from.clone().add(to).multiplyScalar(0.5);
  const across = to.clone().sub(from);
  if (shape.kind === "box" || shape.kind === "mesh") return new THREE.BoxGeometry(across.x, across.y, across.z).translate(middle.x, middle.y, middle.z);
  const length = across.length();
  const made = shape.kind === "cylinder" ? new THREE.CylinderGeometry(shape.radius_mm, shape.radius_mm, length, ROUND) : new THREE.CapsuleGeometry(shape.radius_mm, length, 12, ROUND);
  const turn = length > 0 ? new THREE.Quaternion().setFromUnitVectors(ALONG, across.divideScalar(length)) : new THREE.Quaternion();
  return made.applyQuaternion(turn).translate(middle.x, middle.y, middle.z);
}
