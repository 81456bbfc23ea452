// Finished jobs, kept in the browser over restarts of the server, which does not know them any more: their files are still
// in the folder.

import type { Job } from "../types";

/** So many of a study are kept, and none whose answer is longer. */
const MOST = 12;
const LONGEST = 200_000;

type Store = Pick<Storage, "getItem" | "setItem">;

export class KeptJobs {
  private readonly name: string;
  private all: Job[];

  /** `identity`: of the study, over restarts of the server. */
  constructor(private readonly store: Store, identity: string) {
    this.name = ["armill-jobs", identity].join("\n");
    this.all = this.read();
  }

  keep(job: Job): void {
    if (JSON.stringify(job).length > LONGEST) return;
    this.all = [job, ...this.all.filter((kept) => !isSame(kept, job))].slice(0, MOST);
    try {
      this.store.setItem(this.name, JSON.stringify(this.all));
    } catch {
      // Without room the list is short after a restart.
    }
  }

  /** Those that are not among the jobs of the server, by names that the server does not give. */
  except(jobs: Job[], now_ms: number): Job[] {
    const others = this.all.filter((kept) => !jobs.some((job) => isSame(kept, job)));
    return others.map((job) => ({ ...job, id: `earlier-${job.requested_at_ms}`, started_s_ago: (now_ms - job.requested_at_ms) / 1000 }));
  }

  private read(): Job[] {
    try {
      const read = JSON.parse(this.store.getItem(this.name) ?? "[]") as Job[];
      return Array.isArray(read) ? read.filter((job) => typeof job?.requested_at_ms === "number" && typeof job.kind === "string" && Array.isArray(job.files) && Array.isArray(job.measures)) : [];
    } catch {
      return [];
    }
  }
}

const isSame = (a: Job, b: Job): boolean => a.kind === b.kind && a.requested_at_ms === b.requested_at_ms;
