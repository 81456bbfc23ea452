import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { Newest } from "../../src/newest";

beforeEach(() => vi.useFakeTimers());
afterEach(() => vi.useRealTimers());

/** Work that takes so long as its input says, in ms, and gives it back; aborted work fails as fetch does. */
function watched(patience_ms?: number) {
  const shown: [number, boolean][] = [];
  const failed: unknown[] = [];
  const busy: boolean[] = [];
  const started: number[] = [];
  const newest = new Newest<number, number>(
    {
      work: (ms, signal) => {
        started.push(ms);
        return new Promise((done, fail) => {
          const timer = setTimeout(() => (ms < 0 ? fail(new Error("refused")) : done(ms)), Math.abs(ms));
          signal.addEventListener("abort", () => {
            clearTimeout(timer);
            fail(new DOMException("", "AbortError"));
          });
        });
      },
      done: (value, _input, settled) => shown.push([value, settled]),
      failed: (error) => failed.push(error),
      busy: (b) => busy.push(b),
    },
    patience_ms,
  );
  return { newest, shown, failed, busy, started };
}

test("one input is answered", async () => {
  const { newest, shown, busy } = watched();
  newest.submit(20);
  expect(newest.idle).toBe(false);
  await vi.runAllTimersAsync();
  expect(shown).toEqual([[20, true]]);
  expect(busy).toEqual([true, false]);
  expect(newest.idle).toBe(true);
});

test("of a hundred inputs while one runs, only the newest runs next", async () => {
  const { newest, shown, started } = watched();
  newest.submit(50);
  for (let i = 1; i <= 100; i++) newest.submit(10 + i / 1000);
  await vi.runAllTimersAsync();
  expect(started).toEqual([50, 10.1]);
  expect(shown).toEqual([[50, false], [10.1, true]]);
});

test("work that outlasts the patience is aborted for the newest, and never shown", async () => {
  const { newest, shown, failed } = watched(300);
  newest.submit(5000);
  newest.submit(10);
  await vi.advanceTimersByTimeAsync(299);
  expect(shown).toEqual([]);
  await vi.advanceTimersByTimeAsync(20);
  expect(shown).toEqual([[10, true]]);
  await vi.runAllTimersAsync();
  expect(shown).toEqual([[10, true]]);
  expect(failed).toEqual([]);
});

test("slow work that nothing newer waits for may end", async () => {
  const { newest, shown } = watched(300);
  newest.submit(5000);
  await vi.runAllTimersAsync();
  expect(shown).toEqual([[5000, true]]);
});

test("errors are reported, unless a newer request waits", async () => {
  const { newest, shown, failed } = watched();
  newest.submit(-10);
  await vi.runAllTimersAsync();
  expect(failed).toHaveLength(1);
  newest.submit(-10);
  newest.submit(5);
  await vi.runAllTimersAsync();
  expect(failed).toHaveLength(1);
  expect(shown).toEqual([[5, true]]);
});

test("cancel drops what runs and what waits", async () => {
  const { newest, shown, failed } = watched();
  newest.submit(10);
  newest.submit(20);
  newest.cancel();
  await vi.runAllTimersAsync();
  expect(shown).toEqual([]);
  expect(failed).toEqual([]);
  expect(newest.idle).toBe(true);
});
