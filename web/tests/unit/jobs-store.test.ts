// The order of the jobs that the page shows, and the answers that it requests.

import { afterEach, expect, test, vi } from "vitest";
import { JobStore } from "../../src/jobs/store";
import { api } from "../../src/server";
import type { Job } from "../../src/types";

const job = (id: string, requested_at_ms: number, started_s_ago: number): Job => ({ id, kind: "compensate", requested_at_ms, started_s_ago }) as unknown as Job;

test("the newest job is the first, also if nothing was heard of an older one since it ended", () => {
  const store = new JobStore((error) => expect.fail(String(error)));
  // The first ended after 12 s; the second runs for 30 s, and its news say so.
  for (const one of [job("9", 1_000, 12), job("10", 15_000, 30), job("11", 15_000, 30)]) store.jobs.set(one.id, one);
  expect(store.sorted.map(({ id }) => id)).toEqual(["11", "10", "9"]);
});

afterEach(() => vi.restoreAllMocks());

test("an answer that did not come is requested again with the next list, and not once it is there", async () => {
  const done = { ...job("9", 1_000, 12), state: "done" } as Job;
  vi.spyOn(api, "jobs").mockImplementation(async () => ({ jobs: [done] }) as Awaited<ReturnType<typeof api.jobs>>);
  const answer = vi.spyOn(api, "job").mockRejectedValueOnce(new Error("connection lost"));
  answer.mockResolvedValue({ ...done, answer: {} } as Job);
  const failed: string[] = [];
  const store = new JobStore((error) => failed.push(String(error)));
  await store.refresh();
  await vi.waitFor(() => expect(failed).toEqual(["Error: connection lost"]));
  await store.refresh();
  await vi.waitFor(() => expect(store.jobs.get("9")?.answer).toBeDefined());
  await store.refresh();
  expect(answer).toHaveBeenCalledTimes(2);
  expect(failed).toHaveLength(1);
});
