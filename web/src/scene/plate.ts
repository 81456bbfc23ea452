// The workpiece plate with the deviation map as colour, lines of equal deviation with their values, the tolerance as a
// strong line, and the region robustly within it as a dashed one. All of it is drawn in y', z': the position of the plate is
// the pose of its group, so that a moved plate is not rebuilt.

import * as THREE from "three";
import { trimmed } from "../format";
import type { Line, MapAnswer, MapGrid, Plate, Vec3 } from "../types";
import { along, type Rgb } from "./colour";
import { Hatch } from "./hatch";
import type { Labels } from "./labels";
import { COLLISION, colourOf, levelText, type ShownLayer } from "./layers";
import { Lines } from "./lines";

const vector = (v: Vec3): THREE.Vector3 => new THREE.Vector3(v[0], v[1], v[2]);

/** Colours of a scale are computed once, in the light's own linear numbers. */
const STEPS = 1024;

const linear = (colours: Rgb[]): Float32Array => {
  const to = new Float32Array(3 * colours.length);
  colours.forEach(([r, g, b], i) => new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace).toArray(to, 3 * i));
  return to;
};
const NONE = linear([[0.55, 0.58, 0.62]]);
const COLLIDES = linear([COLLISION]);
/** Sizes have one table, since each scale has the same colours; names have one entry each. */
const SIZES = { layer: { named: false }, scale: [0, 1], names: [] } as unknown as ShownLayer;
const OF_SIZES = linear(Array.from({ length: STEPS }, (_, i) => colourOf(SIZES, i / (STEPS - 1))));
const DIFFERENCES = { ...SIZES, layer: { diverging: true } } as unknown as ShownLayer;
const OF_DIFFERENCES = linear(Array.from({ length: STEPS }, (_, i) => colourOf(DIFFERENCES, i / (STEPS - 1))));
const tableOf = (shown: ShownLayer): Float32Array => (shown.layer.named ? linear(shown.names.map((_, i) => colourOf(shown, i))) : shown.layer.diverging ? OF_DIFFERENCES : OF_SIZES);

export class PlateView {
  readonly group = new THREE.Group();
  readonly surface: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  private readonly iso = new Lines({ width: 1.4, colour: 0xffffff, opacity: 0.75 });
  private readonly casing = new Lines({ width: 6.5, colour: 0x10151b, opacity: 0.85 });
  private readonly tolerance = new Lines({ width: 3.4, colour: 0xffffff, opacity: 1 });
  private readonly robust = new Lines({ width: 2, colour: 0xffffff, opacity: 0.95, dashed: true });
  private readonly largest = new Lines({ width: 2, colour: 0xffb14a, opacity: 1 });
  private readonly frame = new Lines({ width: 1.6, colour: 0x6b7683, opacity: 1 });
  private readonly hatch = new Hatch();
  private shape = "";
  private grid: MapGrid | null = null;

  constructor(private readonly labels: Labels, private readonly name: string) {
    this.surface = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 }));
    this.group.add(this.surface, this.hatch.mesh, ...[this.frame, this.iso, this.casing, this.tolerance, this.robust, this.largest].map((lines) => lines.object));
    this.group.matrixAutoUpdate = false;
    this.casing.object.renderOrder = 1;
    this.tolerance.object.renderOrder = 2;
    this.robust.object.renderOrder = 2;
  }

  /** `index`: of the map in the answer; `tolerance_mm`: the lines where the in-plane deviation is the tolerance. */
  draw(map: MapAnswer, plate: Plate, shown: ShownLayer, index: number, tolerance_mm: Line[], options: { certainty: boolean; rectangle: boolean }): void {
    this.moveTo(plate);
    this.build(map.grid);
    this.surface.visible = true;
    this.colour(shown, index, pointsOf(map.grid, "in_collision"));
    this.hatch.draw(this.surface.geometry, outsideLimits(map.grid), this.size);
    const lines = shown.lines(index);
    const tolerance = shown.layer.tolerance ? tolerance_mm : [];
    this.iso.draw(lines.flatMap((level) => level.lines_mm));
    this.casing.draw(tolerance);
    this.tolerance.draw(tolerance);
    this.robust.draw(options.certainty && shown.layer.tolerance && map.certainty ? map.certainty.boundary_robust_mm : []);
    this.labels.group(this.name);
    const corners = options.rectangle ? map.region.rectangle_mm : null;
    this.largest.draw(corners ? [rectangle(...corners)] : []);
    this.tag(tolerance, `tolerance ${trimmed(map.setting.tolerance_um, 1)} µm`, "limit-tag", 1);
    for (const { level, lines_mm } of lines) this.tag(lines_mm, levelText(shown.layer, level), "iso", 2);
  }

  /** Only its edges: a plane other than the one shown. */
  outline(map: MapAnswer, plate: Plate): void {
    this.moveTo(plate);
    this.build(map.grid);
    for (const part of [this.iso, this.casing, this.tolerance, this.robust, this.largest]) part.object.visible = false;
    this.surface.visible = this.hatch.mesh.visible = false;
    this.labels.group(this.name);
  }

  hide(): void {
    this.group.visible = false;
    this.labels.group(this.name);
  }

  /** y', z' of a place on the plate. */
  place(at: THREE.Vector3): [number, number] {
    const { x, y } = this.group.worldToLocal(at.clone());
    return [x, y];
  }

  /** The grid point that is nearest to (y', z'). */
  nearest(y: number, z: number): number {
    const next = (list: number[], to: number) => list.reduce((best, v, i) => (Math.abs(v - to) < Math.abs(list[best]! - to) ? i : best), 0);
    return next(this.grid!.z_mm, z) * this.grid!.y_mm.length + next(this.grid!.y_mm, y);
  }

  private get size(): number {
    const { y_mm, z_mm } = this.grid!;
    return Math.hypot(y_mm.at(-1)! - y_mm[0]!, z_mm.at(-1)! - z_mm[0]!);
  }

  private point(y: number, z: number): THREE.Vector3 {
    return new THREE.Vector3(y, z, 0).applyMatrix4(this.group.matrix);
  }

  private moveTo({ centre_mm, y_axis, z_axis }: Plate): void {
    const [y, z] = [vector(y_axis), vector(z_axis)];
    this.group.visible = true;
    this.group.matrix.makeBasis(y, z, y.clone().cross(z)).setPosition(...centre_mm);
    this.group.updateMatrixWorld(true);
  }

  private build(grid: MapGrid): void {
    this.grid = grid;
    const [columns, rows] = [grid.y_mm.length, grid.z_mm.length];
    const [y0, y1, z0, z1] = [grid.y_mm[0]!, grid.y_mm.at(-1)!, grid.z_mm[0]!, grid.z_mm.at(-1)!];
    const key = JSON.stringify([columns, rows, y0, y1, z0, z1]);
    if (key === this.shape) return;
    this.shape = key;
    const positions = new Float32Array(columns * rows * 3);
    let n = 0;
    for (const z of grid.z_mm) for (const y of grid.y_mm) positions.set([y, z, 0], 3 * n++);
    const index: number[] = [];
    for (let r = 0; r + 1 < rows; r++)
      for (let c = 0; c + 1 < columns; c++) {
        const a = r * columns + c;
        index.push(a, a + 1, a + columns, a + 1, a + columns + 1, a + columns);
      }
    this.surface.geometry.dispose();
    const geometry = (this.surface.geometry = new THREE.BufferGeometry());
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(columns * rows * 3), 3));
    geometry.setIndex(index);
    geometry.computeBoundingSphere();
    geometry.computeBoundingBox();
    this.frame.draw([rectangle([y0, z0], [y1, z1])]);
  }

  private colour(shown: ShownLayer, index: number, in_collision: number[]): void {
    const colours = this.surface.geometry.getAttribute("color") as THREE.BufferAttribute;
    const to = colours.array as Float32Array;
    const values = shown.values(index);
    const { scale } = shown;
    const table = tableOf(shown);
    const last = table.length / 3 - 1;
    for (let i = 0; i < values.length; i++) {
      const value = values[i]!;
      const at = value === null ? -1 : scale ? Math.round(last * Math.min(1, Math.max(0, along(scale, value)))) : Math.min(last, value);
      const from = at < 0 ? NONE : table;
      const start = at < 0 ? 0 : 3 * at;
      for (let k = 0; k < 3; k++) to[3 * i + k] = from[start + k]!;
    }
    for (const i of in_collision) if (values[i] === null) to.set(COLLIDES, 3 * i);
    colours.needsUpdate = true;
  }

  /** Words at the middle of the longest lines. */
  private tag(lines: Line[], text: string, kind: string, most: number): void {
    const long = lines.filter((line) => line.length > 9).sort((a, b) => b.length - a.length);
    for (const line of long.slice(0, most)) this.labels.add(this.name, this.point(...line[Math.floor(line.length / 2)]!), text, kind);
  }
}

const rectangle = ([y0, z0]: [number, number], [y1, z1]: [number, number]): Line => [[y0, z0], [y1, z0], [y1, z1], [y0, z1], [y0, z0]];

/** Points with this flag. */
export const pointsOf = (grid: MapGrid, reason: string): number[] => grid.flags.find((flag) => flag.reason === reason)?.points ?? [];

/** Points with a posture outside joint limits. */
export const outsideLimits = (grid: MapGrid): number[] => pointsOf(grid, "outside_joint_limits");
