// The difference to a pinned state: at the same points of the part only.

import { expect, test } from "vitest";
import type { Live } from "../../src/live";
import { diverging } from "../../src/scene/colour";
import { aboutZero, minusPinned, placesOf, whyNot, type PinnedScene } from "../../src/scene/difference";
import { colourOf, LAYERS, type ShownLayer } from "../../src/scene/layers";
import { Points } from "../../src/scene/points";

const map = { answer: { maps: [{ grid: { y_mm: [-50, 50], z_mm: [0] } }] }, scene: null, values: { kind: "map" } };
const pinned = (over: Partial<PinnedScene> = {}): PinnedScene => ({ drawing: null, kind: "map", places: [[-50, 50, 0]], values: new Map([["in_plane_um", [[100, 40]]]]), ...over });
const shown: ShownLayer = { key: "in_plane_um", layer: LAYERS.in_plane_um, scale: [0, 200], names: [], values: () => [59, null], lines: () => [{ level: 1, lines_mm: [] }] };
const why = (of: object, layer = shown) => whyNot({ ...map, ...of } as unknown as Live, layer);

test("there is a difference only at the same points, of sizes", () => {
  expect(why({ pinned: pinned() })).toBeNull();
  expect(why({ pinned: null })).toMatch(/Nothing/);
  expect(why({ pinned: pinned({ kind: "path" }) })).toMatch(/kind of analysis/);
  expect(why({ pinned: pinned({ places: [[-50, 0, 50, 0]] }) })).toMatch(/other points/);
  expect(why({ pinned: pinned({ places: [[-50, 51, 0]] }) })).toMatch(/other places/);
  expect(why({ pinned: pinned({ values: new Map() }) })).toMatch(/computed/);
  expect(why({ pinned: pinned() }, { ...shown, layer: LAYERS.largest_share })).toMatch(/no difference/);
});

test("points that move with the part are the same points", () => {
  const at = (x: number) => ({ answer: { maps: [] }, scene: { box: null, plate: { centre_mm: [x, 0, 0], y_axis: [0, 1, 0], z_axis: [0, 0, 1], normal_axis: [-1, 0, 0] }, points: Points.ofAnswer({ xyz_mm: [[x, 5, 7]], deviation_um: [null], outside_joint_limits: [], columns: { in_plane_um: [1] } } as never) } }) as unknown as Live;
  expect(placesOf(at(900))).toEqual(placesOf(at(1000)));
  expect(placesOf(at(900)).map((list) => [...(list as Float64Array)])).toEqual([[5, 7, 0]]);
});

test("values are minus the pinned ones, on a scale about zero, and unknown ones stay unknown", () => {
  const difference = minusPinned(shown, pinned());
  expect(difference.values(0)).toEqual([-41, null]);
  expect(difference.scale![0]).toBe(-difference.scale!.at(-1)!);
  expect(difference.lines(0)).toEqual([]);
  expect([difference.layer.tolerance, difference.layer.text(-41), difference.layer.text(3)]).toEqual([false, "−41.0", "+3.0"]);
  expect(colourOf(difference, 0)).toEqual(diverging(0.5));
  expect(colourOf(difference, -1e9)).toEqual(diverging(0));
  expect(colourOf(difference, null)).toEqual(colourOf(shown, null));
  expect(aboutZero([-3, 41, null])).toEqual([-60, -40, -20, 0, 20, 40, 60]);
  expect(aboutZero([null])).toBeNull();
  expect(aboutZero([0, 0])).toEqual([-1, -0.5, 0, 0.5, 1]);
});
