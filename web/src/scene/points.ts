// The points of a path, of holes or of a box: from the JSON of an answer, or from columns of numbers where there may be a million.

import * as THREE from "three";
import type { PathColumns } from "../timeline/columns";
import type { ScenePoints, Vec3 } from "../types";

/** Null or NaN where a value is not known. */
export type Values = readonly (number | null)[] | Float32Array;

/** The columns that are shown under the pointer, in this order. */
export const SHOWN = [["In plane", "in_plane_um"], ["Along", "along_um"], ["Across", "cross_um"], ["Normal", "normal_um"], ["Full", "full_um"]] as const;
/** The columns of a path that the scene draws. */
export const DRAWN = ["xyz_mm", "deviation_um", "outside_joint_limits", "in_collision", "distance_mm", "turn_deg", ...SHOWN.map(([, key]) => key)];

export class Points {
  readonly count: number;
  private box_mm: THREE.Box3 | null = null;
  private outside_known: boolean | null = null;
  private collision_known: boolean | null = null;
  private empty_known: boolean | null = null;

  private constructor(
    /** x, y, z of one point after the other. */
    readonly xyz: Float32Array,
    /** x, y, z of the deviation of the worst case, µm; NaN where it is not known. */
    readonly deviation: Float32Array,
    /** 1 for a posture outside joint limits. */
    readonly outside: ArrayLike<number>,
    /** 1 where no posture keeps the demanded clearance; empty without a cell. */
    readonly in_collision: ArrayLike<number>,
    /** Distance along all cuts, of a path: where it does not rise, a rapid is before the point. */
    readonly distance: Float32Array | null,
    private readonly columns: Record<string, Values | undefined>,
  ) {
    this.count = xyz.length / 3;
  }

  static ofAnswer({ xyz_mm, deviation_um, outside_joint_limits, columns }: ScenePoints): Points {
    const outside = new Uint8Array(xyz_mm.length);
    for (const i of outside_joint_limits) outside[i] = 1;
    const unknown = [NaN, NaN, NaN];
    const { state, ...values } = columns;
    const in_collision = Uint8Array.from(state ?? [], (word) => Number(word === "in_collision"));
    return new Points(new Float32Array(xyz_mm.flat()), new Float32Array(deviation_um.flatMap((d) => d ?? unknown)), outside, in_collision, null, values);
  }

  static ofPath(path: PathColumns): Points {
    const column = (key: string) => path.get(key) ?? new Float32Array(0);
    return new Points(column("xyz_mm"), column("deviation_um"), column("outside_joint_limits"), column("in_collision"), path.get("distance_mm"), Object.fromEntries(SHOWN.map(([, key]) => [key, path.get(key) ?? undefined])));
  }

  at(index: number): Vec3 {
    return [this.xyz[3 * index]!, this.xyz[3 * index + 1]!, this.xyz[3 * index + 2]!];
  }

  /** A column of the table; undefined where the analysis has none. */
  column(key: string): Values | undefined {
    return this.columns[key];
  }

  /** Whether a rapid leads to this point, or nothing. */
  begins(index: number): boolean {
    const along = this.distance;
    return index === 0 || (along !== null && along[index]! <= along[index - 1]! && !this.sameAs(index, index - 1));
  }

  get box(): THREE.Box3 {
    this.box_mm ??= new THREE.Box3().setFromArray(this.xyz);
    return this.box_mm;
  }

  /** Diagonal of all points, mm. */
  get size(): number {
    return this.box.isEmpty() ? 0 : this.box.getSize(new THREE.Vector3()).length();
  }

  get any_outside(): boolean {
    return (this.outside_known ??= Array.prototype.includes.call(this.outside, 1));
  }

  get any_in_collision(): boolean {
    return (this.collision_known ??= Array.prototype.includes.call(this.in_collision, 1));
  }

  /** Whether a point has no posture for another reason. */
  get any_empty(): boolean {
    const values = this.columns.in_plane_um ?? [];
    return (this.empty_known ??= Array.prototype.some.call(values, (value: number | null, i) => (value === null || Number.isNaN(value)) && this.in_collision[i] !== 1));
  }

  private sameAs(a: number, b: number): boolean {
    return [0, 1, 2].every((k) => this.xyz[3 * a + k] === this.xyz[3 * b + k]);
  }
}

/** A value of a column; null where it is not known. */
export function known(values: Values | undefined, index: number): number | null {
  const value = values?.[index];
  return value === undefined || value === null || Number.isNaN(value) ? null : value;
}
