// Straight pieces in space of a width in pixels, each end with a colour if wanted. The buffer is kept and grows if necessary.

import * as THREE from "three";
import type { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { fat, type Stroke } from "./lines";
import type { Rgb } from "./colour";

export class Segments {
  readonly object: LineSegments2;
  private count = 0;
  private ends = buffer(0);
  private colours = buffer(0);

  /** `coloured`: each end has its own colour. */
  constructor(stroke: Stroke, private readonly coloured = false) {
    this.object = fat(stroke);
    this.object.material.vertexColors = coloured;
  }

  get size(): number {
    return this.count;
  }

  /** Removes all pieces. */
  begin(): void {
    this.count = 0;
  }

  /** From (x, y, z) of one place to that of another. */
  add(from: ArrayLike<number>, a: number, to: ArrayLike<number>, b: number): void {
    if (6 * this.count >= this.ends.array.length) this.grow();
    const ends = this.ends.array;
    for (let k = 0; k < 3; k++) {
      ends[6 * this.count + k] = from[a + k]!;
      ends[6 * this.count + 3 + k] = to[b + k]!;
    }
    this.count++;
  }

  /** The colours of the ends of the last piece. */
  colour(a: Rgb, b: Rgb): void {
    const at = 6 * (this.count - 1);
    for (let k = 0; k < 3; k++) {
      this.colours.array[at + k] = a[k]!;
      this.colours.array[at + 3 + k] = b[k]!;
    }
  }

  end(): void {
    this.object.visible = this.count > 0;
    if (this.count === 0) return;
    for (const each of this.coloured ? [this.ends, this.colours] : [this.ends]) {
      each.clearUpdateRanges();
      each.addUpdateRange(0, 6 * this.count);
      each.needsUpdate = true;
    }
    this.object.geometry.instanceCount = this.count;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }

  private grow(): void {
    const room = Math.max(256, Math.ceil(1.6 * this.count));
    const [ends, colours] = [this.ends.array, this.colours.array];
    this.object.geometry.dispose();
    const geometry = new LineSegmentsGeometry();
    this.ends = buffer(room);
    this.ends.array.set(ends);
    geometry.setAttribute("instanceStart", new THREE.InterleavedBufferAttribute(this.ends, 3, 0));
    geometry.setAttribute("instanceEnd", new THREE.InterleavedBufferAttribute(this.ends, 3, 3));
    if (this.coloured) {
      this.colours = buffer(room);
      this.colours.array.set(colours);
      geometry.setAttribute("instanceColorStart", new THREE.InterleavedBufferAttribute(this.colours, 3, 0));
      geometry.setAttribute("instanceColorEnd", new THREE.InterleavedBufferAttribute(this.colours, 3, 3));
    }
    this.object.geometry = geometry;
  }
}

const buffer = (room: number) => new THREE.InstancedInterleavedBuffer(new Float32Array(6 * room), 6, 1);
