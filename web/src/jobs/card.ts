// The card of a job: its kind and study, its progress with the time left, its result with actions, its files.

import { fill, h, type Child } from "../dom";
import { ago, duration, fixed } from "../format";
import type { Live } from "../live";
import { fileLink, openFile } from "../files/open-file";
import { problemSentence } from "../problem-words";
import type { Job } from "../types";
import { isOver, kindName, resultLines, resultSentence, roughly, timeLeft } from "./kinds";
import { APPLIES, applyMeasure, buttonOf } from "./measures";

/** Lines of a result shown without unfolding. */
const LINES = 6;
const FILES = 12;

export interface Card {
  root: HTMLElement;
  /** Updates bar and text, so that a click on "Cancel" and the focus are not lost. */
  tick: (job: Job) => void;
}

export interface CardActions {
  live: Live;
  cancel: (job: Job) => void;
  /** Shows the live view. */
  show: () => void;
  fail: (error: unknown) => void;
}

export function card(first: Job, actions: CardActions): Card {
  const name = kindName(first.kind);
  const time = h("span", { class: "note" });
  const words = h("p", { class: "note progress-words" });
  const bar = isOver(first) ? null : h("progress", { max: 1, "aria-label": `${name}: progress` });
  const tick = (job: Job) => {
    time.textContent = `${ago(job.started_s_ago)}, ${duration(job.seconds)}`;
    const left = timeLeft(job);
    const parts: Child[] = isOver(job)
      ? []
      : [job.of ? `${fixed(job.done, 0)} of ${fixed(job.of, 0)}` : job.state === "waiting" ? "waits for the job before it" : null, left === null ? null : `about ${roughly(left)} left`, job.best ? h("b", {}, job.best) : null].filter((part) => part !== null).flatMap((part, i) => (i > 0 ? [" · ", part] : [part]));
    fill(words, ...parts);
    words.hidden = parts.length === 0;
    if (bar && job.of) bar.value = Math.min(1, job.done / job.of);
  };
  const root = h(
    "article",
    { class: `job ${first.state}`, "aria-label": `${name}, ${first.title}, ${first.state}` },
    h(
      "header",
      {},
      h("h2", {}, name),
      h("span", { class: "job-study" }, first.title),
      h("span", { class: `state ${first.state}` }, first.state),
      time,
      isOver(first) ? null : h("button", { type: "button", class: "quiet small", onclick: () => actions.cancel(first) }, "Cancel"),
    ),
    bar,
    words,
    first.error ? h("div", { class: "note warn" }, problemSentence(first.error.message), h("ul", {}, (first.error.problems ?? []).map((p) => h("li", {}, problemSentence(p.message), p.hint ? h("span", { class: "hint" }, ` ${p.hint}`) : null)))) : null,
    first.state === "done" ? result(first, actions) : null,
    first.files.length > 0 ? h("p", { class: "files" }, "Files: ", first.files.slice(0, FILES).map((file) => [fileLink(file, actions.fail), " "]), first.files.length > FILES ? `and ${first.files.length - FILES} more in Files` : null) : null,
  );
  tick(first);
  return { root, tick };
}

function result(job: Job, { live, show, fail }: CardActions): Child {
  const report = job.files.find((file) => file.endsWith("/report.html"));
  const open = report ? h("button", { type: "button", class: "quiet small", onclick: () => void openFile(report).catch(fail) }, "Show the report") : null;
  if (!job.answer) return [job.best ? h("p", {}, job.best) : null, h("div", { class: "job-actions" }, open)];
  const sentence = resultSentence(job);
  const lines = resultLines(job).map(({ name, what }) => h("li", {}, h("b", {}, name), ` ${what}`));
  const rest = lines.slice(LINES);
  const applicable = job.measures.filter((measure) => measure.changes.length > 0);
  const apply = applicable.map((measure) => {
    const use = () => {
      applyMeasure(measure, live);
      show();
    };
    return h("button", { type: "button", class: "primary small", title: APPLIES, onclick: use }, buttonOf(measure));
  });
  return [
    sentence ? h("p", {}, sentence) : null,
    lines.length > (job.kind === "run" ? 1 : 0) ? [h("ul", { class: "job-lines" }, lines.slice(0, LINES)), rest.length > 0 ? h("details", {}, h("summary", {}, `${rest.length} more`), h("ul", { class: "job-lines" }, rest)) : null] : null,
    h("div", { class: "job-actions" }, apply, open),
  ];
}
