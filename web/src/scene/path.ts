// Paths and holes: a line through the points and a bead at each, coloured by the deviation there.

import * as THREE from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { ScenePoints } from "../types";
import { along, viridis, type Scale } from "./colour";
import { fat } from "./lines";

const MOST_BEADS = 4000;
/** More whiskers would be a sheet. */
const MOST_WHISKERS = 72;

export class PathView {
  readonly group = new THREE.Group();
  beads: THREE.InstancedMesh | null = null;

  /** `magnified`: mm drawn for 1 µm; 0 draws no deviation. */
  draw(points: ScenePoints, scale: Scale, joined: boolean, magnified: number): void {
    this.clear();
    const colour = new THREE.Color();
    const colours = points.columns.in_plane_um.map((value) => {
      const [r, g, b] = value === null ? [0.55, 0.58, 0.62] : viridis(along(scale, value));
      return colour.setRGB(r!, g!, b!, THREE.SRGBColorSpace).clone();
    });
    const n = points.xyz_mm.length;
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
    if (magnified > 0 && n <= MOST_BEADS) this.deviation(points, magnified, joined);
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

  clear(): void {
    for (const child of this.group.children) (child as THREE.Mesh).geometry.dispose();
    this.beads?.dispose();
    this.beads = null;
    this.group.clear();
  }

  private reach(points: ScenePoints): number {
    const box = new THREE.Box3().setFromPoints(points.xyz_mm.map((p) => new THREE.Vector3(...p)));
    return box.getSize(new THREE.Vector3()).length() || 100;
  }
}
