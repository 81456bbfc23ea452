import { expect, test } from "vitest";
import { KeptJobs } from "../../src/jobs/kept";
import type { Job } from "../../src/types";

const job = (requested_at_ms: number, kind = "run", title = "study"): Job => ({ id: "1", kind, title, analysis: null, state: "done", done: 1, of: 1, best: null, requested_at_ms, started_s_ago: 1, seconds: 1, error: null, text: "", answer: null, measures: [], files: [] }) as unknown as Job;

function storage() {
  const kept = new Map<string, string>();
  return { getItem: (key: string) => kept.get(key) ?? null, setItem: (key: string, value: string) => void kept.set(key, value) };
}

test("finished jobs are there after a restart, once, and not of another study", () => {
  const store = storage();
  new KeptJobs(store, "cell").keep(job(5000));
  const after = new KeptJobs(store, "cell");
  // The server knows it still.
  expect(after.except([job(5000)], 70_000)).toEqual([]);
  // It was restarted: its first job is another one.
  const [earlier] = after.except([job(6000)], 70_000);
  expect(earlier!.id).toBe("earlier-5000");
  expect(earlier!.started_s_ago).toBeCloseTo(65);
  expect(after.except([job(5000, "place")], 70_000)).toHaveLength(1);
  expect(new KeptJobs(store, "other").except([], 70_000)).toEqual([]);
});

test("few are kept, no long ones, and nothing unreadable", () => {
  const store = storage();
  const jobs = new KeptJobs(store, "cell");
  for (let i = 0; i < 20; i++) jobs.keep(job(i));
  expect(jobs.except([], 0)).toHaveLength(12);
  jobs.keep(job(99, "run", "x".repeat(300_000)));
  expect(jobs.except([], 0).some(({ requested_at_ms }) => requested_at_ms === 99)).toBe(false);
  for (const bad of ["{", "3", '[{"job":3}]', "null", "[null]"]) {
    store.setItem("armill-jobs\ncell", bad);
    expect(new KeptJobs(store, "cell").except([], 0)).toEqual([]);
  }
});
