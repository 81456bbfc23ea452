// Jobs on the server: start, watch and cancel them, use their results. They continue when the page is closed.

import { h } from "../dom";
import { card, type Card } from "../jobs/card";
import { KINDS } from "../jobs/kinds";
import type { JobStore } from "../jobs/store";
import type { Live } from "../live";
import type { Job } from "../types";
import type { Tab } from "./tab";
import { testsDialog } from "./tests-dialog";

export function jobsTab(live: Live, store: JobStore, { go, table }: { go: (tab: string) => void; table: (name: string) => void }): Tab {
  const list = h("div", { class: "jobs" });
  const status = h("p", { class: "note", role: "status" });
  const fail = (error: unknown) => void (status.textContent = error instanceof Error ? error.message : String(error));
  const start = async (kind: string) => {
    status.textContent = "";
    try {
      if (kind === "identify") return await tests.open();
      await begin(kind);
    } catch (error) {
      fail(error);
    }
  };
  // A card is rebuilt when the state of its job changes.
  const cards = new Map<string, Card & { state: string }>();
  const actions = { live, cancel: (job: Job) => void store.cancel(job), show: () => go("live"), fail };
  const begin = async (kind: string, options?: unknown) => {
    await store.start(kind, live.text, options);
  };
  const tests = testsDialog((name) => void begin("identify", { tests: name }).catch(fail));
  const draw = () => {
    const roots = store.sorted.map((job) => {
      const state = `${job.state} ${job.answer ? "answered" : ""} ${job.files.length}`;
      const known = cards.get(job.id);
      if (known?.state === state) {
        known.tick(job);
        return known.root;
      }
      const made = { state, ...card(job, actions) };
      cards.set(job.id, made);
      return made.root;
    });
    const shown = roots.length > 0 ? roots : [h("p", { class: "empty" }, "No jobs yet. Jobs run on the server and continue when this page is closed.")];
    if (shown.length !== list.children.length || shown.some((root, i) => root !== list.children[i])) list.replaceChildren(...shown);
  };
  const root = h(
    "div",
    { class: "page" },
    h("header", { class: "page-head" }, h("h1", {}, "Jobs")),
    h("div", { class: "starters" }, KINDS.map(({ id, start: text, about, bounds }) =>
        h(
          "div",
          { class: "starter" },
          h("button", { type: "button", "data-kind": id, onclick: () => void start(id) }, h("b", {}, text), h("span", {}, about)),
          bounds ? h("button", { type: "button", class: "link", onclick: () => table(bounds) }, `Bounds: [${bounds}]`) : null,
        ),
      )),
    status,
    list,
    tests.root,
  );
  store.listen(draw);
  draw();
  void store.refresh();
  return { id: "jobs", title: "Jobs", root, shown: () => void store.refresh() };
}
