import { expect, test } from "vitest";
import { surfaceBelow, type Mesh3, type Values3 } from "../../src/scene/surface";

const field = (n: number, f: (x: number, y: number, z: number) => number | null): Values3 => {
  const at = (i: number) => -100 + (200 * i) / (n - 1);
  const values: (number | null)[] = [];
  for (let k = 0; k < n; k++) for (let j = 0; j < n; j++) for (let i = 0; i < n; i++) values.push(f(at(i), at(j), at(k)));
  return { origin_mm: [-100, -100, -100], step_mm: 200 / (n - 1), counts: [n, n, n], values };
};

/** Volume by the divergence theorem: positive where the triangles face outwards. */
const volume = ({ positions: p, index }: Mesh3) => {
  const at = (i: number) => [p[3 * i]!, p[3 * i + 1]!, p[3 * i + 2]!] as const;
  let sum = 0;
  for (let t = 0; t < index.length; t += 3) {
    const [a, b, c] = [at(index[t]!), at(index[t + 1]!), at(index[t + 2]!)];
    sum += a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return sum / 6;
};

/** Every edge is walked once each way. */
const closed = ({ index }: Mesh3) => {
  const edges = new Map<string, number>();
  for (let t = 0; t < index.length; t += 3)
    for (let k = 0; k < 3; k++) {
      const [a, b] = [index[t + k]!, index[t + ((k + 1) % 3)]!];
      const key = `${Math.min(a, b)}-${Math.max(a, b)}`;
      edges.set(key, (edges.get(key) ?? 0) + (a < b ? 1 : -1));
    }
  return [...edges.values()].every((n) => n === 0);
};

test("a ball: closed, facing outwards, of the right volume", () => {
  const mesh = surfaceBelow(field(41, (x, y, z) => Math.hypot(x, y, z)), 60);
  expect(closed(mesh)).toBe(true);
  const exact = (4 / 3) * Math.PI * 60 ** 3;
  expect(volume(mesh) / exact).toBeGreaterThan(0.97);
  expect(volume(mesh) / exact).toBeLessThan(1.01);
});

test("what reaches the wall of the box is closed there", () => {
  const mesh = surfaceBelow(field(21, (x) => x), 0);
  expect(closed(mesh)).toBe(true);
  expect(volume(mesh)).toBeGreaterThan(0.9 * 100 * 200 * 200);
});

test("points without value are outside", () => {
  const mesh = surfaceBelow(field(11, (x) => (x < 0 ? null : 0)), 1);
  for (let i = 0; i < mesh.positions.length; i += 3) expect(mesh.positions[i]!).toBeGreaterThan(-20);
});

test("nothing below the level: nothing to draw", () => {
  expect(surfaceBelow(field(5, () => 2), 1)).toEqual({ positions: [], index: [] });
});
