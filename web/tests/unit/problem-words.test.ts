// Problems in the words of the page.

import { expect, test } from "vitest";
import { fieldWords, problemSentence, problemWords } from "../../src/problem-words";

test("the field as it is labelled, the limit, the value and the unit", () => {
  expect(problemSentence("`analysis[0].tolerance_um` is -50 um: must be at least 0 um")).toBe("Analysis 1, tolerance: must be at least 0 µm (got −50 µm)");
  expect(problemSentence("`plane.step_mm` is 0 mm: must be above 0 mm")).toBe("Grid step: must be above 0 mm (got 0 mm)");
  expect(problemSentence("`plane.tilt_deg` is -181 deg: must be at least -180 deg")).toBe("Tilt: must be at least −180° (got −181°)");
  expect(problemSentence("`analysis[0].kind` is the number 7: must be one of \"map\", \"path\"")).toBe('Analysis 1, kind: must be one of "map", "path" (got 7)');
  expect(problemSentence("`threads` is 256: must be at most 255")).toBe("Threads: must be at most 255 (got 256)");
});

test("coordinates are the fields of the live view", () => {
  expect(fieldWords("plane.centre_mm[2]")).toBe("height z");
  expect(fieldWords("load.cases_n[1][0]")).toBe("load, load cases 2 1");
  expect(fieldWords("posture.search.margin_deg")).toBe("posture, search, margin");
  expect(fieldWords("analysis[1].circle.radius_mm")).toBe("analysis 2, circle, radius");
});

test("other messages stay as they are", () => {
  expect(problemWords("the study has no analysis")).toEqual({ field: null, what: "the study has no analysis" });
  expect(problemSentence("`plane` needs `step_mm`")).toBe("Plane: needs “step_mm”");
  expect(problemSentence("a-1 is 3")).toBe("A-1 is 3");
});
