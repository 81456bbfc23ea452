// The files of the program in memory: those of the WASI shim, with the time of their last change, by which the program
// sees that a file is another one.

import { Directory, File, Inode, OpenFile, PreopenDirectory, wasi } from "@bjorn3/browser_wasi_shim";
import type { FileChange } from "./protocol";

class DatedFile extends File {
  private readonly changed_at = BigInt(Math.round(performance.timeOrigin + performance.now() * 1e6));

  override stat(): wasi.Filestat {
    const stat = super.stat();
    stat.mtim = this.changed_at;
    return stat;
  }

  override path_open(oflags: number, rights: bigint, flags: number): { ret: number; fd_obj: OpenFile } {
    const opened = super.path_open(oflags, rights, flags);
    // Of a file that may not be opened there is none, which the types of the shim do not say.
    if (opened.fd_obj as OpenFile | null) opened.fd_obj.fd_filestat_get = () => ({ ret: 0, filestat: this.stat() });
    return opened;
  }
}

/** The folder of the study, as the program sees it. */
export class ProgramFolder {
  private readonly root: Map<string, Inode> = new Map();
  readonly preopened: PreopenDirectory;
  /** The bytes that the page knows. */
  private readonly known = new Map<string, Uint8Array>();

  constructor(name: string) {
    this.preopened = new PreopenDirectory(name, this.root);
  }

  /** Takes changes of the page. */
  take(changes: FileChange[]): void {
    for (const [name, bytes] of changes) {
      const parts = name.split("/");
      const last = parts.pop()!;
      let folder = this.root;
      for (const part of parts) {
        let next = folder.get(part);
        if (!(next instanceof Directory)) folder.set(part, (next = new Directory(new Map())));
        folder = (next as Directory).contents;
      }
      if (bytes) {
        folder.set(last, new DatedFile(bytes));
        this.known.set(name, bytes);
      } else {
        folder.delete(last);
        this.known.delete(name);
      }
    }
  }

  /** What the program has changed since. */
  changes(): FileChange[] {
    const found = new Map<string, Uint8Array>();
    const add = (folder: Map<string, Inode>, before: string) => {
      for (const [name, entry] of folder) {
        if (entry instanceof Directory) add(entry.contents, `${before}${name}/`);
        else if (entry instanceof File) found.set(before + name, entry.data);
      }
    };
    add(this.root, "");
    const changed: FileChange[] = [];
    for (const [name, data] of found) {
      if (isSame(this.known.get(name), data)) continue;
      const bytes = data.slice();
      changed.push([name, bytes]);
      this.known.set(name, bytes);
    }
    for (const name of [...this.known.keys()]) {
      if (found.has(name)) continue;
      changed.push([name, null]);
      this.known.delete(name);
    }
    return changed;
  }
}

const isSame = (a: Uint8Array | undefined, b: Uint8Array): boolean => a !== undefined && a.length === b.length && a.every((byte, i) => byte === b[i]);
