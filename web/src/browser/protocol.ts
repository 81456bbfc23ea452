// Messages between the page and the workers that run the program.

/** A file of the folder, such as `out/report.html`; null: it is removed. */
export type FileChange = [name: string, bytes: Uint8Array | null];

/** What the workers of one program share where the page may share memory: see `threads`. */
export interface Shared {
  memory: WebAssembly.Memory;
  /** Two numbers for each thread: see `threads`. */
  slots: Int32Array;
}

/** From the page. `thread`: a worker that computes for another one, in this slot. */
export type ToWorker =
  | { kind: "start"; program: WebAssembly.Module; shared: Shared | null }
  | { kind: "thread"; program: WebAssembly.Module; shared: Shared; slot: number }
  | { kind: "ask"; method: string; path: string; body: Uint8Array; changes: FileChange[]; writes: boolean };

/** From the worker: that its threads may start, the reply, with the files that the program has written, a line of its output, or its end. */
export type FromWorker =
  | { kind: "started" }
  | { kind: "reply"; status: number; type: string; bytes: Uint8Array; written: FileChange[] }
  | { kind: "line"; line: string }
  | { kind: "failed"; message: string };
