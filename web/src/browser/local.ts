// The server in the page: answers the requests that `armill serve` answers, with the program and a folder of this browser.

import type { Job, Picture } from "../types";
import { decode, encode, Engine, type Reply } from "./engine";
import { Folder } from "./folder";
import { BrowserJobs } from "./jobs";
import { pixels } from "./pixels";
import { loadProgram } from "./program";

/** The study that a new visitor sees. */
const FIRST_EXAMPLE = "mh12-groove";
/** Files that the program keeps for itself. */
const isHidden = (name: string): boolean => name.split("/").some((part) => part.startsWith("."));

export interface Example {
  name: string;
  title: string;
}

const TYPES: Record<string, string> = { html: "text/html;charset=utf-8", svg: "image/svg+xml", png: "image/png", json: "application/json", csv: "text/csv;charset=utf-8" };
const typeOf = (name: string): string => TYPES[name.split(".").at(-1)!.toLowerCase()] ?? "application/octet-stream";

export class Local {
  private readonly engine: Engine;
  private readonly jobs: BrowserJobs;

  private constructor(
    program: WebAssembly.Module,
    readonly folder: Folder,
  ) {
    this.engine = new Engine(program, folder);
    this.jobs = new BrowserJobs(this.engine, () => new Engine(program, folder));
  }

  /** A request by a script of the reader, as `armill.request` in the console: the paths are those of `armill serve`. */
  async request(method: string, path: string, body?: unknown): Promise<unknown> {
    const response = await this.answer(method, path, body);
    return response.headers.get("Content-Type") === "application/json" ? response.json() : response.blob();
  }

  /** With the example that the address names, else the folder as it was left, else the first example. */
  static async start(): Promise<Local> {
    const loading = loadProgram();
    const url = new URL(location.href);
    const named = url.searchParams.get("example");
    const left = named === null ? await Folder.left() : null;
    const local = new Local(await loading, left ?? new Folder());
    if (!left) await local.takeExample(named ?? FIRST_EXAMPLE, named === null);
    return local;
  }

  async examples(): Promise<Example[]> {
    return (await read(await this.engine.ask("GET", "/api/examples"))) as Example[];
  }

  /** Replaces the folder by that of an example. One that an address names is not kept before it is saved: the study that
   * this browser keeps stays. */
  async takeExample(name: string, keeps = true): Promise<void> {
    this.folder.keeps = keeps;
    this.folder.take(this.folder.entries.map(([file]) => [file, null]));
    this.folder.identity = `example ${name}${keeps ? "" : " (from its address)"}`;
    await read(await this.engine.ask("POST", "/api/example", encode({ name }), { writes: true }));
    await this.folder.keep();
  }

  /** Replaces the folder by these files, one of which is the study. */
  async takeStudy(study: File, others: File[]): Promise<void> {
    const bytes = async (file: File) => new Uint8Array(await file.arrayBuffer());
    const files = await Promise.all(others.map(async (file) => [file.name, await bytes(file)] as [string, Uint8Array]));
    const text = await bytes(study);
    this.folder.take(this.folder.entries.map(([name]) => [name, null]));
    this.folder.keeps = true;
    this.folder.identity = `${study.name} opened ${new Date().toISOString()}`;
    this.folder.take([...files, ["study.toml", text]]);
    await this.folder.keep();
  }

  /** The reply to a request of the page. */
  async answer(method: string, address: string, body: unknown, signal?: AbortSignal): Promise<Response> {
    const url = new URL(address, "http://page");
    const path = decodeURIComponent(url.pathname);
    if (path.startsWith("/api/files")) return this.files(method, path.slice("/api/files/".length), body, url.searchParams.get("replace") === "1");
    if (path.startsWith("/api/jobs")) return this.ofJobs(method, path.split("/").slice(3), body, signal);
    if (path === "/api/tickets") return json({ address: this.address((body as { path: string }).path) });
    if (path === "/api/picture.png") return this.png(body as { name: string }, signal);
    const reply = await this.engine.ask(method, path, body === undefined ? undefined : encode(body), { writes: method === "PUT", signal });
    if (method === "PUT" && reply.status === 200) await this.saved();
    if (path === "/api/study" && reply.status === 200) return json({ ...((await read(reply)) as object), identity: this.folder.identity, folder: "this browser" });
    return response(reply);
  }

  /** The study is saved by the user: from now on the folder is kept, and a reload shows it. */
  private async saved(): Promise<void> {
    this.folder.keeps = true;
    await this.folder.keep();
    const url = new URL(location.href);
    url.searchParams.delete("example");
    history.replaceState(null, "", url);
  }

  private async files(method: string, name: string, body: unknown, replace: boolean): Promise<Response> {
    const { folder } = this;
    if (name === "") {
      const rows = folder.entries.filter(([file]) => !isHidden(file)).map(([file, { bytes, changed_at_ms }]) => ({ name: file, bytes: bytes.length, modified_s_ago: (Date.now() - changed_at_ms) / 1000 }));
      return json({ files: rows.sort((a, b) => (a.name < b.name ? -1 : 1)) });
    }
    if (method === "GET") {
      const bytes = folder.bytes(name);
      return bytes ? new Response(bytes.slice(), { headers: { "Content-Type": typeOf(name) } }) : refused(404, "not-found", "there is no such file");
    }
    const before = folder.bytes(name);
    if (before && !replace) return refused(409, "conflict", `the file \`${name}\` exists already`);
    folder.take([[name, new Uint8Array(await (body as Blob).arrayBuffer())]]);
    const reply = await this.engine.ask("POST", "/api/uploaded", encode({ name }));
    if (reply.status !== 200) folder.take([[name, before]]);
    return response(reply);
  }

  private async ofJobs(method: string, [id, events]: string[], body: unknown, signal?: AbortSignal): Promise<Response> {
    const { jobs } = this;
    if (id === undefined) {
      if (method === "GET") return json({ jobs: jobs.list() });
      const begun = await jobs.begin(body);
      return "id" in begun ? json(begun) : response(begun);
    }
    const found = method === "DELETE" ? jobs.cancel(id) : jobs.one(id);
    if (!found) return refused(404, "not-found", "there is no such job");
    if (events === undefined) return json(found);
    const stream = new ReadableStream<Uint8Array>({
      start: (controller) => {
        const news = (job: Job) => controller.enqueue(new TextEncoder().encode(`event: job\ndata: ${JSON.stringify(job)}\n\n`));
        const leave = jobs.follow(id, news, () => controller.close());
        signal?.addEventListener("abort", leave, { once: true });
      },
    });
    return new Response(stream);
  }

  /** An address under which the browser shows a file of the folder, while the page is open. */
  private address(name: string): string {
    const bytes = this.folder.bytes(name);
    return URL.createObjectURL(new Blob([bytes?.slice() ?? new Uint8Array()], { type: typeOf(name) }));
  }

  /** A picture in pixels: drawn by the browser. */
  private async png(body: { name: string }, signal?: AbortSignal): Promise<Response> {
    const { name, ...analysis } = body;
    const reply = await this.engine.ask("POST", "/api/pictures", encode(analysis), { signal });
    if (reply.status !== 200) return response(reply);
    const { pictures } = (await read(reply)) as { pictures: Picture[] };
    const picture = pictures.find((one) => one.name === name);
    return picture ? new Response(await pixels(picture.svg)) : refused(400, "invalid-input", `there is no picture \`${name}\``);
  }
}

const json = (value: unknown): Response => new Response(JSON.stringify(value), { headers: { "Content-Type": "application/json" } });
const response = ({ status, type, bytes }: Reply): Response => new Response(bytes, { status, headers: { "Content-Type": type } });
const refused = (status: number, kind: string, message: string): Response => new Response(JSON.stringify({ error: { kind, message, hint: null, problems: [] } }), { status });

/** The value of a reply that must not fail. */
async function read(reply: Reply): Promise<unknown> {
  const value = decode(reply.bytes);
  if (reply.status === 200) return value;
  throw new Error((value as { error: { message: string } }).error.message);
}
