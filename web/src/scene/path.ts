// Paths and holes: a line through the points and a bead at each, coloured by the deviation there.

import * as THREE from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import type { ScenePoints } from "../types";
import { along, viridis, type Scale } from "./colour";

const MOST_BEADS = 4000;

export class PathView {
  readonly group = new THREE.Group();
  beads: THREE.InstancedMesh | null = null;
  private line: Line2 | null = null;

  draw(points: ScenePoints, scale: Scale, joined: boolean): void {
    this.clear();
    const colour = new THREE.Color();
    const colours = points.in_plane_um.map((value) => {
      const [r, g, b] = value === null ? [0.55, 0.58, 0.62] : viridis(along(scale, value));
      return colour.setRGB(r!, g!, b!, THREE.SRGBColorSpace).clone();
    });
    const n = points.xyz_mm.length;
    if (joined && n > 1) {
      const first = points.xyz_mm[0]!;
      const last = points.xyz_mm[n - 1]!;
      // A shape that ends beside its beginning is closed.
      const gap = Math.hypot(...first.map((x, i) => x - last[i]!));
      const step = Math.hypot(...first.map((x, i) => x - points.xyz_mm[1]![i]!));
      const order = [...points.xyz_mm.keys(), ...(n > 3 && gap < 2.1 * step ? [0] : [])];
      const geometry = new LineGeometry();
      geometry.setPositions(order.flatMap((i) => points.xyz_mm[i]!));
      geometry.setColors(order.flatMap((i) => colours[i]!.toArray()));
      this.line = new Line2(geometry, new LineMaterial({ vertexColors: true, linewidth: 7 }));
      this.line.frustumCulled = false;
      this.group.add(this.line);
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
  }

  clear(): void {
    this.line?.geometry.dispose();
    this.beads?.dispose();
    this.line = null;
    this.beads = null;
    this.group.clear();
  }

  private reach(points: ScenePoints): number {
    const box = new THREE.Box3().setFromPoints(points.xyz_mm.map((p) => new THREE.Vector3(...p)));
    return box.getSize(new THREE.Vector3()).length() || 100;
  }
}
