// Jobs on the server: start, watch and cancel them, use their results. They continue when the page is closed.

import { api, fileAddress } from "../server";
import { fill, h, type Child } from "../dom";
import { ago, duration } from "../format";
import type { Live } from "../live";
import type { Job, Vec3 } from "../types";
import type { Tab } from "./tab";
import { testsDialog } from "./tests-dialog";

/** Name, description, and the table of the study with its bounds. */
const KINDS: [string, string, string, string | null][] = [
  ["run", "Run the study", "All analyses, with tables, pictures and report in the folder of the study.", null],
  ["place", "Find the best placement", "The placement of the part with the smallest deviation of a path.", "place"],
  ["posture", "Find the best posture", "The best spin of the tool and branch along the paths; requires a path.", "posture"],
  ["identify", "Identify compliances", "Joint compliances from load tests: a table in the folder of the study.", null],
];
const over = (job: Job): boolean => job.state === "done" || job.state === "failed" || job.state === "cancelled";

export function jobsTab(live: Live, { go, table }: { go: (tab: string) => void; table: (name: string) => void }): Tab {
  const list = h("div", { class: "jobs" });
  const status = h("p", { class: "note", role: "status" });
  const jobs = new Map<string, Job>();
  const streams = new Map<string, EventSource>();
  const fail = (error: unknown) => void (status.textContent = error instanceof Error ? error.message : String(error));

  const watch = (job: Job) => {
    if (over(job) || streams.has(job.id)) return;
    const stream = api.events(job.id);
    streams.set(job.id, stream);
    stream.addEventListener("job", (event) => {
      const now = JSON.parse((event as MessageEvent<string>).data) as Job;
      jobs.set(now.id, { ...jobs.get(now.id), ...now });
      if (over(now)) {
        stream.close();
        streams.delete(now.id);
        void finished(now.id);
      }
      draw();
    });
    stream.onerror = () => {
      stream.close();
      streams.delete(job.id);
      setTimeout(() => void refresh(), 1000);
    };
  };
  const finished = async (id: string) => {
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
        jobs.set(job.id, { ...jobs.get(job.id), ...job });
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
  // A card is rebuilt when the state of its job changes. While it runs only bar and text are updated, so that a click on
  // "Cancel" and the focus are not lost.
  const cards = new Map<string, { state: string; root: HTMLElement; tick: (job: Job) => void }>();
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
      const made = { state, ...card(job) };
      cards.set(job.id, made);
      return made.root;
    });
    const shown = roots.length > 0 ? roots : [h("p", { class: "empty" }, "No jobs yet. Jobs run on the server and continue when this page is closed.")];
    if (shown.length !== list.children.length || shown.some((root, i) => root !== list.children[i])) list.replaceChildren(...shown);
  };
  const card = (first: Job): { root: HTMLElement; tick: (job: Job) => void } => {
    const time = h("span", { class: "note" });
    const words = h("p", { class: "note" });
    const bar = over(first) ? null : h("progress", { max: 1, "aria-label": `${first.title}: progress` });
    const tick = (job: Job) => {
      time.textContent = `${ago(job.started_s_ago)}, ${duration(job.seconds)}`;
      const counted = job.of && !over(job) ? `${job.done} of ${job.of}` : "";
      fill(words, counted, job.best ? [counted ? " · " : "", over(job) || job.kind !== "place" ? null : null, h("b", {}, job.best)] : null);
      if (bar && job.of) bar.value = Math.min(1, job.done / job.of);
    };
    const root = h(
      "article",
      { class: `job ${first.state}`, "aria-label": `${first.title}, ${first.state}` },
      h("header", {}, h("h2", {}, first.title), h("span", { class: `state ${first.state}` }, first.state), time, over(first) ? null : h("button", { type: "button", class: "quiet small", onclick: () => void api.cancel(first.id).then(refresh, fail) }, "Cancel")),
      bar,
      words,
      first.error ? h("div", { class: "note warn" }, first.error.message, h("ul", {}, (first.error.problems ?? []).map((p) => h("li", {}, p.message, p.hint ? h("span", { class: "hint" }, ` ${p.hint}`) : null)))) : null,
      result(first),
      first.files.length > 0 ? h("p", { class: "files" }, "Files: ", first.files.slice(0, 12).map((name) => [h("a", { href: fileAddress(name), target: "_blank", rel: "noopener" }, name), " "]), first.files.length > 12 ? `and ${first.files.length - 12} more in Files` : null) : null,
    );
    tick(first);
    return { root, tick };
  };
  const result = (job: Job): Child => {
    if (job.state !== "done" || !job.answer) return null;
    const answer = job.answer as { answer?: string; place?: { centre_mm?: Vec3; tilt_deg?: number | null }; placement?: { place?: { centre_mm?: Vec3; tilt_deg?: number | null } } };
    const place = answer.place ?? answer.placement?.place;
    const centre = place?.centre_mm;
    return [
      answer.answer ? h("p", {}, answer.answer) : null,
      centre
        ? h(
            "button",
            {
              type: "button",
              class: "primary small",
              onclick: () => {
                live.change("plane.centre_mm", centre);
                if (typeof place?.tilt_deg === "number") live.change("plane.tilt_deg", place.tilt_deg);
                go("live");
              },
            },
            "Show this placement",
          )
        : null,
    ];
  };
  const root = h(
    "div",
    { class: "page" },
    h("header", { class: "page-head" }, h("h1", {}, "Jobs")),
    h("div", { class: "starters" }, KINDS.map(([kind, text, about, bounds]) =>
        h(
          "div",
          { class: "starter" },
          h("button", { type: "button", "data-kind": kind, onclick: () => void start(kind) }, h("b", {}, text), h("span", {}, about)),
          bounds ? h("button", { type: "button", class: "link", onclick: () => table(bounds) }, bounds === "place" ? "Bounds: [place]" : "Bounds: [posture]") : null,
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
