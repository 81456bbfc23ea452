import { expect, test } from "vitest";
import { contour, type Grid } from "../../src/scene/contour";

const grid = (n: number, f: (y: number, z: number) => number | null, turned = false): Grid => {
  const z_mm = Array.from({ length: n }, (_, i) => -100 + (200 * i) / (n - 1));
  const y_mm = turned ? [...z_mm].reverse() : [...z_mm];
  return { y_mm, z_mm, values: z_mm.flatMap((z) => y_mm.map((y) => f(y, z))) };
};

test("a plane has one straight line, exactly where it says", () => {
  for (const turned of [false, true]) {
    const [line, ...rest] = contour(grid(21, (y) => y, turned), 33);
    expect(rest).toEqual([]);
    expect(line).toHaveLength(21);
    for (const [y] of line!) expect(y).toBeCloseTo(33, 9);
  }
});

test("a bowl has one closed line at its radius", () => {
  const lines = contour(grid(81, (y, z) => Math.hypot(y, z)), 60);
  expect(lines).toHaveLength(1);
  expect(lines[0]!.at(-1)).toEqual(lines[0]![0]);
  // Linear between samples 2.5 mm apart: off by at most step^2 / (8 r).
  for (const [y, z] of lines[0]!) expect(Math.abs(Math.hypot(y, z) - 60)).toBeLessThan((2.5 * 2.5) / 8 / 60 + 0.01);
});

test("a saddle's lines do not cross", () => {
  const lines = contour(grid(22, (y, z) => y * z), 1);
  expect(lines).toHaveLength(2);
  for (const line of lines) for (const [y, z] of line) expect(y * z).toBeGreaterThan(0);
});

test("cells with a point without value have no line", () => {
  const lines = contour(grid(21, (y, z) => (z > 0 ? null : y)), 33);
  expect(lines).toHaveLength(1);
  for (const [, z] of lines[0]!) expect(z).toBeLessThanOrEqual(0);
});

test("a level outside the values has none, nor has an empty grid", () => {
  expect(contour(grid(5, () => 1), 2)).toEqual([]);
  expect(contour({ y_mm: [], z_mm: [], values: [] }, 0)).toEqual([]);
  expect(contour({ y_mm: [0], z_mm: [0], values: [1] }, 1)).toEqual([]);
});
