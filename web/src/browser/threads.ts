// Threads of the program: workers that share its memory, and wait in their slots until the program starts a thread in them.
//
// Browsers let workers share memory only where the page is isolated from others (headers Cross-Origin-Opener-Policy and
// Cross-Origin-Embedder-Policy); elsewhere the program computes with one thread.

import type { Shared } from "./protocol";

/** Sizes of the memory in pages of 64 KiB, as the program is linked. */
const FIRST_PAGES = 1024;
const MOST_PAGES = 65536;
/** More threads gain little, and each takes memory. */
const MOST_THREADS = 16;

/** States of a slot: no thread, one that is being started, one that runs. */
const FREE = 0;
const STARTING = 1;
const RUNS = 2;

export const newMemory = (): WebAssembly.Memory => new WebAssembly.Memory({ initial: FIRST_PAGES, maximum: MOST_PAGES, shared: true });

/** What the workers share; null where the page may not, or there is one processor. */
export function newShared(): Shared | null {
  const count = Math.min(navigator.hardwareConcurrency || 1, MOST_THREADS);
  if (!globalThis.crossOriginIsolated || count < 2) return null;
  return { memory: newMemory(), slots: new Int32Array(new SharedArrayBuffer(8 * count)) };
}

export const threadCount = (shared: Shared | null): number => (shared ? shared.slots.length / 2 : 1);

/** Starts a thread of the program in a free slot: its number, or -1 where none is free. */
export function startThread({ slots }: Shared, argument: number): number {
  for (let slot = 0; 2 * slot < slots.length; slot++) {
    if (Atomics.compareExchange(slots, 2 * slot, FREE, STARTING) !== FREE) continue;
    Atomics.store(slots, 2 * slot + 1, argument);
    Atomics.store(slots, 2 * slot, RUNS);
    Atomics.notify(slots, 2 * slot);
    return slot + 1;
  }
  return -1;
}

/** Waits in a slot, and runs the threads that are started there. */
export function runThreads({ slots }: Shared, slot: number, run: (thread: number, argument: number) => void): never {
  for (;;) {
    let state = Atomics.load(slots, 2 * slot);
    while (state !== RUNS) {
      Atomics.wait(slots, 2 * slot, state);
      state = Atomics.load(slots, 2 * slot);
    }
    run(slot + 1, Atomics.load(slots, 2 * slot + 1));
    Atomics.store(slots, 2 * slot, FREE);
  }
}
