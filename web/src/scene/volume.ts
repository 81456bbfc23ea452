// A box of space: its edges, and the surface about all points that hold the limit, translucent.

import * as THREE from "three";
import type { Scene } from "../types";
import { surfaceBelow } from "./surface";

export class VolumeView {
  readonly group = new THREE.Group();
  private readonly surface = new THREE.Mesh(
    new THREE.BufferGeometry(),
    new THREE.MeshStandardMaterial({ color: 0x21918c, transparent: true, opacity: 0.42, side: THREE.DoubleSide, roughness: 0.6, depthWrite: false }),
  );
  private edges: THREE.LineSegments | null = null;

  constructor() {
    this.group.add(this.surface);
  }

  draw(scene: Scene, limit_um: number): void {
    this.group.visible = scene.box !== null || !!scene.volume;
    if (!this.group.visible) return;
    const box = this.box(scene);
    this.edges?.geometry.dispose();
    if (this.edges) this.group.remove(this.edges);
    const size = box.getSize(new THREE.Vector3());
    const centre = box.getCenter(new THREE.Vector3());
    const geometry = new THREE.EdgesGeometry(new THREE.BoxGeometry(size.x, size.y, size.z).translate(centre.x, centre.y, centre.z));
    this.edges = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0x6b7683 }));
    this.group.add(this.edges);
    this.surface.visible = !!scene.volume;
    if (!scene.volume) return;
    const { origin_mm, step_mm, counts, in_plane_um } = scene.volume;
    const mesh = surfaceBelow({ origin_mm, step_mm, counts, values: in_plane_um }, limit_um);
    this.surface.geometry.dispose();
    this.surface.geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(mesh.positions, 3)).setIndex(mesh.index);
    this.surface.geometry.computeVertexNormals();
  }

  box(scene: Scene): THREE.Box3 {
    const { box, volume } = scene;
    const corners = box?.corners_mm ?? (box?.min_mm && box.max_mm ? [box.min_mm, box.max_mm] : []);
    const found = new THREE.Box3().setFromPoints(corners.map((c) => new THREE.Vector3(...c)));
    if (volume && found.isEmpty()) {
      const low = new THREE.Vector3(...volume.origin_mm);
      found.set(low, low.clone().add(new THREE.Vector3(...volume.counts).subScalar(1).multiplyScalar(volume.step_mm)));
    }
    return found;
  }
}
