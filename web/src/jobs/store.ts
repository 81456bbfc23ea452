// The jobs of the server, kept current: their list, their progress while they run, their results once they are done.

import { api } from "../server";
import type { Job } from "../types";
import { KeptJobs } from "./kept";
import { isOver } from "./kinds";

export class JobStore {
  readonly jobs = new Map<string, Job>();
  private readonly streams = new Map<string, AbortController>();
  private readonly requested = new Set<string>();
  private readonly listeners: (() => void)[] = [];
  private kept: KeptJobs | null = null;

  /** `fail`: what could not be requested. */
  constructor(private readonly fail: (error: unknown) => void) {}

  listen(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** Jobs of earlier servers on this study are listed too. */
  rememberOf(identity: string): void {
    this.kept = new KeptJobs(localStorage, identity);
    for (const job of this.jobs.values()) if (job.answer) this.kept.keep(job);
    this.changed();
  }

  /** The newest first, by the time of the request: `started_s_ago` is as old as what was last received about a job. */
  get sorted(): Job[] {
    const all = [...this.jobs.values()];
    return [...all, ...(this.kept?.except(all, Date.now()) ?? [])].sort((a, b) => b.requested_at_ms - a.requested_at_ms || b.id.localeCompare(a.id, undefined, { numeric: true }));
  }

  async refresh(): Promise<void> {
    try {
      const { jobs } = await api.jobs();
      for (const job of jobs) {
        // The list is without answers: those of finished jobs are requested once.
        this.jobs.set(job.id, withAnswer(job, this.jobs.get(job.id)));
        if (job.state === "done" && !this.jobs.get(job.id)!.answer && !this.requested.has(job.id)) void this.finished(job.id);
        this.watch(job);
      }
      this.changed();
    } catch (error) {
      this.fail(error);
    }
  }

  /** Begins a job on this text, and returns its name. */
  async start(kind: string, text: string, options?: unknown): Promise<string> {
    const { id } = await api.start(kind, text, options);
    await this.refresh();
    return id;
  }

  async cancel(job: Job): Promise<void> {
    try {
      await api.cancel(job.id);
      await this.refresh();
    } catch (error) {
      this.fail(error);
    }
  }

  private watch(job: Job): void {
    if (isOver(job) || this.streams.has(job.id)) return;
    const stream = new AbortController();
    this.streams.set(job.id, stream);
    const news = (now: Job) => {
      this.jobs.set(now.id, withAnswer(now, this.jobs.get(now.id)));
      if (isOver(now)) void this.finished(now.id);
      this.changed();
    };
    // Ended or broken: the list says how it goes on.
    const ended = () => {
      this.streams.delete(job.id);
      if (!isOver(this.jobs.get(job.id) ?? job)) setTimeout(() => void this.refresh(), 1000);
    };
    void api.events(job.id, news, stream.signal).then(ended, ended);
  }

  private async finished(id: string): Promise<void> {
    this.requested.add(id);
    try {
      const job = await api.job(id);
      this.jobs.set(id, job);
      this.kept?.keep(job);
      this.changed();
    } catch (error) {
      // With the next list it is requested again.
      this.requested.delete(id);
      this.fail(error);
    }
  }

  private changed(): void {
    for (const listener of this.listeners) listener();
  }
}

/** A job as the list or an event has it, with what is only in the answer of one. */
const withAnswer = (job: Job, known: Job | undefined): Job => (known?.answer ? { ...job, answer: known.answer, text: known.text, measures: known.measures } : job);
