// Long work in this browser: in a worker of its own, one job after the other, as the server of the command does it.

import type { Job } from "../types";
import { isOver } from "../jobs/kinds";
import { decode, encode, type Engine, type Reply } from "./engine";

interface Entry {
  job: Job;
  task: unknown;
  /** Called after each change. */
  listeners: Set<(job: Job) => void>;
}

export class BrowserJobs {
  private readonly all = new Map<string, Entry>();
  /** The program that does the jobs. */
  private worker: Engine | null = null;
  private begun = 0;
  private running = false;
  private stopped: string | null = null;

  constructor(
    /** The program that answers the page. */
    private readonly answers: Engine,
    /** Makes the one that works; made at the first job. */
    private readonly make: () => Engine,
  ) {}

  /** Begins a job; the reply of the program where it refuses it. */
  async begin(task: unknown): Promise<Reply | { id: string }> {
    const id = String(++this.begun);
    const reply = await this.answers.ask("POST", "/api/job", encode({ id, task }));
    if (reply.status !== 200) return reply;
    this.all.set(id, { job: decode(reply.bytes) as Job, task, listeners: new Set() });
    void this.work();
    return { id };
  }

  list(): Job[] {
    return [...this.all.values()].reverse().map(({ job }) => ({ ...current(job), answer: null, text: null, measures: [] }));
  }

  one(id: string): Job | null {
    const entry = this.all.get(id);
    return entry ? { ...current(entry.job), text: textOf(entry.task) } : null;
  }

  cancel(id: string): Job | null {
    const entry = this.all.get(id);
    if (!entry) return null;
    if (entry.job.state === "waiting") this.change(entry, { ...entry.job, state: "cancelled" });
    else if (entry.job.state === "running") {
      this.stopped = id;
      this.worker?.restart();
      this.change(entry, { ...entry.job, state: "cancelled" });
    }
    return this.one(id);
  }

  /** The states of a job until its end. */
  follow(id: string, news: (job: Job) => void, end: () => void): () => void {
    const entry = this.all.get(id)!;
    const listener = (job: Job) => {
      news(job);
      if (!isOver(job)) return;
      entry.listeners.delete(listener);
      end();
    };
    entry.listeners.add(listener);
    listener(entry.job);
    return () => entry.listeners.delete(listener);
  }

  /** Does the waiting jobs, one after the other. */
  private async work(): Promise<void> {
    if (this.running) return;
    this.running = true;
    for (;;) {
      const entry = [...this.all.values()].find(({ job }) => job.state === "waiting");
      if (!entry) break;
      await this.execute(entry);
    }
    this.running = false;
  }

  private async execute(entry: Entry): Promise<void> {
    const { id } = entry.job;
    this.worker ??= this.make();
    const begun = { ...entry.job, state: "running" as const };
    this.change(entry, begun);
    // Times are those of the page: the program begins its own count with the work.
    const times = (job: Job): Job => ({ ...job, requested_at_ms: begun.requested_at_ms, started_s_ago: begun.started_s_ago });
    try {
      const reply = await this.worker.ask("POST", "/api/execute", encode({ id, task: entry.task }), { writes: true, line: (line) => this.change(entry, times(JSON.parse(line) as Job)) });
      if (reply.status === 200) this.change(entry, times(decode(reply.bytes) as Job));
      else this.change(entry, { ...begun, state: "failed", error: (decode(reply.bytes) as { error: Job["error"] }).error });
    } catch (error) {
      if (this.stopped === id) return;
      const message = error instanceof Error ? error.message : String(error);
      this.change(entry, { ...begun, state: "failed", error: { kind: "internal", message, hint: null, problems: [] } });
    }
  }

  private change(entry: Entry, job: Job): void {
    entry.job = job;
    for (const listener of [...entry.listeners]) listener({ ...current(job), answer: null, text: null, measures: [] });
  }
}

const current = (job: Job): Job => ({ ...job, started_s_ago: (Date.now() - job.requested_at_ms) / 1000 });
const textOf = (task: unknown): string | null => (task as { text?: string }).text ?? null;
