// Paths and holes: a line through the points and a bead at each, coloured by the deviation there.

import * as THREE from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { ScenePoints } from "../types";
import { colourOf, type ShownLayer } from "./layers";
import { fat } from "./lines";

const MOST_BEADS = 4000;
/** A point so near to the pointer is under it. */
const NEAR_PX = 9;
/** More whiskers would be a sheet. */
const MOST_WHISKERS = 72;

export class PathView {
  readonly group = new THREE.Group();
  beads: THREE.InstancedMesh | null = null;
  /** x, y, z of all points, to find the one under the pointer where there are too many for beads. */
  private places = new Float32Array(0);

  /** `magnified`: mm drawn for 1 µm; 0 draws no deviation. */
  draw(points: ScenePoints, shown: ShownLayer, joined: boolean, magnified: number): void {
    this.clear();
    const colour = new THREE.Color();
    const values = shown.values(0);
    const colours = points.xyz_mm.map((_, i) => {
      const [r, g, b] = colourOf(shown, values[i] ?? null);
      return colour.setRGB(r, g, b, THREE.SRGBColorSpace).clone();
    });
    const n = points.xyz_mm.length;
    this.places = n > MOST_BEADS ? new Float32Array(points.xyz_mm.flat()) : new Float32Array(0);
    if (joined && n > 1) {
      const first = points.xyz_mm[0]!;
      const last = points.xyz_mm[n - 1]!;
      // A shape whose end is next to its start is closed.
      const gap = Math.hypot(...first.map((x, i) => x - last[i]!));
      const step = Math.hypot(...first.map((x, i) => x - points.xyz_mm[1]![i]!));
      const order = [...points.xyz_mm.keys(), ...(n > 3 && gap < 2.1 * step ? [0] : [])];
      const geometry = new LineGeometry();
      geometry.setPositions(order.flatMap((i) => points.xyz_mm[i]!));
      geometry.setColors(order.flatMap((i) => colours[i]!.toArray()));
      const line = new Line2(geometry, new LineMaterial({ vertexColors: true, linewidth: 7 }));
      line.frustumCulled = false;
      this.group.add(line);
    }
    const size = this.reach(points) * (joined ? 0.012 : 0.02);
    if (n <= MOST_BEADS) {
      this.beads = new THREE.InstancedMesh(new THREE.SphereGeometry(Math.max(3, Math.min(14, size)), 14, 10), new THREE.MeshBasicMaterial(), n);
      const matrix = new THREE.Matrix4();
      points.xyz_mm.forEach((p, i) => {
        this.beads!.setMatrixAt(i, matrix.makeTranslation(...p));
        this.beads!.setColorAt(i, colours[i]!);
      });
      this.beads.computeBoundingSphere();
      this.group.add(this.beads);
    }
    if (joined) this.outside(points);
    if (magnified > 0 && n <= MOST_BEADS) this.deviation(points, magnified, joined);
  }

  /** Where postures are outside joint limits: dashes over the line. */
  private outside({ xyz_mm, outside_joint_limits }: ScenePoints): void {
    const flagged = new Set(outside_joint_limits);
    const ends = xyz_mm.flatMap((p, i) => (i > 0 && (flagged.has(i) || flagged.has(i - 1)) ? [...xyz_mm[i - 1]!, ...p] : []));
    if (ends.length === 0) return;
    const line = fat({ width: 8, colour: 0x10151b, opacity: 0.9, dashed: true });
    line.geometry = new LineSegmentsGeometry().setPositions(ends);
    line.computeLineDistances();
    const length = Math.max(2, 0.02 * this.reach({ xyz_mm }));
    [line.material.dashSize, line.material.gapSize] = [length, length];
    line.material.depthTest = false;
    line.renderOrder = 3;
    line.visible = true;
    this.group.add(line);
  }

  /**
   * Where the tool goes in truth: from points all along an arrow without head, and a line through their ends. The line breaks
   * where another load case begins to decide and the end leaps.
   */
  private deviation(points: ScenePoints, magnified: number, joined: boolean): void {
    const every = Math.ceil(points.xyz_mm.length / MOST_WHISKERS);
    const ends = points.xyz_mm.map((p, i) => points.deviation_um[i]?.map((d, k) => p[k]! + d * magnified) ?? null);
    const whiskers: number[] = [];
    const rim: number[] = [];
    ends.forEach((end, i) => {
      if (!end) return;
      if (i % every === 0) whiskers.push(...points.xyz_mm[i]!, ...end);
      const before = ends[i - 1];
      const [d, d0] = [points.deviation_um[i]!, points.deviation_um[i - 1]];
      const leap = d0 ? Math.hypot(...d.map((v, k) => v - d0[k]!)) : Infinity;
      if (joined && before && leap < 0.4 * Math.hypot(...d)) rim.push(...before, ...end);
    });
    for (const [line, width, opacity] of [[whiskers, 1.3, 0.55], [rim, 2.2, 1]] as const) {
      const object = fat({ width, colour: 0xcc3fa0, opacity });
      object.visible = line.length > 0;
      if (line.length > 0) object.geometry = new LineSegmentsGeometry().setPositions(line);
      this.group.add(object);
    }
  }

  /** The point nearest to (x, y) in the picture, if it is within some pixels. */
  under(camera: THREE.Camera, x: number, y: number, width: number, height: number): number | null {
    const m = new THREE.Matrix4().multiplyMatrices(camera.matrixWorldInverse.clone().premultiply(camera.projectionMatrix), this.group.matrixWorld).elements;
    const at = this.places;
    let [best, least] = [-1, NEAR_PX * NEAR_PX];
    for (let i = 0; i < at.length; i += 3) {
      const [px, py, pz] = [at[i]!, at[i + 1]!, at[i + 2]!];
      const w = m[3]! * px + m[7]! * py + m[11]! * pz + m[15]!;
      if (w <= 0) continue;
      const dx = (((m[0]! * px + m[4]! * py + m[8]! * pz + m[12]!) / w + 1) * width) / 2 - x;
      const dy = ((1 - (m[1]! * px + m[5]! * py + m[9]! * pz + m[13]!) / w) * height) / 2 - y;
      const apart = dx * dx + dy * dy;
      if (apart < least) [best, least] = [i / 3, apart];
    }
    return best < 0 ? null : best;
  }

  clear(): void {
    for (const child of this.group.children) (child as THREE.Mesh).geometry.dispose();
    this.beads?.dispose();
    this.beads = null;
    this.group.clear();
  }

  private reach(points: Pick<ScenePoints, "xyz_mm">): number {
    const box = new THREE.Box3().setFromPoints(points.xyz_mm.map((p) => new THREE.Vector3(...p)));
    return box.getSize(new THREE.Vector3()).length() || 100;
  }
}
