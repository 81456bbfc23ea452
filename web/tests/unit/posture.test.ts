import { expect, test } from "vitest";
import { choosePosture, worstCase, envelope, fits, tooNear } from "../../src/posture";
import type { CaseValues, Pose } from "../../src/types";

const values = (...in_plane: number[]): CaseValues[] =>
  in_plane.map((in_plane_um) => ({
    in_plane_um,
    in_plane_u_um: 0,
    normal_um: 0,
    full_um: in_plane_um,
    deviation_um: [in_plane_um, 0, 0],
    force_n: [0, 0, 1],
    share_um: [],
    permissible_along_load_n: null,
    permissible_any_direction_n: null,
  }));
const pose = (...rows: [string, boolean, number][]): Pose =>
  ({
    answer: { postures: rows.map(([branch, within_limits]) => ({ branch, within_limits })) },
    in_plane: rows.map(([, , um]) => values(um)),
    answered: null,
  }) as unknown as Pose;

test("the largest case decides, counted from 1", () => {
  expect(worstCase(values(3, 9, 9, 1))).toBe(2);
  expect(envelope([])).toBeNull();
  expect(worstCase([])).toBeNull();
});

test("a branch fits where all its words are there", () => {
  expect(fits("front elbow-up flip", "front elbow-up")).toBe(true);
  expect(fits("front elbow-up no-flip", "front flip")).toBe(false);
  expect(fits(null, "front")).toBe(false);
});

test("chosen by name, else specified by the study, else the best; inside limits before outside", () => {
  const here = pose(["front elbow-up flip", true, 159], ["front elbow-down flip", false, 63], ["back elbow-up flip", true, 120]);
  expect(choosePosture(here, "front elbow-down flip", "front elbow-up")).toBe(1);
  expect(choosePosture(here, null, "front elbow-up")).toBe(0);
  expect(choosePosture(here, "gone", "back")).toBe(2);
  expect(choosePosture(here, null, "best")).toBe(2);
  expect(choosePosture(pose(), null, "best")).toBe(0);
  // The posture of the answer comes before what the study specifies, and after the choice of the user.
  const answered = { ...here, answered: 2 };
  expect(choosePosture(answered, null, "front elbow-up")).toBe(2);
  expect(choosePosture(answered, "front elbow-up flip", null)).toBe(0);
});

test("a posture that keeps the clearance before one that does not, and why it does not", () => {
  const cell = (...keeps: boolean[]): Pose => {
    const made = pose(...keeps.map((_, i): [string, boolean, number] => ["front", true, 1 + i]));
    made.drawings = keeps.map((keeps_clearance) => ({ cell: { bodies: [], nearest_mm: null, keeps_clearance } })) as unknown as Pose["drawings"];
    for (const posture of made.answer.postures) Object.assign(posture, { nearest: ["spindle", "fence"], clearance_mm: 4 });
    return made;
  };
  expect(choosePosture(cell(true, true), null, "best")).toBe(0);
  expect(choosePosture(cell(false, true), null, "best")).toBe(1);
  expect(tooNear(cell(true), 0)).toBeNull();
  expect(tooNear(cell(false), 0)).toBe("too near: spindle and fence");
  const touching = cell(false);
  touching.answer.postures[0]!.clearance_mm = 0;
  expect(tooNear(touching, 0)).toBe("in contact: spindle and fence");
});
