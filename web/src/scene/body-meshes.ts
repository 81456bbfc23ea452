// The triangles of bodies that are meshes, requested once for each key. Without them, and where the server refuses, there is none.

import * as THREE from "three";
import { meshOf } from "./shapes";

export class BodyMeshes {
  private readonly known = new Map<string, THREE.BufferGeometry | null>();

  /** `fetched`: the bytes of a mesh; `ready`: one more is there. */
  constructor(private readonly fetched: (key: string) => Promise<ArrayBuffer>, private readonly ready: () => void) {}

  /** The triangles, if they have come; else they are requested. */
  of(key: string): THREE.BufferGeometry | null {
    if (!this.known.has(key)) void this.load(key);
    return this.known.get(key) ?? null;
  }

  /** Only these are needed. */
  keep(keys: Set<string>): void {
    for (const [key, geometry] of this.known)
      if (!keys.has(key)) {
        geometry?.dispose();
        this.known.delete(key);
      }
  }

  private async load(key: string): Promise<void> {
    this.known.set(key, null);
    try {
      const geometry = meshOf(await this.fetched(key));
      if (!this.known.has(key)) return geometry.dispose();
      this.known.set(key, geometry);
    } catch {
      // The box around it is drawn.
      return;
    }
    this.ready();
  }
}
