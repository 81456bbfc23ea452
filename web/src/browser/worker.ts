// The worker that runs the program: WebAssembly with the files of the study, one request at a time; or one of its threads.

import { ConsoleStdout, File, OpenFile, WASI, type Fd } from "@bjorn3/browser_wasi_shim";
import type { FromWorker, Shared, ToWorker } from "./protocol";
import { newMemory, runThreads, startThread, threadCount } from "./threads";
import { ProgramFolder } from "./wasi-files";

/** Where the program expects the study. */
const FOLDER = "/study";
/** Lines of its messages that are kept for the case that it fails. */
const MOST_LINES = 5;

interface Exports {
  _initialize(): void;
  wasi_thread_start(thread: number, argument: number): void;
  armill_threads(count: number): number;
  armill_input(bytes: number): number;
  armill_answer(method_bytes: number, path_bytes: number): number;
  armill_output(): number;
  armill_output_bytes(): number;
}

const scope = globalThis as unknown as { postMessage(message: FromWorker, transfer?: Transferable[]): void; onmessage: ((event: MessageEvent<ToWorker>) => void) | null };
const folder = new ProgramFolder(FOLDER);
const messages: string[] = [];
let program: Exports | null = null;
let memory: WebAssembly.Memory | null = null;

/** The functions of browsers that the shim calls take no shared memory: they get copies. */
function takeSharedMemory(): void {
  const decode = TextDecoder.prototype.decode;
  const isShared = (input: unknown): input is Uint8Array => ArrayBuffer.isView(input) && !(input.buffer instanceof ArrayBuffer);
  TextDecoder.prototype.decode = function (input, options) {
    return decode.call(this, isShared(input) ? input.slice() : input, options);
  };
  const random = crypto.getRandomValues.bind(crypto);
  crypto.getRandomValues = <T extends ArrayBufferView | null>(values: T): T => {
    if (!isShared(values)) return random(values as ArrayBufferView<ArrayBuffer> & T);
    values.set(random(new Uint8Array(values.length)));
    return values;
  };
}

/** An instance of the program with these files open, in this memory. */
function instance(module: WebAssembly.Module, files: Fd[], shared: Shared | null): { wasi: WASI; made: WebAssembly.Instance } {
  takeSharedMemory();
  memory = shared?.memory ?? newMemory();
  const wasi = new WASI([], [], files, { debug: false });
  const spawn = (argument: number): number => (shared ? startThread(shared, argument) : -1);
  const made = new WebAssembly.Instance(module, { wasi_snapshot_preview1: wasi.wasiImport, wasi: { "thread-spawn": spawn }, env: { memory } });
  return { wasi, made };
}

const lines = (take: (line: string) => void): ConsoleStdout => ConsoleStdout.lineBuffered(take);
const keep = lines((line) => {
  messages.push(line);
  if (messages.length > MOST_LINES) messages.shift();
});

function start(module: WebAssembly.Module, shared: Shared | null): void {
  const output = lines((line) => scope.postMessage({ kind: "line", line }));
  const { wasi, made } = instance(module, [new OpenFile(new File([])), output, keep, folder.preopened], shared);
  program = made.exports as unknown as Exports;
  wasi.initialize({ exports: { memory: memory!, _initialize: () => program!._initialize() } });
  // The instance that is made first owns the memory of the first thread: those of the other threads come after it.
  scope.postMessage({ kind: "started" });
  if (program.armill_threads(threadCount(shared)) !== 0) throw new Error("the threads do not start");
}

/** Never returns: a thread of the program waits for work as long as the page is open. */
function beThread(module: WebAssembly.Module, shared: Shared, slot: number): void {
  const { wasi, made } = instance(module, [new OpenFile(new File([])), keep, keep], shared);
  wasi.inst = { exports: { memory: memory! } };
  runThreads(shared, slot, (made.exports as unknown as Exports).wasi_thread_start);
}

function answer(program: Exports, ask: Extract<ToWorker, { kind: "ask" }>): void {
  folder.take(ask.changes);
  const method = new TextEncoder().encode(ask.method);
  const path = new TextEncoder().encode(ask.path);
  const at = program.armill_input(method.length + path.length + ask.body.length);
  const input = new Uint8Array(memory!.buffer, at, method.length + path.length + ask.body.length);
  input.set(method);
  input.set(path, method.length);
  input.set(ask.body, method.length + path.length);
  const status = program.armill_answer(method.length, path.length);
  // The memory may have grown: another buffer.
  const output = new Uint8Array(memory!.buffer, program.armill_output(), program.armill_output_bytes());
  const end = output.indexOf(10);
  const type = new TextDecoder().decode(output.slice(0, end));
  const bytes = output.slice(end + 1);
  const written = ask.writes ? folder.changes() : [];
  scope.postMessage({ kind: "reply", status, type, bytes, written }, [bytes.buffer]);
}

scope.onmessage = ({ data }) => {
  try {
    if (data.kind === "start") start(data.program, data.shared);
    else if (data.kind === "thread") beThread(data.program, data.shared, data.slot);
    else answer(program!, data);
  } catch (error) {
    const what = error instanceof Error ? error.message : String(error);
    scope.postMessage({ kind: "failed", message: [...messages, what].join("\n") });
  }
};
