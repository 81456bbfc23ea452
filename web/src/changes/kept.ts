// Nothing is lost: keeps a draft of unsaved changes, watches the file on disk and the other tabs of the study, and says what
// happened with the actions that are possible.

import { api, Refused, takeTokenOf, tokenNow } from "../server";
import type { Live } from "../live";
import type { Study } from "../types";
import { Drafts, type Draft } from "./drafts";
import { merge } from "./merge";
import type { Notices } from "./notices";
import { nameOfTab, openTabs, Tabs } from "./tabs";

/** Time between two looks at the file, and delay before a draft is kept. */
const LOOK_MS = 2000;
const KEEP_MS = 150;

const clock = (at_ms: number): string => new Date(at_ms).toLocaleString(undefined, { dateStyle: "short", timeStyle: "short" });

export class Kept {
  private drafts: Drafts | null = null;
  private tabs: Tabs | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private looking = false;
  private lost = false;
  /** The file as another program has left it, while the user decides. */
  private disk: Study | null = null;
  private was_unsaved = false;

  constructor(
    private readonly live: Live,
    private readonly notices: Notices,
    /** Shows the number of other tabs. */
    private readonly showOthers: (count: number) => void,
  ) {}

  /** Opens the study, with the unsaved changes of an earlier time if there are any. */
  async open(study: Study): Promise<void> {
    const { live, notices } = this;
    const tab = await nameOfTab();
    const drafts = (this.drafts = new Drafts(localStorage, study.identity, tab));
    const own = drafts.of(tab);
    const left = own ? null : drafts.newest(await openTabs());
    const draft = own ?? left?.draft ?? null;
    live.open(study);
    if (draft) {
      const words = `Unsaved changes of ${clock(draft.at_ms)} were restored.`;
      if (this.restore(draft, study)) notices.show("restored", words, [{ text: "Discard them", run: () => (live.discard(), notices.hide("restored")) }], true);
      // Kept under the name of this tab before the other is removed.
      this.keep();
    }
    if (left) drafts.forget(left.tab);
    this.tabs = new Tabs(study.identity, tab, {
      token: tokenNow,
      unsaved: () => live.unsaved,
      saved: () => void this.look(),
      token_from: (token) => {
        if (takeTokenOf(token, this.lost)) void this.look();
      },
      others: (others) => this.others(others),
    });
    live.listen(["study", "answer", "text"], () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.keep(), KEEP_MS);
    });
    addEventListener("pagehide", () => this.keep());
    document.addEventListener("visibilitychange", () => (document.hidden ? this.keep() : void this.look()));
    addEventListener("focus", () => void this.look());
    addEventListener("beforeunload", (event) => {
      this.keep();
      if (live.unsaved) event.preventDefault();
    });
    setInterval(() => !document.hidden && void this.look(), LOOK_MS);
  }

  /** Saves the study; what prevents it is shown. */
  async save(): Promise<void> {
    try {
      await this.live.save();
      this.notices.hide("disk", "restored", "save");
      this.keep();
      this.tabs?.send("saved");
    } catch (error) {
      if (error instanceof Refused && error.kind === "conflict") return this.look();
      this.notices.show("save", `Not saved: ${error instanceof Error ? error.message : String(error)}`, [], true);
    }
  }

  /** Compares the file on disk with the one that the text is based on. */
  async look(): Promise<void> {
    const { live, notices } = this;
    if (this.looking || !live.study) return;
    this.looking = true;
    try {
      const { version, exists } = await api.version();
      notices.hide("server");
      if (this.lost) {
        this.lost = false;
        live.refresh();
      }
      if (version === live.study.version) notices.hide("disk");
      else if (!exists) this.deleted(version);
      else await this.changed(await api.study());
    } catch (error) {
      if (error instanceof Refused && (error.status === 0 || error.status === 401)) this.serverLost(error.status === 401);
    } finally {
      this.looking = false;
    }
  }

  private deleted(version: string): void {
    const { live, notices } = this;
    const save = async () => {
      live.study = { ...live.study!, text: "", version, exists: false };
      await this.save();
    };
    notices.show("disk", `${this.file} was deleted. Its text is kept here.`, [{ text: "Save as a new file", run: save }]);
  }

  private async changed(disk: Study): Promise<void> {
    const { live, notices } = this;
    // What is compared is complete.
    await live.applyWaiting();
    const base = live.study!;
    // Saved by this page in the meantime.
    if (disk.version === base.version) return notices.hide("disk");
    if (!live.unsaved) {
      live.open(disk);
      notices.show("disk-loaded", `${this.file} was changed by another program and has been loaded.`, [{ text: "Undo", run: () => (live.undo(), notices.hide("disk-loaded")) }], true);
      return notices.hide("disk");
    }
    this.disk = disk;
    // The message may be there already: its actions use the newest file.
    const chosen = (act: (disk: Study) => void) => () => {
      if (this.disk) act(this.disk);
      this.disk = null;
      notices.hide("disk");
    };
    const mine = chosen((now) => live.rebase(now));
    if (disk.text === live.text) return mine();
    const load = { text: "Load it", run: chosen((now) => live.open(now)) };
    const keep = { text: "Keep mine", run: mine };
    const both = {
      text: "Merge both",
      run: chosen((now) => {
        const merged = merge(live.study!.text, live.text, now.text);
        live.rebase(now);
        if (merged !== null) live.use(merged, live.analyses);
      }),
    };
    const can_merge = merge(base.text, live.text, disk.text) !== null;
    notices.show("disk", `${this.file} was changed on disk, and you have unsaved changes.${can_merge ? "" : " Both changed the same lines."}`, can_merge ? [both, load, keep] : [load, keep]);
  }

  private serverLost(restarted: boolean): void {
    this.lost = true;
    const kept = this.live.unsaved ? " Your unsaved changes are kept in this browser." : "";
    this.notices.show("server", restarted ? `armill was restarted. Open the address that it printed.${kept}` : `armill does not answer: its server has ended. Start it again and open the address that it prints.${kept}`);
  }

  private others(others: ReadonlyMap<string, boolean>): void {
    const { live, notices } = this;
    this.showOthers(others.size);
    const unsaved = [...others].find(([, unsaved]) => unsaved)?.[0];
    if (unsaved === undefined) return notices.hide("tab");
    const take = () => {
      const draft = this.drafts?.of(unsaved);
      if (draft) this.restore(draft, live.study!);
      notices.hide("tab");
    };
    notices.show("tab", "Another tab has unsaved changes of this study.", [{ text: "Take them over", run: take }], true);
  }

  /** Uses a draft; whether it differs from the file. */
  private restore(draft: Draft, disk: Study): boolean {
    const { live } = this;
    if (draft.text === disk.text && draft.changes.length === 0) return false;
    // What changed on disk in between is found at the next look, and then merged or chosen.
    if (draft.version !== disk.version) live.rebase({ ...disk, text: draft.base, version: draft.version });
    live.restoreDraft(draft);
    if (draft.version !== disk.version) void this.look();
    return true;
  }

  /** Keeps the present text, or removes the draft if nothing is unsaved. */
  private keep(): void {
    const { live, drafts } = this;
    clearTimeout(this.timer);
    if (!drafts || !live.study) return;
    if (!live.unsaved) {
      drafts.forget();
      this.notices.hide("restored");
    } else if (!drafts.keep({ text: live.text, changes: live.waiting, analysis: live.analysis, base: live.study.text, version: live.study.version, at_ms: Date.now() })) this.notices.show("draft", "The browser has no room to keep unsaved changes: save the study before you close this page.", [], true);
    if (this.was_unsaved !== live.unsaved) {
      this.was_unsaved = live.unsaved;
      this.tabs?.send("here");
    }
  }

  private get file(): string {
    return this.live.study!.file.split("/").at(-1)!;
  }
}
