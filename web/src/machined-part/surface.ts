// The surface of a machined part: a header and columns of numbers (`crates/study/src/live/part_surface.rs`), read without conversion.

import { toNative } from "../timeline/columns";
import type { PartHeader } from "../types";

/** The quantities that colours show, in the order of the choice. */
export const QUANTITIES = [
  { key: "deviation_um", text: "Predicted", short: "Deviation", title: "Deviation of the surface" },
  { key: "measured_um", text: "Measured (scan)", short: "Measured", title: "Measured deviation of the surface" },
  { key: "measured_less_predicted_um", text: "Measured minus predicted", short: "Difference", title: "Measured minus predicted" },
] as const;
export type Quantity = (typeof QUANTITIES)[number]["key"];

export class PartSurface {
  /** Three vertices each. */
  readonly triangles: Uint32Array;
  /** x, y, z of one vertex after the other, mm, frame of the program. */
  readonly xyz: Float32Array;
  /** x, y, z of one normal after the other, 127 for 1, and a fourth number that is 0. */
  readonly normals: Int8Array;
  /** The point of the path whose move made the surface; -1 of the stock. */
  readonly points: Int32Array;
  private readonly columns = new Map<string, Float32Array>();

  constructor(
    readonly about: PartHeader,
    bytes: ArrayBuffer,
    begin: number,
  ) {
    const starts = new Map<string, [number, number]>();
    let at = begin;
    for (const { key, components } of about.columns) {
      const count = components * (key === "triangles" ? about.triangles : about.vertices);
      starts.set(key, [at, count]);
      at += 4 * count;
    }
    if (at !== bytes.byteLength) throw new Error(`${bytes.byteLength} bytes in place of ${at}`);
    const of = (key: string): [number, number] => {
      const found = starts.get(key);
      if (!found) throw new Error(`the surface has no column ${key}`);
      if (key !== "normal") toNative(bytes, ...found);
      return found;
    };
    this.triangles = new Uint32Array(bytes, ...of("triangles"));
    this.xyz = new Float32Array(bytes, ...of("xyz_mm"));
    const [normals, count] = of("normal");
    this.normals = new Int8Array(bytes, normals, 4 * count);
    this.points = new Int32Array(bytes, ...of("point"));
    for (const { key } of QUANTITIES) if (starts.has(key)) this.columns.set(key, new Float32Array(bytes, ...of(key)));
    if (starts.has("u_um")) this.columns.set("u_um", new Float32Array(bytes, ...of("u_um")));
  }

  static read(bytes: ArrayBuffer): PartSurface {
    const length = bytes.byteLength < 4 ? NaN : new DataView(bytes).getUint32(0, true);
    if (!(4 + length <= bytes.byteLength)) throw new Error(`${bytes.byteLength} bytes without a header`);
    const about = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length))) as PartHeader;
    return new PartSurface(about, bytes, 4 + length);
  }

  /** Whether it is the finished part, with deviations. */
  get finished(): boolean {
    return this.about.part !== null;
  }

  /** One value for each vertex, NaN where it is not known; null where the surface has no such column. */
  column(key: Quantity | "u_um"): Float32Array | null {
    return this.columns.get(key) ?? null;
  }

  /** The quantities that it has. */
  get quantities(): (typeof QUANTITIES)[number][] {
    return QUANTITIES.filter(({ key }) => this.columns.has(key));
  }

  /** The range of colours on both sides of zero, µm: the same for all quantities, so that they can be compared. */
  get range_um(): number | null {
    const known = this.about.columns.map(({ range_um }) => range_um).filter((range) => range !== null);
    return known.length > 0 ? Math.max(...known) : null;
  }
}
