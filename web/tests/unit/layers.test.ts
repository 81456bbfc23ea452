import { describe, expect, it } from "vitest";
import type { Live } from "../../src/live";
import { viridis } from "../../src/scene/colour";
import { colourOf, LAYERS, shownLayer, textOf } from "../../src/scene/layers";

const live = (over: object) => ({ layer: "in_plane_um", layer_answer: null, levels_um: [0, 50, 100], answer: { maps: [{ grid: { in_plane_um: [0, 100, null] } }] }, scene: null, lines: [], ...over }) as unknown as Live;

describe("layers", () => {
  it("show the in-plane deviation of the answer until the values of another one have come", () => {
    const first = shownLayer(live({ layer: "full_um" }));
    expect([first.key, first.values(0)]).toEqual(["in_plane_um", [0, 100, null]]);
    const layer_answer = { key: "full_um", levels: [0, 200], values: [[1, 2, 3]], names: [], lines: [[{ level: 2, lines_mm: [] }]] };
    const then = shownLayer(live({ layer: "full_um", layer_answer }));
    expect([then.key, then.values(0), then.lines(0).length]).toEqual(["full_um", [1, 2, 3], 1]);
    expect(shownLayer(live({ layer: "in_plane_um", layer_answer })).key).toBe("in_plane_um");
  });
  it("colour sizes along their scale, names apart, and unknown values grey", () => {
    const sizes = shownLayer(live({}));
    expect(colourOf(sizes, 100)).toEqual(viridis(1));
    const named = { layer: LAYERS.largest_share, scale: null, names: ["S", "L"] };
    expect(colourOf(named, 0)).not.toEqual(colourOf(named, 1));
    expect(colourOf(named, 7)).toEqual(colourOf(sizes, null));
    expect(textOf(named, 1)).toBe("L");
  });
  it("write values with their unit", () => {
    expect(textOf({ layer: LAYERS.limit_margin_deg, names: [] }, -3.14)).toBe("−3.1°");
    expect(textOf({ layer: LAYERS.full_um, names: [] }, 12.345)).toBe("12.3 µm");
    expect(textOf({ layer: LAYERS.probability_within, names: [] }, 0.5)).toBe("50\u202f%");
    expect(textOf({ layer: LAYERS.in_plane_u_um, names: [] }, null)).toBe("not known");
  });
});
