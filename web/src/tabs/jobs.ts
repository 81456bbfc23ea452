// Long work on the server: start it, watch it, cancel it, take its result. It runs on when the page is closed.

import { api, fileAddress } from "../api";
import { fill, h, type Child } from "../dom";
import { ago, duration } from "../format";
import type { Live } from "../live";
import type { Job, Vec3 } from "../types";
import type { Tab } from "./tab";

const KINDS: [string, string, string][] = [
  ["run", "Run the study", "Every question, with tables, pictures and report in the study's folder."],
  ["place", "Find the best place", "Where the part should lie so that a path deviates least; needs [place] in the study."],
  ["posture", "Find the best posture", "The best turn of the tool and branch along the paths; needs a path."],
  ["identify", "Identify compliances", "Joint compliances from load tests; needs them in the study."],
];
const over = (job: Job): boolean => job.state === "done" || job.state === "failed" || job.state === "cancelled";

export function jobsTab(live: Live, go: (tab: string) => void): Tab {
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
      await api.start(kind, live.text);
      await refresh();
    } catch (error) {
      fail(error);
    }
  };
  const draw = () => {
    const all = [...jobs.values()].sort((a, b) => a.started_s_ago - b.started_s_ago || b.id.localeCompare(a.id));
    fill(list, ...(all.length > 0 ? all.map((job) => card(job)) : [h("p", { class: "empty" }, "No work yet. What is started here runs on the server and survives closing this page.")]));
  };
  const card = (job: Job): Child => {
    const share = job.of ? Math.min(1, job.done / job.of) : null;
    return h(
      "article",
      { class: `job ${job.state}`, "aria-label": `${job.title}, ${job.state}` },
      h("header", {}, h("h2", {}, job.title), h("span", { class: `state ${job.state}` }, job.state), h("span", { class: "note" }, `${ago(job.started_s_ago)}, ${duration(job.seconds)}`), over(job) ? null : h("button", { type: "button", class: "quiet small", onclick: () => void api.cancel(job.id).then(refresh, fail) }, "Cancel")),
      over(job) ? null : h("progress", { max: 1, ...(share === null ? {} : { value: share }), "aria-label": `${job.title}: progress` }),
      h("p", { class: "note" }, job.of && !over(job) ? `${job.done} of ${job.of}` : "", job.best ? [job.of && !over(job) ? " · " : "", h("span", {}, "best so far "), h("b", {}, job.best)] : null),
      job.error ? h("div", { class: "note warn" }, job.error.message, h("ul", {}, (job.error.problems ?? []).map((p) => h("li", {}, p.message, p.hint ? h("span", { class: "hint" }, ` ${p.hint}`) : null)))) : null,
      result(job),
      job.files.length > 0 ? h("p", { class: "files" }, "Files: ", job.files.slice(0, 12).map((name) => [h("a", { href: fileAddress(name), target: "_blank", rel: "noopener" }, name), " "]), job.files.length > 12 ? `and ${job.files.length - 12} more in Files` : null) : null,
    );
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
            "Show this place",
          )
        : null,
    ];
  };
  const root = h(
    "div",
    { class: "page" },
    h("header", { class: "page-head" }, h("h1", {}, "Long work")),
    h("div", { class: "starters" }, KINDS.map(([kind, text, about]) => h("button", { type: "button", class: "starter", "data-kind": kind, onclick: () => void start(kind) }, h("b", {}, text), h("span", {}, about)))),
    status,
    list,
  );
  draw();
  void refresh();
  return { id: "jobs", title: "Jobs", root, shown: () => void refresh() };
}
