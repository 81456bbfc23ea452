// The server: one function a call. The token comes with the URL that armill opened and stays in this tab.

import type { Schema } from "./tables/schema";
import type { At, Change, Changed, Checked, Job, Picture, Pose, Problem, RobotRow, Stand, StoredFile, Study, Tables, TakenIn, View, Wrong } from "./types";

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
// The server drops the older of two answers to one tab.
const tab = Math.random().toString(36).slice(2, 12);

/** Takes the token out of the address, so that it is neither bookmarked nor shared. */
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

/** An address with the token in it, for what the browser fetches by itself. */
export const addressed = (path: string): string => `${path}${path.includes("?") ? "&" : "?"}token=${token}`;

export async function raw(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<Response> {
  const plain = body instanceof Blob;
  let response: Response;
  try {
    response = await fetch(path, {
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
    throw new Refused(0, "offline", "armill does not answer: the program that serves this page has ended. Start it again and open the address that it prints.", []);
  }
  if (response.ok) return response;
  let told: { error?: Partial<Wrong> } = {};
  try {
    told = await response.json();
  } catch {
    // Told without a body: the status has to do.
  }
  throw new Refused(response.status, told.error?.kind ?? "internal", told.error?.message ?? `the server answered ${response.status}`, told.error?.problems ?? [], told.error?.hint ?? null);
}

async function json<T>(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<T> {
  return (await raw(method, path, body, signal)).json() as Promise<T>;
}

export const api = {
  study: () => json<Study>("GET", "/api/study"),
  save: (text: string, version: string) => json<Study>("PUT", "/api/study", { text, version }),
  check: (text: string, signal?: AbortSignal) => json<Checked>("POST", "/api/check", { text }, signal),
  schema: () => json<Schema>("GET", "/api/schema"),
  tables: (text: string, signal?: AbortSignal) => json<Tables>("POST", "/api/tables", { text }, signal),
  change: (text: string, ask: string | null, changes: Change[], signal?: AbortSignal) => json<Changed>("POST", "/api/change", { text, ask, changes }, signal),
  view: async (text: string, ask: string | null, changes: Change[], stand: Stand, signal?: AbortSignal) => {
    const asked = performance.now();
    const response = await raw("POST", "/api/view", { text, ask, changes, stand }, signal);
    const body = await response.text();
    const got = performance.now();
    const view = JSON.parse(body) as View;
    performance.measure("armill:answer", { start: asked, end: got });
    performance.measure("armill:parse", { start: got });
    return view;
  },
  mesh: async (text: string, file: string) => (await raw("POST", "/api/mesh", { text, file })).arrayBuffer(),
  pose: (text: string, ask: string | null, at: At, load_case: number, signal?: AbortSignal) => json<Pose>("POST", "/api/pose", { text, ask, at, case: load_case }, signal),
  pictures: (text: string, ask: string | null, signal?: AbortSignal) => json<{ pictures: Picture[] }>("POST", "/api/pictures", { text, ask }, signal),
  table: async (text: string, ask: string | null, measured = false) => (await raw("POST", "/api/table", { text, ask, format: "csv", measured })).blob(),
  png: async (text: string, ask: string | null, name: string) => (await raw("POST", "/api/picture.png", { text, ask, name })).blob(),
  robots: () => json<RobotRow[]>("GET", "/api/robots"),
  jobs: () => json<{ jobs: Job[] }>("GET", "/api/jobs"),
  job: (id: string) => json<Job>("GET", `/api/jobs/${id}`),
  start: (kind: string, text: string, options?: unknown) => json<{ id: string }>("POST", "/api/jobs", { kind, text, ...(options === undefined ? {} : { options }) }),
  cancel: (id: string) => json<Job>("DELETE", `/api/jobs/${id}`),
  events: (id: string) => new EventSource(addressed(`/api/jobs/${id}/events`)),
  files: () => json<{ files: StoredFile[] }>("GET", "/api/files"),
  put: (name: string, bytes: Blob, replace: boolean) =>
    json<TakenIn>("PUT", `/api/files/${encodeURIComponent(name)}${replace ? "?replace=1" : ""}`, bytes),
};

export const fileAddress = (name: string): string => addressed(`/api/files/${name.split("/").map(encodeURIComponent).join("/")}`);
