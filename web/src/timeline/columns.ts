// The points of a path as columns of numbers: requested by key, 4 bytes a number, read without conversion. The list of columns comes
// with the answer (`crates/study/src/live/path_columns.rs`).

import type { PathColumn, PathInView } from "../types";

export class PathColumns {
  private readonly there = new Map<string, Float32Array>();
  /** Requests follow one another. */
  private last: Promise<void> = Promise.resolve();

  constructor(
    readonly about: PathInView,
    private readonly request: (keys: string[]) => Promise<ArrayBuffer>,
  ) {}

  get count(): number {
    return this.about.points;
  }

  /** The joints, in the order of the robot. */
  get joints(): PathColumn[] {
    return this.about.columns.filter((column) => column.joint !== null);
  }

  has(key: string): boolean {
    return this.about.columns.some((column) => column.key === key);
  }

  /** The values that have come; null before, and where the path has no such column. */
  get(key: string): Float32Array | null {
    return this.there.get(key) ?? null;
  }

  /** Requests these columns, as far as the path has them and they are not there. */
  load(keys: string[]): Promise<void> {
    const next = this.last.then(() => this.take(keys));
    this.last = next.catch(() => undefined);
    return next;
  }

  private async take(keys: string[]): Promise<void> {
    const columns = this.about.columns.filter(({ key }) => keys.includes(key) && !this.there.has(key));
    if (columns.length === 0 || this.count === 0) return;
    const bytes = await this.request(columns.map(({ key }) => key));
    for (const [key, values] of columnsOf(bytes, columns, this.count)) this.there.set(key, values);
  }
}

/** The columns of an answer: one after the other, each point after point. */
export function columnsOf(bytes: ArrayBuffer, columns: Pick<PathColumn, "key" | "components">[], points: number): [string, Float32Array][] {
  const expected = 4 * points * columns.reduce((sum, { components }) => sum + components, 0);
  if (bytes.byteLength !== expected) throw new Error(`${bytes.byteLength} bytes in place of ${expected}`);
  toNative(bytes, 0, expected / 4);
  let at = 0;
  return columns.map(({ key, components }) => {
    const values = new Float32Array(bytes, at, points * components);
    at += 4 * points * components;
    return [key, values];
  });
}

/** Numbers of the server are little-endian: `count` of them from this byte on, in the order of this machine. */
export function toNative(bytes: ArrayBuffer, from: number, count: number): void {
  const little = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;
  if (little) return;
  const view = new DataView(bytes, from, 4 * count);
  for (let at = 0; at < 4 * count; at += 4) view.setUint32(at, view.getUint32(at, true), false);
}
