// Advice in place, of a path: what brings it within the tolerance, each measure with its gain and a button; the compensated
// path and its robot program as files. Jobs of the server find it.

import { h, renew, type Child } from "../dom";
import { fileLink } from "../files/open-file";
import { fixed } from "../format";
import { isOver, roughly, timeLeft } from "../jobs/kinds";
import { APPLIES, applyMeasure, buttonOf } from "../jobs/measures";
import type { JobStore } from "../jobs/store";
import type { Live } from "../live";
import { problemSentence } from "../problem-words";
import type { Job, Measure } from "../types";

/** Languages of robot programs, by the extension of their files; the first is that of the robot. */
const LANGUAGES: [string, string][] = [["", "Language of the robot"], ["src", "KUKA KRL"], ["mod", "ABB RAPID"], ["ls", "FANUC TP"], ["jbi", "Yaskawa INFORM"], ["script", "URScript"], ["pjx", "Staubli VAL3"]];

export function advice(live: Live, store: JobStore): HTMLElement {
  const root = h("section", { class: "advice", "aria-label": "Advice", hidden: true });
  const panel = new Advice(live, store, root);
  live.listen(["answer", "text", "study"], () => panel.draw());
  store.listen(() => panel.draw());
  panel.draw();
  return root;
}

class Advice {
  /** Measures that were applied, by job and kind, and the text since then, for which the others still hold. */
  private readonly applied = new Map<string, { measures: Set<string>; text: string | null }>();
  private problem: string | null = null;
  private language = "";
  private notes_open = false;

  constructor(private readonly live: Live, private readonly store: JobStore, private readonly root: HTMLElement) {}

  draw(): void {
    const kind = this.live.values?.kind;
    this.root.hidden = kind !== "path" && kind !== "holes";
    if (this.root.hidden) return;
    const job = kind === "path" ? this.of("advise") : null;
    const program = this.of("compensate");
    const running = [job, program].find((one) => one && !isOver(one));
    if (job) this.follow(job);
    renew(
      this.root,
      h(
        "div",
        { class: "advice-head" },
        kind === "path" ? h("button", { type: "button", class: "primary small", "data-key": "advise", disabled: running !== undefined, title: "Searches placement, spin, cut and compensation that bring this path within the tolerance", onclick: () => void this.start("advise", { place: { analysis: this.live.analysis } }) }, "Advise") : null,
        h("button", { type: "button", class: "quiet small", "data-key": "compensate", disabled: running !== undefined, title: "The path to command so that the tool follows the nominal path, and a robot program along it", onclick: () => void this.compensate() }, "Compensate and write program"),
        this.languages(),
        running ? this.progress(running) : null,
      ),
      this.problem ? h("p", { class: "note warn", role: "alert" }, this.problem) : null,
      [job, program].map((one) => (one?.state === "failed" && one.error ? this.failed(one) : null)),
      // The answer of a job comes after the news that it is done.
      job?.answer ? this.measures(job) : null,
      program?.answer ? this.files(program) : null,
    );
  }

  /** The newest job of this kind about the analysis shown. */
  private of(kind: string): Job | null {
    const { analysis } = this.live;
    const about = (job: Job) => job.analysis === analysis;
    return this.store.sorted.find((job) => job.kind === kind && about(job)) ?? null;
  }

  private languages(): Child {
    const options = LANGUAGES.map(([value, text]) => h("option", { value, selected: value === this.language }, text));
    return h("select", { class: "advice-language", "aria-label": "Language of the robot program", "data-key": "language", onchange: (e: Event) => void (this.language = (e.target as HTMLSelectElement).value) }, options);
  }

  private progress(job: Job): Child {
    const left = timeLeft(job);
    const words = [job.of ? `${fixed(job.done, 0)} of ${fixed(job.of, 0)}` : "waiting", left === null ? null : `about ${roughly(left)} left`, job.best].filter((part) => part).join(" · ");
    return [
      h("progress", { max: 1, value: job.of ? Math.min(1, job.done / job.of) : 0, "aria-label": "Progress" }),
      h("span", { class: "note advice-words" }, words),
      h("button", { type: "button", class: "quiet small", "data-key": "cancel", onclick: () => void this.store.cancel(job) }, "Cancel"),
    ];
  }

  private failed({ error }: Job): Child {
    const { message, hint, problems } = error!;
    const [first] = problems;
    const more = first?.hint ?? hint;
    return h("p", { class: "note warn" }, problemSentence(first?.message ?? message), more ? h("span", { class: "hint" }, ` ${more}`) : null);
  }

  private measures(job: Job): Child {
    const known = this.applied.get(job.id);
    const current = known ? known.text === null || known.text === this.live.text : job.text === this.live.text;
    const rows = job.measures.map((measure) => {
      const used = known?.measures.has(measure.measure) ?? false;
      return h("li", { class: used ? "used" : "" }, h("span", {}, `${measure.sentence}.`), used ? h("b", {}, "✓ applied") : this.action(measure, job));
    });
    const [summary] = (job.answer as unknown as { advice: string[] }).advice;
    return [current ? null : h("p", { class: "note" }, "For an earlier state of the study: advise again for this one."), h("p", { class: "advice-line" }, summary), h("ul", { class: "advice-measures" }, rows)];
  }

  private action(measure: Measure, job: Job): Child {
    const { changes, measure: kind } = measure;
    if (kind === "compensation") return h("button", { type: "button", class: "quiet small", "data-key": "compensation", onclick: () => void this.compensate() }, "Compensate");
    if (changes.length === 0) return null;
    const apply = () => {
      const known = this.applied.get(job.id) ?? { measures: new Set<string>(), text: null };
      known.measures.add(kind);
      // Known once the server has made the change.
      known.text = null;
      this.applied.set(job.id, known);
      applyMeasure(measure, this.live);
    };
    return h("button", { type: "button", class: "quiet small", "data-key": kind, title: APPLIES, onclick: apply }, buttonOf(measure));
  }

  /** After a measure is applied, the others hold for the text that it made. */
  private follow(job: Job): void {
    const known = this.applied.get(job.id);
    if (known?.text === null && this.live.settled) known.text = this.live.text;
    // Taken back: as before.
    if (known && this.live.settled && this.live.text === job.text) this.applied.delete(job.id);
  }

  private files(job: Job): Child {
    const { sentences, program_notes: notes } = job.answer as unknown as { sentences: string[]; program_notes: string[] };
    const fail = (error: unknown) => this.fail(error);
    const programs = job.files.filter((file) => file.startsWith("programs/"));
    const others = job.files.filter((file) => !file.startsWith("programs/"));
    return h(
      "div",
      { class: "advice-files" },
      h("p", {}, sentences.join(" ")),
      job.text === this.live.text ? null : h("p", { class: "note" }, "For an earlier state of the study."),
      h("p", { class: "files" }, programs.length > 0 ? [h("b", {}, "Robot program: "), programs.map((file) => [fileLink(file, fail, file.slice("programs/".length)), " "])] : null, others.map((file) => [fileLink(file, fail), " "])),
      notes.length > 0 ? h("details", { open: this.notes_open }, h("summary", { onclick: () => void (this.notes_open = !this.notes_open) }, `${notes.length} ${notes.length === 1 ? "note" : "notes"} on the program: read before it is loaded`), h("ul", {}, notes.map((note) => h("li", {}, `${note.charAt(0).toUpperCase()}${note.slice(1)}.`)))) : null,
    );
  }

  private compensate(): Promise<void> {
    return this.start("compensate", { analysis: this.live.analysis, program: true, ...(this.language ? { extension: this.language } : {}) });
  }

  private async start(kind: string, options: unknown): Promise<void> {
    this.problem = null;
    try {
      await this.live.applyWaiting();
      await this.store.start(kind, this.live.text, options);
    } catch (error) {
      this.fail(error);
    }
  }

  private fail(error: unknown): void {
    this.problem = error instanceof Error ? problemSentence(error.message) : String(error);
    this.draw();
  }
}
