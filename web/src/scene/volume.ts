// A volume: its edges, and the translucent surface around all points within tolerance.

import * as THREE from "three";
import type { Scene } from "../types";
import { surfaceBelow } from "./surface";

type Box = NonNullable<Scene["box"]>;

export class VolumeView {
  readonly group = new THREE.Group();
  private readonly surface = new THREE.Mesh(
    new THREE.BufferGeometry(),
    new THREE.MeshStandardMaterial({ color: 0x21918c, transparent: true, opacity: 0.45, side: THREE.DoubleSide, roughness: 0.6, depthWrite: false }),
  );
  private readonly edges = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x6b7683 }));

  constructor() {
    this.group.add(this.surface, this.edges);
  }

  draw({ box, points }: Scene, tolerance_um: number): void {
    this.group.visible = box !== null;
    if (!box) return;
    const place = frame(box);
    this.edges.geometry.dispose();
    this.edges.geometry = new THREE.EdgesGeometry(new THREE.BoxGeometry(1, 1, 1).translate(0.5, 0.5, 0.5)).applyMatrix4(place);
    this.surface.visible = points !== null;
    if (!points) return;
    // The order of the points is not given: each is placed by its coordinates.
    const [nx, ny, nz] = box.counts;
    const values: (number | null)[] = Array<number | null>(nx * ny * nz).fill(null);
    const back = place.clone().invert();
    const at = new THREE.Vector3();
    points.xyz_mm.forEach((p, i) => {
      at.set(...p).applyMatrix4(back);
      const [x, y, z] = [at.x * (nx - 1), at.y * (ny - 1), at.z * (nz - 1)].map((v) => Math.round(Number.isFinite(v) ? v : 0));
      values[(z! * ny + y!) * nx + x!] = points.columns.in_plane_um[i] ?? null;
    });
    const mesh = surfaceBelow({ origin_mm: [0, 0, 0], step_mm: 1, counts: box.counts, values }, tolerance_um);
    this.surface.geometry.dispose();
    this.surface.geometry = new THREE.BufferGeometry()
      .setAttribute("position", new THREE.Float32BufferAttribute(mesh.positions, 3))
      .setIndex(mesh.index)
      .applyMatrix4(new THREE.Matrix4().makeScale(1 / Math.max(1, nx - 1), 1 / Math.max(1, ny - 1), 1 / Math.max(1, nz - 1)).premultiply(place));
    this.surface.geometry.computeVertexNormals();
  }

  extent(box: Box): THREE.Box3 {
    return new THREE.Box3(new THREE.Vector3(), new THREE.Vector3(1, 1, 1)).applyMatrix4(frame(box));
  }
}

/** From the unit cube to the box. */
function frame({ corner_mm, sides_mm }: Box): THREE.Matrix4 {
  // A side of no length would fold the space flat.
  const [x, y, z] = sides_mm.map((s, i) => (Math.hypot(...s) > 0 ? new THREE.Vector3(...s) : new THREE.Vector3().setComponent(i, 1e-3)));
  return new THREE.Matrix4().makeBasis(x!, y!, z!).setPosition(...corner_mm);
}
