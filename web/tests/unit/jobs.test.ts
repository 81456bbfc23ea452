// What the card of a job says.

import { expect, test } from "vitest";
import { kindName, resultLines, resultSentence, roughly, timeLeft } from "../../src/jobs/kinds";
import type { Job } from "../../src/types";

const job = (kind: string, answer: unknown): Job => ({ id: "1", kind, title: "", state: "done", done: 1, of: 1, best: null, started_s_ago: 0, seconds: 0, error: null, answer, files: [] }) as unknown as Job;

test("the time left follows from the progress, once that says enough", () => {
  expect(timeLeft({ state: "running", done: 25, of: 100, seconds: 10 })).toBe(30);
  expect(timeLeft({ state: "running", done: 0, of: 100, seconds: 10 })).toBeNull();
  expect(timeLeft({ state: "running", done: 1, of: 100, seconds: 0.5 })).toBeNull();
  expect(timeLeft({ state: "running", done: 5, of: 0, seconds: 10 })).toBeNull();
  expect(timeLeft({ state: "done", done: 1, of: 2, seconds: 10 })).toBeNull();
  expect([1, 7, 59, 61, 3599, 5400].map(roughly)).toEqual(["5 s", "10 s", "60 s", "2 min", "60 min", "1.5 h"]);
});

test("a run with several analyses says each, not only the first", () => {
  const map = (name: string, um: number) => ({ name, fraction_within: 0.5, worst: { in_plane_um: um } });
  const of = (maps: unknown[], paths: unknown[] = []) => job("run", { answer: "the first", maps, paths, volumes: [], holes: [] });
  const path = { name: "rim", fraction_within: 1, worst: { in_plane_um: 20 }, unreachable: 2, points: 9, search: { applied: true, gain_um: 12 } };
  const both = of([map("a", 100), map("b", 200)], [path]);
  expect(resultSentence(both)).toBeNull();
  expect(resultLines(both).map(({ name }) => name)).toEqual(["a", "b", "rim"]);
  expect(resultLines(both)[1]!.what).toBe("50\u202f% within tolerance, worst 200 µm");
  expect(resultLines(both)[2]!.what).toContain("2 of 9 points unreachable; 12.0 µm less by the search");
  expect(resultSentence(of([map("a", 100)]))).toBe("the first");
});

test("kinds have names of their own; an unknown one is not hidden", () => {
  expect(["run", "place", "posture", "identify", "other"].map(kindName)).toEqual(["Run", "Placement", "Posture", "Compliance identification", "other"]);
});
