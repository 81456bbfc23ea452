import { expect, test } from "vitest";
import { COLLISION, colourOf, LAYERS } from "../../src/scene/layers";
import { Points } from "../../src/scene/points";
import type { ScenePoints } from "../../src/types";

const points = (...state: string[]): Points =>
  Points.ofAnswer({ xyz_mm: state.map((_, i) => [i, 0, 0]), deviation_um: state.map(() => null), outside_joint_limits: [], columns: { state, in_plane_um: state.map((word) => (word === "reached" ? 1 : null)) } } as unknown as ScenePoints);

test("points in collision are distinguished from those without another posture", () => {
  const all = points("reached", "in_collision", "out_of_reach");
  expect([...Array(3).keys()].map((i) => all.in_collision[i])).toEqual([0, 1, 0]);
  expect([all.any_in_collision, all.any_empty]).toEqual([true, true]);
  const only = points("reached", "in_collision");
  expect([only.any_in_collision, only.any_empty]).toEqual([true, false]);
  const none = points("reached", "out_of_reach");
  expect([none.any_in_collision, none.any_empty]).toEqual([false, true]);
});

test("a point in collision has its own colour, but not where a value is known", () => {
  const layer = { layer: LAYERS.in_plane_um, scale: [0, 1], names: [] };
  expect(colourOf(layer, null, true)).toEqual(COLLISION);
  expect(colourOf(layer, null)).not.toEqual(COLLISION);
  expect(colourOf(layer, 0.5, true)).toEqual(colourOf(layer, 0.5));
});
