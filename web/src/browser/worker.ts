// The worker that runs the program: WebAssembly with the files of the study. One request at a time.

import { ConsoleStdout, OpenFile, File, WASI } from "@bjorn3/browser_wasi_shim";
import type { FromWorker, ToWorker } from "./protocol";
import { ProgramFolder } from "./wasi-files";

/** Where the program expects the study. */
const FOLDER = "/study";
/** Lines of its messages that are kept for the case that it fails. */
const MOST_LINES = 5;

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  armill_input(bytes: number): number;
  armill_answer(method_bytes: number, path_bytes: number): number;
  armill_output(): number;
  armill_output_bytes(): number;
}

const scope = globalThis as unknown as { postMessage(message: FromWorker, transfer?: Transferable[]): void; onmessage: ((event: MessageEvent<ToWorker>) => void) | null };
const folder = new ProgramFolder(FOLDER);
const messages: string[] = [];
let exports: Exports | null = null;

function start(program: WebAssembly.Module): void {
  const input = new OpenFile(new File([]));
  const output = ConsoleStdout.lineBuffered((line) => scope.postMessage({ kind: "line", line }));
  const errors = ConsoleStdout.lineBuffered((line) => {
    messages.push(line);
    if (messages.length > MOST_LINES) messages.shift();
  });
  const wasi = new WASI([], [], [input, output, errors, folder.preopened], { debug: false });
  const instance = new WebAssembly.Instance(program, { wasi_snapshot_preview1: wasi.wasiImport });
  exports = instance.exports as unknown as Exports;
  wasi.initialize(instance as { exports: { memory: WebAssembly.Memory; _initialize?: () => unknown } });
}

function answer(program: Exports, ask: Extract<ToWorker, { kind: "ask" }>): void {
  folder.take(ask.changes);
  const method = new TextEncoder().encode(ask.method);
  const path = new TextEncoder().encode(ask.path);
  const at = program.armill_input(method.length + path.length + ask.body.length);
  const input = new Uint8Array(program.memory.buffer, at, method.length + path.length + ask.body.length);
  input.set(method);
  input.set(path, method.length);
  input.set(ask.body, method.length + path.length);
  const status = program.armill_answer(method.length, path.length);
  // The memory may have grown: another buffer.
  const output = new Uint8Array(program.memory.buffer, program.armill_output(), program.armill_output_bytes());
  const end = output.indexOf(10);
  const type = new TextDecoder().decode(output.subarray(0, end));
  const bytes = output.slice(end + 1);
  const written = ask.writes ? folder.changes() : [];
  scope.postMessage({ kind: "reply", status, type, bytes, written }, [bytes.buffer]);
}

scope.onmessage = ({ data }) => {
  try {
    if (data.kind === "start") start(data.program);
    else answer(exports!, data);
  } catch (error) {
    const what = error instanceof Error ? error.message : String(error);
    scope.postMessage({ kind: "failed", message: [...messages, what].join("\n") });
  }
};
