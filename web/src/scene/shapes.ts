// CAD meshes of the robot file, each at the pose given by the server. They are fetched once
// a robot; until all are there, and if one is not a mesh, the arm is drawn from its chain.

import * as THREE from "three";
import { STLLoader } from "three/addons/loaders/STLLoader.js";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import type { DrawnMesh } from "../types";

const MATERIAL = new THREE.MeshStandardMaterial({ color: 0xcdd4dd, roughness: 0.45, metalness: 0.2, side: THREE.DoubleSide });
const FOOT = new THREE.MeshStandardMaterial({ color: 0x4a5562, roughness: 0.5, metalness: 0.35, side: THREE.DoubleSide });
/** Edges sharper than this stay sharp, rad. */
const CREASE = 0.5;
/** More triangles than this are drawn as they come: rounding them takes too long. */
const MOST_ROUNDED = 200_000;

export class Shapes {
  readonly group = new THREE.Group();
  private readonly known = new Map<string, THREE.BufferGeometry | "coming" | "none">();
  private robot = "";

  /** `fetched`: the bytes of a mesh; `ready`: one more is there. */
  constructor(private readonly fetched: (file: string) => Promise<ArrayBuffer>, private readonly ready: () => void) {}

  /** Draws the robot in its own shape; false where that cannot be, or not yet. */
  draw(robot: string, meshes: DrawnMesh[]): boolean {
    if (robot !== this.robot) this.forget(robot);
    for (const { file } of meshes) if (!this.known.has(file)) void this.load(file);
    const all = meshes.map(({ file }) => this.known.get(file));
    this.group.visible = meshes.length > 0 && all.every((geometry) => geometry instanceof THREE.BufferGeometry);
    if (!this.group.visible) return false;
    while (this.group.children.length > meshes.length) this.group.remove(this.group.children.at(-1)!);
    meshes.forEach((mesh, i) => {
      const shape = (this.group.children[i] as THREE.Mesh | undefined) ?? this.made();
      shape.geometry = all[i] as THREE.BufferGeometry;
      shape.material = i === 0 ? FOOT : MATERIAL;
      shape.position.set(...mesh.xyz_mm);
      const [w, x, y, z] = mesh.quaternion_wxyz;
      shape.quaternion.set(x, y, z, w);
      shape.scale.set(...mesh.scale_mm);
    });
    return true;
  }

  /** Whether a mesh is still to come. */
  get loading(): boolean {
    return [...this.known.values()].includes("coming");
  }

  ghost(on: boolean): void {
    for (const material of [MATERIAL, FOOT]) {
      if (material.transparent === on) continue;
      material.transparent = on;
      material.opacity = on ? 0.12 : 1;
      material.depthWrite = !on;
      material.needsUpdate = true;
    }
  }

  private made(): THREE.Mesh {
    const mesh = new THREE.Mesh(undefined, MATERIAL);
    this.group.add(mesh);
    return mesh;
  }

  private forget(robot: string): void {
    this.robot = robot;
    this.group.clear();
    for (const geometry of this.known.values()) if (geometry instanceof THREE.BufferGeometry) geometry.dispose();
    this.known.clear();
  }

  private async load(file: string): Promise<void> {
    const of = this.robot;
    this.known.set(file, "coming");
    let found: THREE.BufferGeometry | "none" = "none";
    try {
      found = meshOf(await this.fetched(file));
    } catch {
      // Not there, or not a mesh: the arm is drawn from its chain.
    }
    if (of !== this.robot) return;
    this.known.set(file, found);
    this.ready();
  }
}

/** The mesh in these bytes, STL as text or in binary. */
export function meshOf(bytes: ArrayBuffer): THREE.BufferGeometry {
  const geometry = new STLLoader().parse(bytes);
  geometry.computeBoundingSphere();
  const count = geometry.getAttribute("position")?.count ?? 0;
  if (count === 0 || !Number.isFinite(geometry.boundingSphere?.radius)) throw new Error("no mesh");
  return count / 3 > MOST_ROUNDED ? geometry : toCreasedNormals(geometry, CREASE);
}
