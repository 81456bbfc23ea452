// The workpiece plate with the deviation map as colour, lines of equal deviation with their values, the tolerance as a
// strong line, and the region robustly within it as a dashed one. All of it is drawn in y', z': the position of the plate is
// the pose of its group, so that a moved plate is not rebuilt.

import * as THREE from "three";
import { trimmed } from "../format";
import type { Line, MapAnswer, MapGrid, MapLines, Plate, Vec3 } from "../types";
import { along, viridis, type Scale } from "./colour";
import type { Labels } from "./labels";
import { Lines } from "./lines";

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
  private readonly iso = new Lines({ width: 1.4, colour: 0xffffff, opacity: 0.75 });
  private readonly casing = new Lines({ width: 6.5, colour: 0x10151b, opacity: 0.85 });
  private readonly tolerance = new Lines({ width: 3.4, colour: 0xffffff, opacity: 1 });
  private readonly robust = new Lines({ width: 2, colour: 0xffffff, opacity: 0.95, dashed: true });
  private readonly largest = new Lines({ width: 2, colour: 0xffb14a, opacity: 1 });
  private readonly frame = new Lines({ width: 1.6, colour: 0x6b7683, opacity: 1 });
  private shape = "";
  private grid: MapGrid | null = null;

  constructor(private readonly labels: Labels, private readonly name: string) {
    this.surface = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 }));
    this.group.add(this.surface, ...[this.frame, this.iso, this.casing, this.tolerance, this.robust, this.largest].map((lines) => lines.object));
    this.group.matrixAutoUpdate = false;
    this.casing.object.renderOrder = 1;
    this.tolerance.object.renderOrder = 2;
    this.robust.object.renderOrder = 2;
  }

  draw(map: MapAnswer, plate: Plate, scale: Scale, lines: MapLines, options: { certainty: boolean; rectangle: boolean }): void {
    this.moveTo(plate);
    this.build(map.grid);
    this.surface.visible = true;
    this.colour(map.grid, scale);
    this.iso.draw(lines.levels.flatMap((level) => level.lines_mm));
    this.casing.draw(lines.tolerance_mm);
    this.tolerance.draw(lines.tolerance_mm);
    this.robust.draw(options.certainty && map.certainty ? map.certainty.boundary_robust_mm : []);
    this.labels.group(this.name);
    const corners = options.rectangle ? map.region.rectangle_mm : null;
    this.largest.draw(corners ? [rectangle(...corners)] : []);
    this.tag(lines.tolerance_mm, `tolerance ${trimmed(map.setting.tolerance_um, 1)} µm`, "limit-tag", 1);
    for (const { level_um, lines_mm } of lines.levels) this.tag(lines_mm, trimmed(level_um, 1), "iso", 2);
  }

  /** Only its edges: a plane other than the one shown. */
  outline(map: MapAnswer, plate: Plate): void {
    this.moveTo(plate);
    this.build(map.grid);
    for (const part of [this.iso, this.casing, this.tolerance, this.robust, this.largest]) part.object.visible = false;
    this.surface.visible = false;
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

  private colour(grid: MapGrid, scale: Scale): void {
    const colours = this.surface.geometry.getAttribute("color") as THREE.BufferAttribute;
    const to = colours.array as Float32Array;
    const values = grid.in_plane_um;
    for (let i = 0; i < values.length; i++) {
      const value = values[i]!;
      const at = value === null ? STEPS : Math.round((STEPS - 1) * Math.min(1, Math.max(0, along(scale, value))));
      for (let k = 0; k < 3; k++) to[3 * i + k] = TABLE[3 * at + k]!;
    }
    colours.needsUpdate = true;
  }

  /** Words at the middle of the longest lines. */
  private tag(lines: Line[], text: string, kind: string, most: number): void {
    const long = lines.filter((line) => line.length > 9).sort((a, b) => b.length - a.length);
    for (const line of long.slice(0, most)) this.labels.add(this.name, this.point(...line[Math.floor(line.length / 2)]!), text, kind);
  }
}

const rectangle = ([y0, z0]: [number, number], [y1, z1]: [number, number]): Line => [[y0, z0], [y1, z0], [y1, z1], [y0, z1], [y0, z0]];
