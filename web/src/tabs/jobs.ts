// Jobs on the server: start, watch and cancel them, use their results. They continue when the page is closed.

import { api } from "../server";
import { h } from "../dom";
import { card, type Card } from "../jobs/card";
import { isOver, KINDS } from "../jobs/kinds";
import type { Live } from "../live";
import type { Job } from "../types";
import type { Tab } from "./tab";
import { testsDialog } from "./tests-dialog";

export function jobsTab(live: Live, { go, table }: { go: (tab: string) => void; table: (name: string) => void }): Tab {
  const list = h("div", { class: "jobs" });
  const status = h("p", { class: "note", role: "status" });
  const jobs = new Map<string, Job>();
  const streams = new Map<string, AbortController>();
  const fail = (error: unknown) => void (status.textContent = error instanceof Error ? error.message : String(error));

  const watch = (job: Job) => {
    if (isOver(job) || streams.has(job.id)) return;
    const stream = new AbortController();
    streams.set(job.id, stream);
    const news = (now: Job) => {
      jobs.set(now.id, { ...now, answer: jobs.get(now.id)?.answer ?? now.answer });
      if (isOver(now)) void finished(now.id);
      draw();
    };
    // Ended or broken: the list says how it goes on.
    const ended = () => {
      streams.delete(job.id);
      if (!isOver(jobs.get(job.id) ?? job)) setTimeout(() => void refresh(), 1000);
    };
    void api.events(job.id, news, stream.signal).then(ended, ended);
  };
  const requested = new Set<string>();
  const finished = async (id: string) => {
    requested.add(id);
    try {
      jobs.set(id, await api.job(id));
      draw();
    } catch (error) {
      fail(error);
    }
  };
  const refresh = async () => {
    try {
      const answer = await api.jobs();
      for (const job of answer.jobs) {
        // The list is without answers: those of finished jobs are requested once.
        const known = jobs.get(job.id);
        jobs.set(job.id, { ...job, answer: known?.answer ?? job.answer });
        if (job.state === "done" && !known?.answer && !requested.has(job.id)) void finished(job.id);
        watch(job);
      }
      draw();
    } catch (error) {
      fail(error);
    }
  };
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
  const actions = { live, cancel: (job: Job) => void api.cancel(job.id).then(refresh, fail), show: () => go("live"), fail };
  const begin = async (kind: string, options?: unknown) => {
    await api.start(kind, live.text, options);
    await refresh();
  };
  const tests = testsDialog((name) => void begin("identify", { tests: name }).catch(fail));
  const draw = () => {
    const all = [...jobs.values()].sort((a, b) => a.started_s_ago - b.started_s_ago || b.id.localeCompare(a.id, undefined, { numeric: true }));
    const roots = all.map((job) => {
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
  draw();
  void refresh();
  return { id: "jobs", title: "Jobs", root, shown: () => void refresh() };
}
