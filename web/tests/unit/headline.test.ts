import { describe, expect, it } from "vitest";
import { headline, lostHoles } from "../../src/headline";
import type { Answer, MapAnswer } from "../../src/types";

const point = {} as never;
const map = (over: object) =>
  ({ fraction_within: 1, fraction_within_and_inside_joint_limits: 1, outside_joint_limits: 0, counts: { within: 100, above_tolerance: 0, in_collision: 0 }, grid: { points: 100 }, certainty: null, worst: point, setting: { tolerance_um: 110 }, ...over }) as unknown as MapAnswer;
const none = { maps: [], paths: [], volumes: [], holes: [] };
const hole = (number: number, over: object = {}) => ({ hole: number, blocked_by: null, branch: "front elbow-up flip", singularity: null, limit_joint: null, state: "within", ...over });
const holes = (each: object[], fraction_within: number, unreachable = 0) =>
  ({ ...none, holes: [{ holes: each.length, unreachable, fraction_within, each, setting: { tolerance_um: 100 } }] }) as unknown as Answer;
const plain = (text: string) => text.replace(/[\u00a0\u202f]/g, " ");

describe("the headline", () => {
  it("reports a plate outside joint limits as outside, however small its deviation", () => {
    const given = headline(none as never, map({ fraction_within_and_inside_joint_limits: 0.17, outside_joint_limits: 83 }));
    expect(given.state).toBe("part");
    expect(plain(given.line)).toBe("17 % of the plate is within 110 µm and inside joint limits");
    expect(given.extra).toContain("83 of 100 points outside joint limits (hatched)");
    expect(headline(none as never, map({ fraction_within_and_inside_joint_limits: 0, outside_joint_limits: 100 })).state).toBe("none");
  });
  it("is good only for the whole plate", () => {
    expect(headline(none as never, map({}))).toMatchObject({ state: "good", reached: true, extra: [] });
    expect(headline(none as never, map({ worst: null, fraction_within_and_inside_joint_limits: 0, counts: { within: 0, above_tolerance: 0, in_collision: 0 } }))).toMatchObject({ reached: false, line: "The robot does not reach the plate", state: "none" });
  });
  it("counts points in collision apart from those without posture", () => {
    const given = headline(none as never, map({ counts: { within: 60, above_tolerance: 0, in_collision: 30 } }));
    expect(given.extra).toEqual(["30 in collision", "10 without posture"]);
    const all = headline(none as never, map({ worst: null, fraction_within_and_inside_joint_limits: 0, counts: { within: 0, above_tolerance: 0, in_collision: 100 } }));
    expect(all).toMatchObject({ reached: true, line: "No point of the plate is reached without collision", state: "none", extra: ["100 in collision"] });
    expect(headline(holes([hole(1), hole(2, { branch: null, state: "in_collision" })], 0.5), null).line).toBe("1 of 2 holes can be drilled; 2: in collision");
  });
  it("names the holes that cannot be drilled, and why", () => {
    const singular = { blocked_by: "singular", singularity: "wrist" };
    const answer = holes([hole(1), hole(18, singular), hole(3, { branch: null, state: "out_of_reach" }), hole(17, singular)], 0.25);
    expect(lostHoles(answer).map(({ hole }) => hole)).toEqual([3, 17, 18]);
    expect(headline(answer, null).line).toBe("1 of 4 holes can be drilled; 3: out of reach; 17 and 18: wrist singular");
    expect(headline(answer, null).state).toBe("part");
    expect(plain(headline(holes([hole(1), hole(2)], 1), null).line)).toBe("All 2 holes are within 100 µm");
    expect(plain(headline(holes([hole(1), hole(2)], 0.5), null).line)).toBe("1 of 2 holes is within 100 µm");
    expect(headline(holes([hole(1, { blocked_by: "outside_joint_limits", limit_joint: "A5" })], 0), null)).toMatchObject({ line: "None of the 1 holes can be drilled", extra: ["1: A5 outside its limits"] });
  });
});
