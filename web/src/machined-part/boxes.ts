// What a ray meets first on a surface of many triangles: boxes around some hundred consecutive triangles each, then the triangles of those
// that the ray meets. Vertices may be displaced along their normals by a multiple of an offset each: boxes grow with it.

import type { PartSurface } from "./surface";

/** Triangles of a box. */
const IN_BOX = 256;
/** Numbers of a box: least and greatest x, y, z, and the largest offset by size. */
const OF_BOX = 7;

export type Vec = [number, number, number];

export interface Hit {
  triangle: number;
  /** From the origin, in lengths of the direction. */
  distance: number;
  /** Of the three vertices; they add up to 1. */
  weights: Vec;
}

export class TriangleBoxes {
  private readonly boxes: Float64Array;

  /** `offsets`: mm for each vertex, not a number where there is none. */
  constructor(
    private readonly surface: Pick<PartSurface, "triangles" | "xyz" | "normals">,
    private readonly offsets: Float32Array | null,
  ) {
    const { triangles, xyz } = surface;
    const count = Math.ceil(triangles.length / 3 / IN_BOX);
    this.boxes = new Float64Array(OF_BOX * count);
    for (let b = 0; b < count; b++) {
      const box = this.boxes.subarray(OF_BOX * b, OF_BOX * (b + 1));
      box.set([Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity, 0]);
      const end = Math.min(triangles.length, 3 * IN_BOX * (b + 1));
      for (let i = 3 * IN_BOX * b; i < end; i++) {
        const v = triangles[i]!;
        for (let k = 0; k < 3; k++) {
          const x = xyz[3 * v + k]!;
          if (x < box[k]!) box[k] = x;
          if (x > box[3 + k]!) box[3 + k] = x;
        }
        const offset = Math.abs(offsets?.[v] ?? 0);
        if (offset > box[6]!) box[6] = offset;
      }
    }
  }

  /** The first triangle on the ray, from either side, with offsets so many times; null without any. */
  under(origin: Vec, direction: Vec, times: number): Hit | null {
    const count = this.surface.triangles.length / 3;
    let first: Hit | null = null;
    for (let b = 0; OF_BOX * b < this.boxes.length; b++) {
      if (!this.meets(b, origin, direction, times, first?.distance ?? Infinity)) continue;
      const end = Math.min(count, IN_BOX * (b + 1));
      for (let t = IN_BOX * b; t < end; t++) {
        const hit = this.triangle(t, origin, direction, times);
        if (hit && hit.distance < (first?.distance ?? Infinity)) first = hit;
      }
    }
    return first;
  }

  /** Whether the ray meets a box nearer than this. */
  private meets(b: number, origin: Vec, direction: Vec, times: number, nearest: number): boolean {
    const at = OF_BOX * b;
    const grown = this.boxes[at + 6]! * Math.abs(times);
    let [from, to] = [0, nearest];
    for (let k = 0; k < 3; k++) {
      const [low, high] = [this.boxes[at + k]! - grown - origin[k]!, this.boxes[at + 3 + k]! + grown - origin[k]!];
      if (direction[k] === 0) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      const [one, other] = [low / direction[k]!, high / direction[k]!];
      from = Math.max(from, Math.min(one, other));
      to = Math.min(to, Math.max(one, other));
    }
    return from <= to;
  }

  private vertex(v: number, times: number, k: number): number {
    const offset = times === 0 ? 0 : (this.offsets?.[v] ?? 0);
    const x = this.surface.xyz[3 * v + k]!;
    return offset === 0 || Number.isNaN(offset) ? x : x + (times * offset * this.surface.normals[4 * v + k]!) / 127;
  }

  /** After Möller and Trumbore 1997. */
  private triangle(t: number, origin: Vec, direction: Vec, times: number): Hit | null {
    const { triangles } = this.surface;
    const [i, j, l] = [triangles[3 * t]!, triangles[3 * t + 1]!, triangles[3 * t + 2]!];
    const [ax, ay, az] = [this.vertex(i, times, 0), this.vertex(i, times, 1), this.vertex(i, times, 2)];
    const [ux, uy, uz] = [this.vertex(j, times, 0) - ax, this.vertex(j, times, 1) - ay, this.vertex(j, times, 2) - az];
    const [vx, vy, vz] = [this.vertex(l, times, 0) - ax, this.vertex(l, times, 1) - ay, this.vertex(l, times, 2) - az];
    const [dx, dy, dz] = direction;
    const [px, py, pz] = [dy * vz - dz * vy, dz * vx - dx * vz, dx * vy - dy * vx];
    const det = ux * px + uy * py + uz * pz;
    if (det === 0) return null;
    const [sx, sy, sz] = [origin[0] - ax, origin[1] - ay, origin[2] - az];
    const u = (sx * px + sy * py + sz * pz) / det;
    if (u < 0 || u > 1) return null;
    const [qx, qy, qz] = [sy * uz - sz * uy, sz * ux - sx * uz, sx * uy - sy * ux];
    const v = (dx * qx + dy * qy + dz * qz) / det;
    if (v < 0 || u + v > 1) return null;
    const distance = (vx * qx + vy * qy + vz * qz) / det;
    return distance >= 0 ? { triangle: t, distance, weights: [1 - u - v, u, v] } : null;
  }
}

/** A value of the vertices at a place: between them where all are known, else that of the nearest one. */
export function valueAt(surface: Pick<PartSurface, "triangles">, values: ArrayLike<number>, { triangle, weights }: Hit): number {
  const vertices = [0, 1, 2].map((k) => surface.triangles[3 * triangle + k]!);
  const between = vertices.reduce((sum, v, k) => sum + weights[k]! * values[v]!, 0);
  return Number.isNaN(between) ? values[nearest(surface, { triangle, weights })]! : between;
}

/** The nearest vertex of the triangle. */
export function nearest(surface: Pick<PartSurface, "triangles">, { triangle, weights }: Pick<Hit, "triangle" | "weights">): number {
  return surface.triangles[3 * triangle + weights.indexOf(Math.max(...weights))]!;
}
