// One worker with the program, and those of its threads: requests one after the other; the files of the folder go with them.

import type { Folder } from "./folder";
import type { FileChange, FromWorker, ToWorker } from "./protocol";
import { newShared, threadCount } from "./threads";
import ProgramWorker from "./worker?worker&inline";

export interface Reply {
  status: number;
  type: string;
  bytes: Uint8Array<ArrayBuffer>;
}

export const encode = (value: unknown): Uint8Array => new TextEncoder().encode(JSON.stringify(value));
export const decode = (bytes: Uint8Array): unknown => JSON.parse(new TextDecoder().decode(bytes));

interface Ask {
  method: string;
  path: string;
  body: Uint8Array;
  /** Whether the program may write files. */
  writes: boolean;
  signal: AbortSignal | undefined;
  line: ((line: string) => void) | undefined;
  done: (reply: Reply) => void;
  fail: (error: unknown) => void;
}

/** A request without anyone waiting for it is ended after this time, with its worker; a shorter one is waited for. */
const PATIENCE_MS = 1000;

export class Engine {
  /** The one that is asked, and those of its threads. */
  private worker: Worker | null = null;
  private threads: Worker[] = [];
  private startThreads = () => {};
  private readonly queue: Ask[] = [];
  private current: Ask | null = null;
  /** Whether the worker works at all, and why not. */
  private has_answered = false;
  private broken: Error | null = null;
  /** The files that the worker has. */
  private seen = new Map<string, Uint8Array>();

  constructor(
    private readonly program: WebAssembly.Module,
    private readonly folder: Folder,
  ) {
    this.start();
  }

  /** The reply to a request. `line`: called with each line that the program writes meanwhile. */
  ask(method: string, path: string, body: Uint8Array = new Uint8Array(), options: { writes?: boolean; signal?: AbortSignal | undefined; line?: (line: string) => void } = {}): Promise<Reply> {
    return new Promise((done, fail) => {
      const { signal } = options;
      if (signal?.aborted) return fail(signal.reason as Error);
      if (this.broken) return fail(this.broken);
      const ask: Ask = { method, path, body, writes: options.writes ?? false, signal, line: options.line, done, fail };
      this.queue.push(ask);
      signal?.addEventListener("abort", () => this.abort(ask), { once: true });
      this.next();
    });
  }

  /** Ends the work under way; the next request has a new worker. */
  restart(): void {
    this.end(new DOMException("cancelled", "AbortError"));
  }

  /** Ends the workers; the request under way fails with this error. */
  private end(error: Error): void {
    const { current } = this;
    for (const worker of [...this.threads, this.worker!]) worker.terminate();
    this.current = null;
    current?.fail(error);
    if (this.broken) return;
    this.start();
    this.next();
  }

  private start(): void {
    this.seen = new Map();
    const { program } = this;
    const shared = newShared();
    const made = (first: ToWorker): Worker => {
      const worker = new ProgramWorker();
      worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.take(data);
      worker.onerror = (event) => this.failed(event.message || "the worker did not start");
      worker.postMessage(first);
      return worker;
    };
    this.threads = [];
    this.startThreads = () => {
      if (shared) this.threads = Array.from({ length: threadCount(shared) }, (_, slot) => made({ kind: "thread", program, shared, slot }));
    };
    this.worker = made({ kind: "start", program, shared });
  }

  private next(): void {
    if (this.current) return;
    const ask = (this.current = this.queue.shift() ?? null);
    if (!ask) return;
    const { method, path, body, writes } = ask;
    const message: ToWorker = { kind: "ask", method, path, body, changes: this.changes(), writes };
    this.worker!.postMessage(message);
  }

  /** What has changed in the folder since the worker saw it. */
  private changes(): FileChange[] {
    const changes: FileChange[] = [];
    const files = new Map(this.folder.entries.map(([name, { bytes }]) => [name, bytes]));
    for (const [name, bytes] of files) if (this.seen.get(name) !== bytes) changes.push([name, bytes]);
    for (const name of this.seen.keys()) if (!files.has(name)) changes.push([name, null]);
    this.seen = files;
    return changes;
  }

  private take(message: FromWorker): void {
    const { current } = this;
    if (message.kind === "line") return current?.line?.(message.line);
    if (message.kind === "started") return this.startThreads();
    if (message.kind === "failed") return this.failed(message.message);
    this.has_answered = true;
    for (const [name, bytes] of message.written) bytes ? this.seen.set(name, bytes) : this.seen.delete(name);
    this.folder.take(message.written);
    this.current = null;
    current?.done({ status: message.status, type: message.type, bytes: message.bytes as Uint8Array<ArrayBuffer> });
    this.next();
  }

  /** The program has ended: its request fails, the next one has a new worker. */
  private failed(message: string): void {
    const error = new Error(`internal error of armill: ${message}`);
    if (!this.has_answered) {
      // A program that does not start would fail again, without end.
      this.broken = error;
      for (const ask of this.queue.splice(0)) ask.fail(error);
    }
    this.end(error);
  }

  private abort(ask: Ask): void {
    const waiting = this.queue.indexOf(ask);
    if (waiting >= 0) {
      this.queue.splice(waiting, 1);
      return ask.fail(ask.signal!.reason as Error);
    }
    setTimeout(() => this.current === ask && this.restart(), PATIENCE_MS);
  }
}
