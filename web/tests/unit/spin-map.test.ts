// Knots of the spin along a path, and the cells of the map in words.

import { expect, test } from "vitest";
import { BLOCKED, cellAt, cellText, IN_COLLISION, nearest } from "../../src/spin-map/cells";
import { distanceOf, edges, spinOf, spinTicks, ticks, xOf, yOf, type Frame } from "../../src/spin-map/frame";
import { added, between, knotsOf, moved, removed, spinAt, written, type Knot, type Range } from "../../src/spin-map/knots";
import type { SpinMap } from "../../src/types";

const RANGE: Range = { length_mm: 628.3185, low_deg: -180, high_deg: 180 };
const KNOTS: Knot[] = [[0, 10], [300, 40], [628.3, -20]];

test("a constant spin has a knot at both ends, and a curve is in addition to it", () => {
  expect(knotsOf(null, 30, RANGE)).toEqual([[0, 30], [628.3, 30]]);
  expect(knotsOf([[100, -5], [200, 5]], 30, RANGE)).toEqual([[100, 25], [200, 35]]);
  expect(written([[100, 25], [200, 35.1]], 30)).toEqual([[100, -5], [200, 5.1]]);
});

test("the spin is linear between knots and constant outside", () => {
  expect([0, 150, 300, 464.15, 700].map((d) => spinAt(KNOTS, d))).toEqual([10, 25, 40, 10, -20]);
});

test("a knot stays between its neighbours, on the path and inside the range", () => {
  expect(moved(KNOTS, 1, [200, 55.04], RANGE)[1]).toEqual([200, 55]);
  expect(moved(KNOTS, 1, [900, 500], RANGE)[1]![0]).toBeLessThan(628.3);
  expect(moved(KNOTS, 1, [900, 500], RANGE)[1]![1]).toBe(180);
  expect(moved(KNOTS, 0, [-50, 0], RANGE)[0]).toEqual([0, 0]);
  // The study refuses a point beyond the end of the path.
  expect(moved(KNOTS, 2, [629, 0], RANGE)[2]).toEqual([628.3, 0]);
});

test("a knot is added on the curve, removed, and never closer than the resolution", () => {
  expect(between(KNOTS, 0)).toBe(150);
  expect(between(KNOTS, 2)).toBeCloseTo(464.15);
  expect(added(KNOTS, 150, RANGE)).toEqual({ knots: [[0, 10], [150, 25], [300, 40], [628.3, -20]], index: 1 });
  expect(added(KNOTS, 300.5, RANGE)).toBeNull();
  expect(removed(KNOTS, 1)).toEqual([[0, 10], [628.3, -20]]);
  expect(removed([[0, 10], [628.3, -20]], 1)).toHaveLength(2);
});

test("positions and values of the frame are inverse to each other", () => {
  const frame: Frame = { width: 700, height: 236, ...RANGE };
  expect(distanceOf(frame, xOf(frame, 123))).toBeCloseTo(123);
  expect(spinOf(frame, yOf(frame, -77))).toBeCloseTo(-77);
  expect(ticks(0, 628, 6)).toEqual([0, 200, 400, 600]);
  expect(spinTicks(-180, 180)).toEqual([-180, -90, 0, 90, 180]);
  expect(edges([0, 10, 30], 0, 30)).toEqual([0, 5, 20, 30]);
});

test("a cell says why the arm cannot be there", () => {
  const map = {
    distance_mm: [0, 100, 200],
    spins_deg: [-180, 0, 180],
    in_plane_um: [[50, 60, null], [1, 2, 3], [4, 5, 6]],
    limit_margin_deg: [[10, -3, null], [1, 1, 1], [1, 1, 1]],
    limit_joint: [[0, 1, 0], [0, 0, 0], [0, 0, 0]],
    state: [[0, 1, 4], [2, 8, 16], [0, 0, 0]],
    move_joint: [[0, 0, 0], [0, 1, 1], [0, 0, 0]],
    joint_names: ["S", "T"],
  } as unknown as SpinMap;
  expect(nearest([0, 100, 200], 149)).toBe(1);
  expect(cellAt(map, 90, 170)).toEqual({ row: 2, column: 1 });
  // A spin is the same whole turns away.
  expect(cellAt(map, 90, 370).row).toBe(1);
  expect(cellText(map, 0, 0)).toBe("50.0 µm in plane");
  expect(cellText(map, 0, 1)).toBe("60.0 µm in plane, T outside its limits");
  expect(cellText(map, 0, 2)).toBe("out of reach");
  map.state[0]![2] = IN_COLLISION;
  expect(cellText(map, 0, 2)).toBe("in collision");
  expect(BLOCKED & IN_COLLISION).not.toBe(0);
  expect(cellText(map, 1, 0)).toBe("1.0 µm in plane, near a singularity");
  expect(cellText(map, 1, 1)).toBe("2.0 µm in plane, T jumps here");
  expect(cellText(map, 1, 2)).toBe("3.0 µm in plane, T is too slow for the feed");
});
