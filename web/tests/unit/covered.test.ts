import * as THREE from "three";
import { expect, test } from "vitest";
import { apart, isCovered } from "../../src/scene/covered";

const v = (x: number, y: number, z: number) => new THREE.Vector3(x, y, z);

test("segments: crossing, parallel, end to end, points", () => {
  expect(apart(v(0, 0, 0), v(10, 0, 0), v(5, -3, 2), v(0, 6, 0))).toBeCloseTo(2);
  expect(apart(v(0, 0, 0), v(10, 0, 0), v(2, 4, 0), v(5, 0, 0))).toBeCloseTo(4);
  expect(apart(v(0, 0, 0), v(1, 0, 0), v(4, 4, 0), v(1, 0, 0))).toBeCloseTo(5);
  expect(apart(v(0, 0, 0), v(0, 0, 0), v(3, 4, 0), v(0, 0, 0))).toBeCloseTo(5);
  expect(apart(v(0, 5, 0), v(0, 0, 0), v(-3, 0, 0), v(9, 0, 0))).toBeCloseTo(5);
});

test("the least distance of segments is that of the nearest of many of their points", () => {
  let seed = 1;
  const random = () => ((seed = (seed * 16807) % 2147483647) / 2147483647) * 4 - 2;
  for (let round = 0; round < 60; round++) {
    const [p, u, q, w] = [0, 1, 2, 3].map(() => v(random(), random(), random())) as [THREE.Vector3, THREE.Vector3, THREE.Vector3, THREE.Vector3];
    let least = Infinity;
    for (let i = 0; i <= 100; i++) for (let j = 0; j <= 100; j++) least = Math.min(least, p.clone().addScaledVector(u, i / 100).distanceTo(q.clone().addScaledVector(w, j / 100)));
    const found = apart(p, u, q, w);
    expect(found).toBeLessThanOrEqual(least + 1e-9);
    expect(found).toBeGreaterThan(least - 0.06);
  }
});

test("points behind a limb are covered, points in front of it or on it are not", () => {
  const limbs = [{ from: v(0, -100, 0), to: v(0, 100, 0), radius: 10 }];
  const eye = v(1000, 0, 0);
  expect(isCovered(limbs, eye, v(-500, 0, 0))).toBe(true);
  expect(isCovered(limbs, eye, v(-500, 0, 60))).toBe(false);
  expect(isCovered(limbs, eye, v(200, 0, 0))).toBe(false);
  expect(isCovered(limbs, eye, v(10, 50, 0))).toBe(false);
  expect(isCovered([], eye, v(-500, 0, 0))).toBe(false);
});
