import { expect, test } from "vitest";
import { KeptJobs } from "../../src/jobs/kept";
import type { Job } from "../../src/types";

const job = (id: string, started_s_ago: number, kind = "run"): Job => ({ id, kind, title: "study", analysis: null, state: "done", done: 1, of: 1, best: null, started_s_ago, seconds: 1, error: null, text: "", answer: null, measures: [], files: [] }) as unknown as Job;

function storage() {
  const kept = new Map<string, string>();
  return { getItem: (key: string) => kept.get(key) ?? null, setItem: (key: string, value: string) => void kept.set(key, value) };
}

test("finished jobs are there after a restart, once, and not of another study", () => {
  const store = storage();
  const now = 1_000_000_000;
  new KeptJobs(store, "cell").keep(job("1", 10), now);
  const after = new KeptJobs(store, "cell");
  // The server knows it still.
  expect(after.except([job("1", 70)], now + 60_000)).toEqual([]);
  // It was restarted: its first job is another one.
  const [earlier] = after.except([job("1", 2)], now + 60_000);
  expect(earlier!.id).toMatch(/^earlier-/);
  expect(earlier!.started_s_ago).toBeCloseTo(70);
  expect(after.except([job("1", 70, "place")], now + 60_000)).toHaveLength(1);
  expect(new KeptJobs(store, "other").except([], now)).toEqual([]);
});

test("few are kept, no long ones, and nothing unreadable", () => {
  const store = storage();
  const jobs = new KeptJobs(store, "cell");
  for (let i = 0; i < 20; i++) jobs.keep(job(String(i), 100 * i), 1e9);
  expect(jobs.except([], 1e9)).toHaveLength(12);
  jobs.keep({ ...job("long", 5000), text: "x".repeat(300_000) } as Job, 1e9);
  expect(jobs.except([], 1e9).some(({ started_s_ago }) => started_s_ago === 5000)).toBe(false);
  for (const bad of ["{", "3", '[{"job":3}]', "null"]) {
    store.setItem("armill-jobs\ncell", bad);
    expect(new KeptJobs(store, "cell").except([], 0)).toEqual([]);
  }
});
