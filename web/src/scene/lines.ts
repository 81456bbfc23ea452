// Lines of a width in pixels, on a plane: coordinates y' and z' in the group that contains them. Their buffer is kept
// and grows if necessary: while the user drags, lines are redrawn with every answer.

import * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { Line } from "../types";

export interface Stroke {
  width: number;
  colour: number;
  opacity: number;
  dashed?: boolean;
}

export class Lines {
  readonly object: LineSegments2;
  /** Segments that there is room for. */
  private room = 0;
  private ends = new THREE.InstancedInterleavedBuffer(new Float32Array(0), 6, 1);
  /** Along each line, for its dashes. */
  private way = new THREE.InstancedInterleavedBuffer(new Float32Array(0), 2, 1);

  constructor(private readonly stroke: Stroke) {
    this.object = fat(stroke);
  }

  draw(lines: Line[]): void {
    const count = lines.reduce((sum, line) => sum + Math.max(0, line.length - 1), 0);
    this.object.visible = count > 0;
    if (count === 0) return;
    if (count > this.room) this.grow(Math.ceil(1.5 * count));
    const [ends, way] = [this.ends.array, this.way.array];
    let n = 0;
    for (const line of lines) {
      let along = 0;
      for (let i = 1; i < line.length; i++, n++) {
        const [[y0, z0], [y1, z1]] = [line[i - 1]!, line[i]!];
        ends[6 * n] = y0;
        ends[6 * n + 1] = z0;
        ends[6 * n + 3] = y1;
        ends[6 * n + 4] = z1;
        if (!this.stroke.dashed) continue;
        way[2 * n] = along;
        along += Math.hypot(y1 - y0, z1 - z0);
        way[2 * n + 1] = along;
      }
    }
    for (const buffer of this.stroke.dashed ? [this.ends, this.way] : [this.ends]) {
      buffer.clearUpdateRanges();
      buffer.addUpdateRange(0, buffer.stride * count);
      buffer.needsUpdate = true;
    }
    this.object.geometry.instanceCount = count;
  }

  private grow(room: number): void {
    this.room = room;
    this.object.geometry.dispose();
    const geometry = new LineSegmentsGeometry();
    this.ends = new THREE.InstancedInterleavedBuffer(new Float32Array(6 * room), 6, 1);
    geometry.setAttribute("instanceStart", new THREE.InterleavedBufferAttribute(this.ends, 3, 0));
    geometry.setAttribute("instanceEnd", new THREE.InterleavedBufferAttribute(this.ends, 3, 3));
    if (this.stroke.dashed) {
      this.way = new THREE.InstancedInterleavedBuffer(new Float32Array(2 * room), 2, 1);
      geometry.setAttribute("instanceDistanceStart", new THREE.InterleavedBufferAttribute(this.way, 1, 0));
      geometry.setAttribute("instanceDistanceEnd", new THREE.InterleavedBufferAttribute(this.way, 1, 1));
    }
    this.object.geometry = geometry;
  }
}

/** Nothing yet, of this stroke. */
export function fat({ width, colour, opacity, dashed = false }: Stroke): LineSegments2 {
  const material = new LineMaterial({ color: colour, linewidth: width, transparent: true, opacity, dashed, dashSize: 14, gapSize: 10, depthWrite: false });
  const object = new LineSegments2(new LineSegmentsGeometry(), material);
  object.visible = false;
  object.frustumCulled = false;
  return object;
}
