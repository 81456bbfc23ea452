// Requests to the server, one function each. The token is in the URL that armill opens, and is kept in this tab.

import { Events } from "./events";
import type { Schema } from "./tables/schema";
import type { At, Change, Changed, Checked, Job, Lobes, MaterialRow, Picture, Pose, Problem, Reachable, RobotRow, Shown, SpinMap, SpinSearch, StoredFile, Study, StudyVersion, Tables, TakenIn, View, Wrong } from "./types";

export class Refused extends Error {
  constructor(
    readonly status: number,
    readonly kind: string,
    message: string,
    readonly problems: Problem[],
    readonly hint: string | null = null,
  ) {
    super(message);
  }
}

const KEY = "armill-token";
let token = "";
/** Answers in the page itself, where it has no server. */
let local: ((method: string, path: string, body: unknown, signal?: AbortSignal) => Promise<Response>) | null = null;
export const answerLocally = (answer: NonNullable<typeof local>): void => void (local = answer);
export const isLocal = (): boolean => local !== null;
// The server cancels the older of two requests of one tab.
const tab = Math.random().toString(36).slice(2, 12);

/** Removes the token from the address, so that it is neither bookmarked nor shared. */
export function takeToken(): void {
  const url = new URL(location.href);
  const given = url.searchParams.get("token");
  if (given) {
    sessionStorage.setItem(KEY, given);
    url.searchParams.delete("token");
    history.replaceState(null, "", url);
  }
  token = given ?? sessionStorage.getItem(KEY) ?? "";
}

export const tokenNow = (): string => token;

/** The token of another tab: used if this one has none, or if the server of its own has ended. Whether it is new. */
export function takeTokenOf(given: string, lost: boolean): boolean {
  if (given === "" || given === token || !(lost || token === "")) return false;
  token = given;
  sessionStorage.setItem(KEY, given);
  return true;
}

export async function raw(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<Response> {
  const plain = body instanceof Blob;
  let response: Response;
  try {
    response = local ? await local(method, path, body, signal) : await fetch(path, {
      method,
      headers: {
        Authorization: `Bearer ${token}`,
        "X-Tab": tab,
        ...(body === undefined || plain ? {} : { "Content-Type": "application/json" }),
      },
      ...(body === undefined ? {} : { body: plain ? body : JSON.stringify(body) }),
      ...(signal ? { signal } : {}),
    });
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    if (local) throw new Refused(500, "internal", error instanceof Error ? error.message : String(error), []);
    throw new Refused(0, "offline", "armill does not answer: the server of this page has ended. Start it again and open the address that it prints.", []);
  }
  if (response.ok) return response;
  let answer: { error?: Partial<Wrong> } = {};
  try {
    answer = await response.json();
  } catch {
    // Without a body only the status is known.
  }
  throw new Refused(response.status, answer.error?.kind ?? "internal", answer.error?.message ?? `the server answered ${response.status}`, answer.error?.problems ?? [], answer.error?.hint ?? null);
}

async function json<T>(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<T> {
  return (await raw(method, path, body, signal)).json() as Promise<T>;
}

export const api = {
  study: () => json<Study>("GET", "/api/study"),
  version: () => json<StudyVersion>("GET", "/api/study/version"),
  save: (text: string, version: string) => json<Study>("PUT", "/api/study", { text, version }),
  check: (text: string, signal?: AbortSignal) => json<Checked>("POST", "/api/check", { text }, signal),
  schema: () => json<Schema>("GET", "/api/schema"),
  tables: (text: string, signal?: AbortSignal) => json<Tables>("POST", "/api/tables", { text }, signal),
  change: (text: string, analysis: string | null, changes: Change[], signal?: AbortSignal) => json<Changed>("POST", "/api/change", { text, analysis, changes }, signal),
  view: async (text: string, analysis: string | null, changes: Change[], shown: Shown, signal?: AbortSignal) => {
    const sent = performance.now();
    const response = await raw("POST", "/api/view", { text, analysis, changes, columns: true, ...shown }, signal);
    const body = await response.text();
    const got = performance.now();
    const view = JSON.parse(body) as View;
    performance.measure("armill:answer", { start: sent, end: got });
    performance.measure("armill:parse", { start: got });
    return view;
  },
  /** Columns of a path, one after the other. */
  pathColumns: async (text: string, analysis: string | null, keys: string[], signal?: AbortSignal) => (await raw("POST", "/api/path-columns", { text, analysis, keys }, signal)).arrayBuffer(),
  /** The surface of the machined part, finished where the frame is the last. */
  partSurface: async (text: string, analysis: string | null, frame: number, frames: number, signal?: AbortSignal) => (await raw("POST", "/api/part-surface", { text, analysis, frame, frames }, signal)).arrayBuffer(),
  mesh: async (text: string, file: string) => (await raw("POST", "/api/mesh", { text, file })).arrayBuffer(),
  bodyMesh: async (text: string, analysis: string | null, key: string) => (await raw("POST", "/api/body-mesh", { text, analysis, key })).arrayBuffer(),
  pose: (text: string, analysis: string | null, at: At, load_case: number, signal?: AbortSignal) => json<Pose>("POST", "/api/pose", { text, analysis, at, case: load_case }, signal),
  lobes: (text: string, analysis: string | null, at: At, joints_deg: number[], signal?: AbortSignal) => json<Lobes>("POST", "/api/lobes", { text, analysis, at, joints_deg }, signal),
  reachable: (text: string, analysis: string | null, signal?: AbortSignal) => json<Reachable>("POST", "/api/reachable", { text, analysis }, signal),
  spinMap: (text: string, analysis: string | null, signal?: AbortSignal) => json<SpinMap>("POST", "/api/spin-map", { text, analysis }, signal),
  spinSearch: (text: string, analysis: string | null, signal?: AbortSignal) => json<SpinSearch>("POST", "/api/spin-search", { text, analysis }, signal),
  pictures: (text: string, analysis: string | null, signal?: AbortSignal) => json<{ pictures: Picture[] }>("POST", "/api/pictures", { text, analysis }, signal),
  table: async (text: string, analysis: string | null, measured = false) => (await raw("POST", "/api/table", { text, analysis, format: "csv", measured })).blob(),
  png: async (text: string, analysis: string | null, name: string) => (await raw("POST", "/api/picture.png", { text, analysis, name })).blob(),
  robots: () => json<RobotRow[]>("GET", "/api/robots"),
  materials: () => json<MaterialRow[]>("GET", "/api/materials"),
  jobs: () => json<{ jobs: Job[] }>("GET", "/api/jobs"),
  job: (id: string) => json<Job>("GET", `/api/jobs/${id}`),
  start: (kind: string, text: string, options?: unknown) => json<{ id: string }>("POST", "/api/jobs", { kind, text, ...(options === undefined ? {} : { options }) }),
  cancel: (id: string) => json<Job>("DELETE", `/api/jobs/${id}`),
  /** Calls `news` for each event of a job until its end. */
  events: async (id: string, news: (job: Job) => void, signal: AbortSignal) => {
    const { body } = await raw("GET", `/api/jobs/${id}/events`, undefined, signal);
    const events = new Events((data) => news(JSON.parse(data) as Job));
    const reader = body!.pipeThrough(new TextDecoderStream()).getReader();
    for (let read = await reader.read(); !read.done; read = await reader.read()) events.take(read.value);
  },
  /** An address that opens a file once; the token is not in it. */
  ticket: (path: string) => json<{ address: string }>("POST", "/api/tickets", { path }),
  file: (path: string, signal?: AbortSignal) => raw("GET", `/api/files/${path.split("/").map(encodeURIComponent).join("/")}`, undefined, signal),
  files: () => json<{ files: StoredFile[] }>("GET", "/api/files"),
  put: (name: string, bytes: Blob, replace: boolean) =>
    json<TakenIn>("PUT", `/api/files/${encodeURIComponent(name)}${replace ? "?replace=1" : ""}`, bytes),
};

let rows: Promise<RobotRow[]> | null = null;
/** The robot library, requested once. */
export const robotRows = (): Promise<RobotRow[]> => (rows ??= api.robots().catch((error: unknown) => ((rows = null), Promise.reject(error as Error))));
