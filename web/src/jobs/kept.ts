// Finished jobs, kept in the browser over restarts of the server, which does not know them any more: their files are still
// in the folder.

import type { Job } from "../types";

/** So many of a study are kept, and none whose answer is longer. */
const MOST = 12;
const LONGEST = 200_000;
/** Requests of one job, as two lists have it, differ by less. */
const SAME_MS = 3000;

interface KeptJob {
  /** When it was requested, ms since 1970. */
  at_ms: number;
  job: Job;
}

type Store = Pick<Storage, "getItem" | "setItem">;

export class KeptJobs {
  private readonly name: string;
  private all: KeptJob[];

  /** `identity`: of the study, over restarts of the server. */
  constructor(private readonly store: Store, identity: string) {
    this.name = ["armill-jobs", identity].join("\n");
    this.all = this.read();
  }

  keep(job: Job, now_ms: number): void {
    const at_ms = now_ms - 1000 * job.started_s_ago;
    if (JSON.stringify(job).length > LONGEST) return;
    this.all = [{ at_ms, job }, ...this.all.filter((kept) => !isSame(kept, job.kind, at_ms))].slice(0, MOST);
    try {
      this.store.setItem(this.name, JSON.stringify(this.all));
    } catch {
      // Without room the list is short after a restart.
    }
  }

  /** Those that are not among the jobs of the server, by names that the server does not give. */
  except(jobs: Job[], now_ms: number): Job[] {
    const known = (kept: KeptJob) => jobs.some((job) => isSame(kept, job.kind, now_ms - 1000 * job.started_s_ago));
    return this.all.filter((kept) => !known(kept)).map(({ at_ms, job }) => ({ ...job, id: `earlier-${Math.round(at_ms)}`, started_s_ago: (now_ms - at_ms) / 1000 }));
  }

  private read(): KeptJob[] {
    try {
      const read = JSON.parse(this.store.getItem(this.name) ?? "[]") as KeptJob[];
      return Array.isArray(read) ? read.filter(({ at_ms, job }) => typeof at_ms === "number" && typeof job?.kind === "string" && Array.isArray(job.files) && Array.isArray(job.measures)) : [];
    } catch {
      return [];
    }
  }
}

const isSame = (kept: KeptJob, kind: string, at_ms: number): boolean => kept.job.kind === kind && Math.abs(kept.at_ms - at_ms) < SAME_MS;
