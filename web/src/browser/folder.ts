// The folder of the study in this browser: its files in memory, and a copy that stays when the page is closed. Nothing is
// sent anywhere.

import type { FileChange } from "./protocol";

interface Entry {
  bytes: Uint8Array;
  changed_at_ms: number;
}

interface Stored {
  identity: string;
  files: [name: string, entry: Entry][];
}

const DATABASE = "armill";
const STORE = "folders";
const KEY = "study";

export class Folder {
  private readonly files = new Map<string, Entry>();
  /** Identifies the study: another one after each opening. */
  identity = "";
  /** Whether it stays when the page is closed. */
  keeps = true;
  private storing: Promise<void> = Promise.resolve();

  /** The folder as it was left; null where there is none. */
  static async left(): Promise<Folder | null> {
    const stored = await inStore<Stored | undefined>("readonly", (store) => store.get(KEY)).catch(() => undefined);
    if (!stored?.files?.some(([name]) => name === "study.toml")) return null;
    const folder = new Folder();
    folder.identity = stored.identity;
    for (const [name, entry] of stored.files) folder.files.set(name, entry);
    return folder;
  }

  get entries(): [name: string, entry: Entry][] {
    return [...this.files];
  }

  bytes(name: string): Uint8Array | null {
    return this.files.get(name)?.bytes ?? null;
  }

  /** Takes changes, and keeps them. */
  take(changes: FileChange[]): void {
    for (const [name, bytes] of changes) {
      if (bytes) this.files.set(name, { bytes, changed_at_ms: Date.now() });
      else this.files.delete(name);
    }
    if (changes.length > 0) void this.keep();
  }

  /** Stores the folder; without room or permission it lasts as long as the page. */
  keep(): Promise<void> {
    if (!this.keeps) return Promise.resolve();
    const stored: Stored = { identity: this.identity, files: this.entries };
    const write = () => inStore("readwrite", (store) => store.put(stored, KEY)).then(() => undefined, () => undefined);
    return (this.storing = this.storing.then(write));
  }
}

/** One request to the database. */
function inStore<T>(mode: IDBTransactionMode, ask: (store: IDBObjectStore) => IDBRequest): Promise<T> {
  return new Promise((done, fail) => {
    const opening = indexedDB.open(DATABASE, 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore(STORE);
    opening.onerror = () => fail(opening.error as Error);
    opening.onsuccess = () => {
      const database = opening.result;
      const request = ask(database.transaction(STORE, mode).objectStore(STORE));
      request.onsuccess = () => (done(request.result as T), database.close());
      request.onerror = () => (fail(request.error as Error), database.close());
    };
  });
}
