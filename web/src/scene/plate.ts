// The workpiece plate with the deviation map as colour, lines of equal deviation with their values, the limit as a
// strong line, and what of it is sure as a dashed one.

import * as THREE from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { trimmed } from "../format";
import type { MapAnswer, MapGrid, Plate, Vec3 } from "../types";
import { along, viridis, type Scale } from "./colour";
import { contour, type Line } from "./contour";
import type { Labels } from "./labels";

const vector = (v: Vec3): THREE.Vector3 => new THREE.Vector3(v[0], v[1], v[2]);

// The colour map once, in the light's own linear numbers; the last entry is for points without value.
const STEPS = 1024;
const TABLE = new Float32Array(3 * (STEPS + 1));
for (let i = 0; i <= STEPS; i++) {
  const [r, g, b] = i === STEPS ? [0.55, 0.58, 0.62] : viridis(i / (STEPS - 1));
  new THREE.Color().setRGB(r!, g!, b!, THREE.SRGBColorSpace).toArray(TABLE, 3 * i);
}

export class PlateView {
  readonly group = new THREE.Group();
  readonly surface: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  private readonly iso = fat(1.4, 0xffffff, 0.75);
  private readonly casing = fat(6.5, 0x10151b, 0.85);
  private readonly limit = fat(3.4, 0xffffff, 1);
  private readonly sure = fat(2, 0xffffff, 0.95, true);
  private readonly largest = fat(2, 0xffb14a, 1);
  private readonly frame = fat(1.6, 0x6b7683, 1);
  private shape = "";
  private plate: Plate | null = null;
  private grid: MapGrid | null = null;

  constructor(private readonly labels: Labels, private readonly name: string) {
    this.surface = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 }));
    this.group.add(this.surface, this.frame, this.iso, this.casing, this.limit, this.sure, this.largest);
    this.casing.renderOrder = 1;
    this.limit.renderOrder = 2;
    this.sure.renderOrder = 2;
  }

  draw(map: MapAnswer, plate: Plate, scale: Scale, options: { lines: boolean; certainty: boolean; rectangle: boolean }): void {
    this.plate = plate;
    this.grid = map.grid;
    this.build(map.grid, plate);
    this.surface.visible = true;
    this.colour(map.grid, scale);
    const grid = { y_mm: map.grid.y_mm, z_mm: map.grid.z_mm, values: map.grid.in_plane_um };
    const levels = scale.levels.filter((level) => Math.abs(level - map.setting.limit_um) > 1e-6);
    const lines = levels.map((level) => ({ level, lines: contour(grid, level) }));
    const bound = contour(grid, map.setting.limit_um);
    this.trace(this.iso, options.lines ? lines.flatMap((l) => l.lines) : []);
    this.trace(this.casing, bound);
    this.trace(this.limit, bound);
    this.trace(this.sure, options.certainty && map.certainty ? map.certainty.boundary_surely_mm : []);
    this.labels.group(this.name);
    const corners = options.rectangle ? map.region.rectangle_mm : null;
    this.trace(this.largest, corners ? [rectangle(...corners)] : []);
    this.tag(bound, `limit ${trimmed(map.setting.limit_um, 1)} µm`, "limit-tag", 1);
    for (const { level, lines: at } of options.lines ? lines : []) this.tag(at, trimmed(level, 1), "iso", 2);
  }

  /** Its edges alone: a plane beside the one that is shown. */
  outline(map: MapAnswer, plate: Plate): void {
    this.plate = plate;
    this.grid = map.grid;
    this.build(map.grid, plate);
    for (const part of [this.iso, this.casing, this.limit, this.sure, this.largest]) part.visible = false;
    this.surface.visible = false;
    this.labels.group(this.name);
  }

  hide(): void {
    this.group.visible = false;
    this.labels.group(this.name);
  }

  /** y', z' of a place on the plate. */
  place(at: THREE.Vector3): [number, number] {
    const from = at.clone().sub(vector(this.plate!.centre_mm));
    return [from.dot(vector(this.plate!.y_axis)), from.dot(vector(this.plate!.z_axis))];
  }

  /** The grid point that is nearest to (y', z'). */
  nearest(y: number, z: number): number {
    const next = (list: number[], to: number) => list.reduce((best, v, i) => (Math.abs(v - to) < Math.abs(list[best]! - to) ? i : best), 0);
    return next(this.grid!.z_mm, z) * this.grid!.y_mm.length + next(this.grid!.y_mm, y);
  }

  private point(y: number, z: number): THREE.Vector3 {
    const p = this.plate!;
    return vector(p.centre_mm).addScaledVector(vector(p.y_axis), y).addScaledVector(vector(p.z_axis), z);
  }

  private build(grid: MapGrid, plate: Plate): void {
    const key = JSON.stringify([grid.y_mm.length, grid.z_mm.length, grid.y_mm[0], grid.z_mm[0], plate.centre_mm, plate.normal_axis, plate.y_axis]);
    this.group.visible = true;
    if (key === this.shape) return;
    this.shape = key;
    const [columns, rows] = [grid.y_mm.length, grid.z_mm.length];
    const positions = new Float32Array(columns * rows * 3);
    let n = 0;
    for (const z of grid.z_mm) for (const y of grid.y_mm) this.point(y, z).toArray(positions, 3 * n++);
    const index: number[] = [];
    for (let r = 0; r + 1 < rows; r++)
      for (let c = 0; c + 1 < columns; c++) {
        const a = r * columns + c;
        index.push(a, a + 1, a + columns, a + 1, a + columns + 1, a + columns);
      }
    const geometry = this.surface.geometry;
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(columns * rows * 3), 3));
    geometry.setIndex(index);
    geometry.computeBoundingSphere();
    geometry.computeBoundingBox();
    const [y0, y1, z0, z1] = [grid.y_mm[0]!, grid.y_mm.at(-1)!, grid.z_mm[0]!, grid.z_mm.at(-1)!];
    this.trace(this.frame, [[[y0, z0], [y1, z0], [y1, z1], [y0, z1], [y0, z0]]]);
  }

  private colour(grid: MapGrid, scale: Scale): void {
    const colours = this.surface.geometry.getAttribute("color") as THREE.BufferAttribute;
    const to = colours.array as Float32Array;
    grid.in_plane_um.forEach((value, i) => {
      const at = value === null ? STEPS : Math.round((STEPS - 1) * Math.min(1, Math.max(0, along(scale, value))));
      for (let k = 0; k < 3; k++) to[3 * i + k] = TABLE[3 * at + k]!;
    });
    colours.needsUpdate = true;
  }

  private trace(object: LineSegments2, lines: Line[]): void {
    const { centre_mm: o, y_axis: u, z_axis: v } = this.plate!;
    const points: number[] = [];
    for (const line of lines)
      for (let i = 1; i < line.length; i++)
        for (const [y, z] of [line[i - 1]!, line[i]!]) points.push(o[0] + y * u[0] + z * v[0], o[1] + y * u[1] + z * v[1], o[2] + y * u[2] + z * v[2]);
    object.visible = points.length > 0;
    if (points.length === 0) return;
    object.geometry.dispose();
    object.geometry = new LineSegmentsGeometry().setPositions(points);
    object.computeLineDistances();
  }

  /** Words at the middle of the longest lines. */
  private tag(lines: Line[], text: string, kind: string, most: number): void {
    const long = lines.filter((line) => line.length > 9).sort((a, b) => b.length - a.length);
    for (const line of long.slice(0, most)) this.labels.add(this.name, this.point(...line[Math.floor(line.length / 2)]!), text, kind);
  }
}

const rectangle = ([y0, z0]: [number, number], [y1, z1]: [number, number]): Line => [[y0, z0], [y1, z0], [y1, z1], [y0, z1], [y0, z0]];

export function fat(width: number, colour: number, opacity: number, dashed = false): LineSegments2 {
  const material = new LineMaterial({ color: colour, linewidth: width, transparent: true, opacity, dashed, dashSize: 14, gapSize: 10, depthWrite: false });
  const object = new LineSegments2(new LineSegmentsGeometry(), material);
  object.visible = false;
  object.frustumCulled = false;
  return object;
}
