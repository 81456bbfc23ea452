// Messages between the page and the worker that runs the program.

/** A file of the folder, such as `out/report.html`; null: it is removed. */
export type FileChange = [name: string, bytes: Uint8Array | null];

/** From the page. */
export type ToWorker =
  | { kind: "start"; program: WebAssembly.Module }
  | { kind: "ask"; method: string; path: string; body: Uint8Array; changes: FileChange[]; writes: boolean };

/** From the worker: the reply, with the files that the program has written, a line of its output, or its end. */
export type FromWorker =
  | { kind: "reply"; status: number; type: string; bytes: Uint8Array; written: FileChange[] }
  | { kind: "line"; line: string }
  | { kind: "failed"; message: string };
