// The order of the jobs that the page shows.

import { expect, test } from "vitest";
import { JobStore } from "../../src/jobs/store";
import type { Job } from "../../src/types";

const job = (id: string, requested_at_ms: number, started_s_ago: number): Job => ({ id, kind: "compensate", requested_at_ms, started_s_ago }) as unknown as Job;

test("the newest job is the first, also if nothing was heard of an older one since it ended", () => {
  const store = new JobStore((error) => expect.fail(String(error)));
  // The first ended after 12 s; the second runs for 30 s, and its news say so.
  for (const one of [job("9", 1_000, 12), job("10", 15_000, 30), job("11", 15_000, 30)]) store.jobs.set(one.id, one);
  expect(store.sorted.map(({ id }) => id)).toEqual(["11", "10", "9"]);
});
