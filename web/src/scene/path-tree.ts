// Points of a path in groups of consecutive ones, each group with its sphere: what is under the pointer and what the screen can
// show is found from the groups, so that the work is that of the screen and not of a million points.

import type * as THREE from "three";
import { known, type Points, type Values } from "./points";

/** Points of a group at the lowest level; each level above joins two groups. */
const LEAF = 8;

/** A camera with the size of its picture, px. */
export class Screen {
  private readonly m: number[];
  /** Pixels of an object of size 1 at a distance of 1. */
  readonly focal: number;

  constructor(
    camera: THREE.Camera,
    readonly width: number,
    readonly height: number,
  ) {
    this.m = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse).elements;
    this.focal = (camera.projectionMatrix.elements[5]! * height) / 2;
  }

  /** x, y in the picture, and the distance from the camera, which is not positive behind it. */
  project(x: number, y: number, z: number, out: Float64Array): void {
    const m = this.m;
    const w = m[3]! * x + m[7]! * y + m[11]! * z + m[15]!;
    out[0] = (((m[0]! * x + m[4]! * y + m[8]! * z + m[12]!) / w + 1) * this.width) / 2;
    out[1] = ((1 - (m[1]! * x + m[5]! * y + m[9]! * z + m[13]!) / w) * this.height) / 2;
    out[2] = w;
  }
}

/** Centre x, y, z and radius of each group of a level. */
type Spheres = Float32Array;

export class PathTree {
  /** From the groups of LEAF points to the one group of all. */
  private readonly levels: Spheres[] = [];
  /** The point of each group with the largest value. */
  private peaks: Uint32Array[] = [];
  private peaks_of: Values | null = null;
  private readonly out = new Float64Array(3);

  constructor(private readonly points: Points) {
    const count = Math.ceil(points.count / LEAF);
    let boxes = new Float32Array(6 * count);
    for (let i = 0; i < count; i++) boxOf(points.xyz, i * LEAF, Math.min(points.count, (i + 1) * LEAF), boxes, 6 * i);
    this.levels.push(spheres(boxes));
    while (boxes.length > 6) {
      boxes = joined(boxes);
      this.levels.push(spheres(boxes));
    }
  }

  /** The point nearest to (x, y) in the picture, if it is within `near` pixels. */
  nearest(screen: Screen, x: number, y: number, near: number): number | null {
    let [best, least] = [-1, near * near];
    const { points, out } = this;
    const look = (level: number, i: number) => {
      const spheres = this.levels[level]!;
      if (4 * i >= spheres.length || this.apart(screen, spheres, i, x, y) >= Math.sqrt(least)) return;
      if (level > 0) {
        const below = this.levels[level - 1]!;
        const [a, b] = [2 * i, 2 * i + 1];
        const first = 4 * b >= below.length || this.apart(screen, below, a, x, y) <= this.apart(screen, below, b, x, y);
        look(level - 1, first ? a : b);
        return look(level - 1, first ? b : a);
      }
      for (let p = i * LEAF; p < Math.min(points.count, (i + 1) * LEAF); p++) {
        screen.project(points.xyz[3 * p]!, points.xyz[3 * p + 1]!, points.xyz[3 * p + 2]!, out);
        if (out[2]! <= 0) continue;
        const apart = (out[0]! - x) ** 2 + (out[1]! - y) ** 2;
        if (apart < least) [best, least] = [p, apart];
      }
    };
    if (points.count > 0) look(this.levels.length - 1, 0);
    return best < 0 ? null : best;
  }

  /**
   * Points for a line whose parts smaller than `pixels` are one point each: that with the largest of `values`, so that no peak is lost.
   * `take` is called in the order of the path; `joined` is false after a part that is not in the picture. It ends, and is false, where there
   * would be more than `most` points.
   */
  visible(screen: Screen, pixels: number, values: Values, most: number, take: (index: number, joined: boolean) => void): boolean {
    this.findPeaks(values);
    const { points, out } = this;
    let joined = false;
    let count = 0;
    const look = (level: number, i: number) => {
      const spheres = this.levels[level]!;
      if (4 * i >= spheres.length || count > most) return;
      screen.project(spheres[4 * i]!, spheres[4 * i + 1]!, spheres[4 * i + 2]!, out);
      const [x, y, radius] = [out[0]!, out[1]!, this.radius(screen, spheres, i)];
      if (radius < Infinity && (x + radius < 0 || y + radius < 0 || x - radius > screen.width || y - radius > screen.height)) {
        joined = false;
        return;
      }
      if (2 * radius < pixels) {
        take(this.peaks[level]![i]!, joined);
        joined = true;
        count++;
      } else if (level > 0) {
        look(level - 1, 2 * i);
        look(level - 1, 2 * i + 1);
      } else {
        let [x0, y0] = [Infinity, Infinity];
        for (let p = i * LEAF; p < Math.min(points.count, (i + 1) * LEAF); p++) {
          screen.project(points.xyz[3 * p]!, points.xyz[3 * p + 1]!, points.xyz[3 * p + 2]!, out);
          const [px, py] = [out[0]!, out[1]!];
          if (Math.hypot(px - x0, py - y0) < pixels && p !== this.peaks[0]![i]) continue;
          [x0, y0] = [px, py];
          take(p, joined);
          joined = true;
          count++;
        }
      }
    };
    if (points.count > 0) look(this.levels.length - 1, 0);
    return count <= most;
  }

  /** Ranges of points that may be in the picture. */
  ranges(screen: Screen): [first: number, end: number][] {
    const found: [number, number][] = [];
    const { out } = this;
    const look = (level: number, i: number) => {
      const spheres = this.levels[level]!;
      if (4 * i >= spheres.length) return;
      screen.project(spheres[4 * i]!, spheres[4 * i + 1]!, spheres[4 * i + 2]!, out);
      const [x, y, radius] = [out[0]!, out[1]!, this.radius(screen, spheres, i)];
      if (radius < Infinity && (x + radius < 0 || y + radius < 0 || x - radius > screen.width || y - radius > screen.height)) return;
      const inside = x - radius >= 0 && y - radius >= 0 && x + radius <= screen.width && y + radius <= screen.height;
      if (level > 0 && !inside) {
        look(level - 1, 2 * i);
        return look(level - 1, 2 * i + 1);
      }
      const size = LEAF * 2 ** level;
      const [first, end] = [i * size, Math.min(this.points.count, (i + 1) * size)];
      const last = found.at(-1);
      if (last && last[1] === first) last[1] = end;
      else found.push([first, end]);
    };
    if (this.points.count > 0) look(this.levels.length - 1, 0);
    return found;
  }

  /** No point of a group is nearer to (x, y) than this, px. */
  private apart(screen: Screen, spheres: Spheres, i: number, x: number, y: number): number {
    const { out } = this;
    screen.project(spheres[4 * i]!, spheres[4 * i + 1]!, spheres[4 * i + 2]!, out);
    const [px, py] = [out[0]!, out[1]!];
    const radius = this.radius(screen, spheres, i);
    return radius === Infinity ? 0 : Math.hypot(px - x, py - y) - radius;
  }

  /**
   * No point of a group is farther from its centre in the picture, which was projected last, than this, px: r f (1 + t) / (w - r), t the
   * tangent of the angle off the axis of view. Infinite of a group that the camera is in.
   */
  private radius(screen: Screen, spheres: Spheres, i: number): number {
    const { out } = this;
    const r = spheres[4 * i + 3]!;
    const w = out[2]!;
    if (w - r <= 0) return w + r <= 0 ? 0 : Infinity;
    const off = Math.hypot(out[0]! - screen.width / 2, out[1]! - screen.height / 2) / screen.focal;
    return (r * screen.focal * (1 + off)) / (w - r);
  }

  private findPeaks(values: Values): void {
    if (values === this.peaks_of) return;
    this.peaks_of = values;
    const size = (index: number) => known(values, index) ?? -Infinity;
    const leaves = new Uint32Array(Math.ceil(this.points.count / LEAF));
    for (let i = 0; i < leaves.length; i++) {
      let best = i * LEAF;
      for (let p = best + 1; p < Math.min(this.points.count, (i + 1) * LEAF); p++) if (size(p) > size(best)) best = p;
      leaves[i] = best;
    }
    this.peaks = [leaves];
    while (this.peaks.at(-1)!.length > 1) {
      const below = this.peaks.at(-1)!;
      const above = new Uint32Array(Math.ceil(below.length / 2));
      for (let i = 0; i < above.length; i++) {
        const [a, b] = [below[2 * i]!, below[2 * i + 1] ?? below[2 * i]!];
        above[i] = size(b) > size(a) ? b : a;
      }
      this.peaks.push(above);
    }
  }
}

/** Least and greatest x, y, z of these points. */
function boxOf(xyz: Float32Array, first: number, end: number, boxes: Float32Array, at: number): void {
  for (let k = 0; k < 3; k++) {
    let [low, high] = [Infinity, -Infinity];
    for (let p = first; p < end; p++) {
      const v = xyz[3 * p + k]!;
      if (v < low) low = v;
      if (v > high) high = v;
    }
    boxes[at + k] = low;
    boxes[at + 3 + k] = high;
  }
}

/** Each two boxes as one. */
function joined(boxes: Float32Array): Float32Array<ArrayBuffer> {
  const count = boxes.length / 6;
  const above = new Float32Array(6 * Math.ceil(count / 2));
  for (let i = 0; 6 * i < above.length; i++) {
    const [a, b] = [12 * i, 2 * i + 1 < count ? 12 * i + 6 : 12 * i];
    for (let k = 0; k < 3; k++) {
      above[6 * i + k] = Math.min(boxes[a + k]!, boxes[b + k]!);
      above[6 * i + 3 + k] = Math.max(boxes[a + 3 + k]!, boxes[b + 3 + k]!);
    }
  }
  return above;
}

function spheres(boxes: Float32Array): Spheres {
  const found = new Float32Array((boxes.length / 6) * 4);
  for (let i = 0; 6 * i < boxes.length; i++) {
    const half = [0, 1, 2].map((k) => {
      found[4 * i + k] = (boxes[6 * i + k]! + boxes[6 * i + 3 + k]!) / 2;
      return (boxes[6 * i + 3 + k]! - boxes[6 * i + k]!) / 2;
    });
    // Four bytes round the centre: a little more.
    found[4 * i + 3] = Math.hypot(...half) * 1.0001 + 1e-3;
  }
  return found;
}
