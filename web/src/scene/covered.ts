// Visibility of points: the arm as round limbs, and whether one of them crosses the line of sight.

import * as THREE from "three";

export interface Limb {
  from: THREE.Vector3;
  to: THREE.Vector3;
  radius: number;
}

/** Whether a limb, with this extra radius, is between the eye and the point; a limb that touches the point is not. */
export function isCovered(limbs: Limb[], eye: THREE.Vector3, at: THREE.Vector3, stouter = 1): boolean {
  const sight = at.clone().sub(eye);
  const distance = sight.length();
  if (distance === 0) return false;
  return limbs.some(({ from, to, radius: thin }) => {
    const radius = thin * stouter;
    // Up to the point where it is outside the radius of the limb.
    const reach = Math.max(0, 1 - (1.2 * radius) / distance);
    return apart(eye, sight.clone().multiplyScalar(reach), from, to.clone().sub(from)) < radius;
  });
}

/** Least distance of two segments, each from a point along a vector (Ericson, Real-Time Collision Detection, 5.1.9). */
export function apart(p: THREE.Vector3, u: THREE.Vector3, q: THREE.Vector3, v: THREE.Vector3): number {
  const r = p.clone().sub(q);
  const [a, e, f] = [u.dot(u), v.dot(v), v.dot(r)];
  const clamp = (x: number) => Math.min(1, Math.max(0, x));
  let [s, t] = [0, 0];
  if (a > 0 && e > 0) {
    const [b, c] = [u.dot(v), u.dot(r)];
    const across = a * e - b * b;
    s = across > 1e-12 * a * e ? clamp((b * f - c * e) / across) : 0;
    t = (b * s + f) / e;
    if (t < 0) s = clamp(-c / a);
    else if (t > 1) s = clamp((b - c) / a);
    t = clamp(t);
  } else if (a > 0) s = clamp(-u.dot(r) / a);
  else if (e > 0) t = clamp(f / e);
  return p.clone().addScaledVector(u, s).distanceTo(q.clone().addScaledVector(v, t));
}
