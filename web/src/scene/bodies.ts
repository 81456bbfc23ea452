// The bodies of the cell: obstacles and capsules of links translucent, the part less so, holder and cutter solid. Two that are nearer
// than demanded are red.

import * as THREE from "three";
import type { Body, BodyPose, BodyRole, CellScene, DrawnCell } from "../types";
import type { BodyMeshes } from "./body-meshes";
import { geometryOf } from "./body-shape";

interface Paint {
  colour: number;
  opacity: number;
}
const PAINTS: Record<BodyRole, Paint> = {
  obstacle: { colour: 0x8793a1, opacity: 0.3 },
  part: { colour: 0xb7a78c, opacity: 0.5 },
  holder: { colour: 0x7f8b98, opacity: 1 },
  cutter: { colour: 0xe8792b, opacity: 1 },
  link: { colour: 0x6f8fb5, opacity: 0.16 },
};
const RED = 0xd0312d;
/** Translucent bodies that are red are seen more clearly. */
const RED_OPACITY = 0.42;
/** All but the part in the view of the plate. */
const GHOST = 0.12;
/** Edges between faces that differ by more than this are drawn, degrees. */
const EDGE_DEG = 30;
/** Of larger meshes neither edges are drawn nor triangles searched under the pointer. */
const MOST_TRIANGLES = 40_000;
/** Translucent bodies in the order of drawing. */
const ORDER: Record<BodyRole, number> = { part: 1, obstacle: 2, link: 3, holder: 0, cutter: 0 };

interface Drawn {
  body: Body;
  shape: string;
  triangles: THREE.BufferGeometry | null;
  solid: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  edges: THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  red: boolean;
}

export class Bodies {
  readonly group = new THREE.Group();
  private cell: CellScene | null = null;
  private arm: Drawn[] = [];
  private still: Drawn[] = [];

  constructor(private readonly meshes: BodyMeshes) {}

  /** The bodies that stand still; `part`: where the part of the section shown is. */
  drawStill(cell: CellScene | null, part: BodyPose | null): void {
    this.cell = cell;
    const all = [...(cell?.arm ?? []), ...(cell?.still ?? []).map(({ body }) => body)];
    this.meshes.keep(new Set(all.flatMap(({ shape }) => (shape.kind === "mesh" ? [shape.key] : []))));
    this.still = this.made(this.still, cell?.still.map(({ body }) => body) ?? []);
    this.still.forEach((drawn, i) => place(drawn, (drawn.body.role === "part" && part) || cell!.still[i]!.pose));
  }

  /** The bodies of the arm in a posture, those of links only if `links`; `near`: names of two that are too near. */
  drawArm(drawn: DrawnCell | null, links: boolean, near: string[]): void {
    const bodies = drawn && this.cell?.arm.length === drawn.bodies.length ? this.cell.arm : [];
    const seen = ({ role, name }: Body) => role !== "link" || links || near.includes(name);
    this.arm = this.made(this.arm, bodies, seen);
    this.arm.forEach((each, i) => {
      place(each, drawn!.bodies[i]!);
      each.solid.visible = each.edges.visible = seen(each.body);
    });
    for (const each of [...this.arm, ...this.still]) paint(each, near.includes(each.body.name));
  }

  /** Whether there is a body of the tool with this role. */
  has(role: BodyRole): boolean {
    return this.cell?.arm.some((body) => body.role === role) ?? false;
  }

  /** The part of the cell; hidden where the machined part is in its place. */
  withPart(shown: boolean): void {
    for (const { body, solid, edges } of this.still) if (body.role === "part") solid.visible = edges.visible = shown;
  }

  /** Faint, where objects behind the arm matter more. */
  ghost(on: boolean): void {
    for (const { body, solid, edges, red } of [...this.arm, ...this.still]) {
      if (body.role === "part") continue;
      shine(solid.material, on ? GHOST : opacityOf(body, red));
      edges.material.opacity = on ? GHOST : edgesOf(body);
    }
  }

  /** The first body on the ray. */
  under(caster: THREE.Raycaster): Body | null {
    if (!this.group.visible) return null;
    const all = [...this.still, ...this.arm].filter(({ solid }) => solid.visible && count(solid.geometry) <= MOST_TRIANGLES);
    const hit = caster.intersectObjects(all.map(({ solid }) => solid), false)[0];
    return all.find(({ solid }) => solid === hit?.object)?.body ?? null;
  }

  /** The box around what stands still. */
  get extent(): THREE.Box3 {
    const box = new THREE.Box3();
    for (const { solid } of this.still) box.expandByObject(solid);
    return box;
  }

  /** Meshes are requested only if they are seen. */
  private made(before: Drawn[], bodies: Body[], seen: (body: Body) => boolean = () => true): Drawn[] {
    for (const gone of before.splice(bodies.length)) this.remove(gone);
    return bodies.map((body, i) => {
      const key = JSON.stringify(body);
      const triangles = body.shape.kind === "mesh" && seen(body) ? this.meshes.of(body.shape.key) : null;
      const old = before[i];
      if (old && old.shape === key && old.triangles === triangles) return old;
      if (old) this.remove(old);
      const geometry = triangles ?? geometryOf(body.shape);
      const solid = new THREE.Mesh(geometry, material());
      const sharp = count(geometry) <= MOST_TRIANGLES && body.role !== "link";
      const edges = new THREE.LineSegments(sharp ? new THREE.EdgesGeometry(geometry, EDGE_DEG) : new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ transparent: true, depthWrite: false }));
      solid.renderOrder = ORDER[body.role];
      this.group.add(solid, edges);
      const drawn: Drawn = { body, shape: key, triangles, solid, edges, red: false };
      paint(drawn, false);
      return drawn;
    });
  }

  private remove({ solid, edges, triangles }: Drawn): void {
    this.group.remove(solid, edges);
    // Triangles are kept with their key.
    if (!triangles) solid.geometry.dispose();
    edges.geometry.dispose();
    solid.material.dispose();
    edges.material.dispose();
  }
}

/** Behind a plate in the same plane. */
const material = (): THREE.MeshStandardMaterial => new THREE.MeshStandardMaterial({ roughness: 0.55, metalness: 0.1, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 4 });

const count = (geometry: THREE.BufferGeometry): number => (geometry.index?.count ?? geometry.getAttribute("position")?.count ?? 0) / 3;

/** The frame at this position. */
export function matrixOf({ xyz_mm, quaternion_wxyz: [w, x, y, z] }: BodyPose): THREE.Matrix4 {
  return new THREE.Matrix4().compose(new THREE.Vector3(...xyz_mm), new THREE.Quaternion(x, y, z, w), new THREE.Vector3(1, 1, 1));
}

function place({ solid, edges }: Drawn, { xyz_mm, quaternion_wxyz: [w, x, y, z] }: BodyPose): void {
  for (const object of [solid, edges]) {
    object.position.set(...xyz_mm);
    object.quaternion.set(x, y, z, w);
    object.updateMatrixWorld();
  }
}

const opacityOf = ({ role }: Body, red: boolean): number => (red && PAINTS[role].opacity < 1 ? RED_OPACITY : PAINTS[role].opacity);
const edgesOf = ({ role }: Body): number => (PAINTS[role].opacity < 1 ? 0.75 : 0.35);

function paint(drawn: Drawn, red: boolean): void {
  const { body, solid, edges } = drawn;
  drawn.red = red;
  solid.material.color.set(red ? RED : PAINTS[body.role].colour);
  shine(solid.material, opacityOf(body, red));
  edges.material.color.set(red ? RED : PAINTS[body.role].colour).multiplyScalar(0.55);
  edges.material.opacity = edgesOf(body);
}

function shine(of: THREE.MeshStandardMaterial, opacity: number): void {
  const clear = opacity < 1;
  of.opacity = opacity;
  if (of.transparent === clear) return;
  of.transparent = clear;
  of.depthWrite = !clear;
  of.needsUpdate = true;
}
