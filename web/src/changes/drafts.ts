// Unsaved text, kept in the browser over reloads and over restarts of the server: one draft per study and tab.

import type { Change } from "../types";

export interface Draft {
  text: string;
  /** Changes of controls that are not in the text yet. */
  changes: Change[];
  analysis: string | null;
  /** The text on disk that the draft is based on, and its version. */
  base: string;
  version: string;
  /** When it was kept, ms since 1970. */
  at_ms: number;
}

type Store = Pick<Storage, "getItem" | "setItem" | "removeItem" | "key" | "length">;

const PREFIX = "armill-draft";

export class Drafts {
  constructor(
    private readonly store: Store,
    /** The study, over restarts of the server. */
    private readonly identity: string,
    public tab: string,
  ) {}

  /** Keeps the draft of this tab; false if the browser has no room. */
  keep(draft: Draft): boolean {
    try {
      this.store.setItem(this.name(this.tab), JSON.stringify(draft));
      return true;
    } catch {
      return false;
    }
  }

  forget(tab = this.tab): void {
    this.store.removeItem(this.name(tab));
  }

  of(tab: string): Draft | null {
    try {
      const draft = JSON.parse(this.store.getItem(this.name(tab)) ?? "null") as Draft | null;
      return draft && typeof draft.text === "string" && typeof draft.base === "string" && Array.isArray(draft.changes) ? draft : null;
    } catch {
      return null;
    }
  }

  /** The newest draft of other tabs, except those of `excluded` ones. */
  newest(excluded: ReadonlySet<string>): { tab: string; draft: Draft } | null {
    const start = this.name("");
    let found: { tab: string; draft: Draft } | null = null;
    for (let i = 0; i < this.store.length; i++) {
      const name = this.store.key(i);
      if (!name?.startsWith(start)) continue;
      const tab = name.slice(start.length);
      const draft = excluded.has(tab) || tab === this.tab ? null : this.of(tab);
      if (draft && draft.at_ms > (found?.draft.at_ms ?? -Infinity)) found = { tab, draft };
    }
    return found;
  }

  private name(tab: string): string {
    return [PREFIX, this.identity, tab].join("\n");
  }
}
