// The arm, drawn from its joints: links as tapered limbs with round knuckles, joints as housings along their axes with
// a ring whose colour shows the joint's share of the deviation, then flange and tool. An arm that moves keeps its parts:
// only a part whose dimensions change is rebuilt. Of the tool the cutter has the diameter of the study; holder and spindle are
// only indicated.

import * as THREE from "three";
import type { ArmDrawing, Vec3 } from "../types";
import type { Limb } from "./covered";

const vector = (v: Vec3): THREE.Vector3 => new THREE.Vector3(v[0], v[1], v[2]);
/** Materials of the parts of an arm. */
export interface Paints {
  body: THREE.Material;
  housing: THREE.Material;
  steel: THREE.Material;
  tip: THREE.Material;
}
const SOLID: Paints = {
  body: new THREE.MeshStandardMaterial({ color: 0xd5dbe3, roughness: 0.42, metalness: 0.15 }),
  housing: new THREE.MeshStandardMaterial({ color: 0x39434f, roughness: 0.5, metalness: 0.35 }),
  steel: new THREE.MeshStandardMaterial({ color: 0x9aa5b1, roughness: 0.3, metalness: 0.7 }),
  tip: new THREE.MeshStandardMaterial({ color: 0xe8792b, roughness: 0.4, metalness: 0.1 }),
};
const UP = new THREE.Vector3(0, 1, 0);

/** A part by its measures (mm), about its origin and along y. */
interface Shape {
  measures: string;
  make: () => THREE.BufferGeometry;
}

/** A cutter or drill, mm. */
export interface CutterShape {
  diameter: number;
  corner: number;
}

/** What of a tool the study gives as bodies: that is not indicated. */
export interface OwnTool {
  holder: boolean;
  cutter: boolean;
}

export class Arm {
  readonly group = new THREE.Group();
  /** Of each joint: its name and where its housing sits. */
  knuckles: { name: string; at: THREE.Vector3 }[] = [];
  /** What of the scene it hides. */
  limbs: Limb[] = [];
  private readonly body = new THREE.Group();
  private readonly tooling = new THREE.Group();
  /** In the order in which they are drawn. */
  private parts: { mesh: THREE.Mesh; measures: string }[] = [];
  private drawn = 0;
  readonly rings: THREE.MeshStandardMaterial[] = [];

  constructor(private readonly paints: Paints = SOLID) {
    this.group.add(this.body, this.tooling);
  }

  /** The tool alone, where the arm is shown in another shape. */
  bare(on: boolean): void {
    this.body.visible = !on;
  }

  /** `shares`: of each joint, 0 to 1; `accent`: the colour of a joint that does it all. */
  draw(drawing: ArmDrawing, shares: number[], quiet: THREE.Color, accent: THREE.Color, cutter: CutterShape | null = null, own: OwnTool = { holder: false, cutter: false }): void {
    this.drawn = 0;
    // The line ends at the tip; the arm itself ends at the flange.
    const tip = vector(drawing.tool_mm);
    const line = drawing.links_mm.map(vector).filter((p, i, all) => i < all.length - 1 || p.distanceTo(tip) > 0.5);
    const base = line[0] ?? new THREE.Vector3();
    const knots = [...line, vector(drawing.flange_mm)].filter((p, i, all) => i === 0 || p.distanceTo(all[i - 1]!) > 0.5);
    const lengths = knots.slice(1).map((p, i) => p.distanceTo(knots[i]!));
    const total = lengths.reduce((sum, l) => sum + l, 0) || 1;
    const thick = total * 0.044;
    const radius = (along: number) => thick * (1 - 0.66 * Math.min(1, along / total));

    this.limbs = [];
    let along = 0;
    knots.slice(1).forEach((to, i) => {
      const from = knots[i]!;
      this.add(limb(lengths[i]!, radius(along), radius(along + lengths[i]!)), from, to.clone().sub(from).normalize(), this.paints.body);
      this.limbs.push({ from, to, radius: radius(along) });
      along += lengths[i]!;
      if (i + 2 < knots.length) this.add(ball(radius(along)), to, UP, this.paints.body);
    });
    this.pedestal(base, thick);

    this.knuckles = drawing.joints.map((joint, i) => {
      const axis = vector(joint.axis).normalize();
      const { at, size, on_link } = this.housingOf(vector(joint.origin_mm), axis, knots, lengths, radius);
      const long = on_link ? size * 0.55 : size * 1.28;
      const wide = on_link ? size * 1.13 : size * 1.16;
      this.add(drum(wide, long), at, axis, this.paints.housing);
      const share = Math.min(1, Math.max(0, shares[i] ?? 0));
      const colour = (this.rings[i] ??= new THREE.MeshStandardMaterial({ roughness: 0.45 }));
      colour.color.copy(quiet).lerp(accent, Math.sqrt(share));
      colour.emissive.copy(accent);
      colour.emissiveIntensity = 0.35 * share;
      for (const side of on_link ? [0] : [-1, 1]) this.add(ring(wide * (on_link ? 1 : 0.8), wide * 0.11), at.clone().addScaledVector(axis, side * long * 0.97), axis, colour);
      return { name: joint.name, at: at.clone() };
    });
    this.tool(vector(drawing.flange_mm), vector(drawing.tool_mm), vector(drawing.tool_axis).normalize(), radius(total), cutter, own);
    for (const { mesh } of this.parts.splice(this.drawn)) {
      mesh.removeFromParent();
      mesh.geometry.dispose();
    }
  }

  /** Transparent, where objects behind it matter more. */
  ghost(on: boolean): void {
    for (const child of [...this.body.children, ...this.tooling.children]) {
      const material = (child as THREE.Mesh).material as THREE.MeshStandardMaterial;
      if (material.transparent === on) continue;
      material.transparent = on;
      material.opacity = on ? 0.12 : 1;
      material.depthWrite = !on;
      material.needsUpdate = true;
    }
  }

  /** The next part, its y along `way`. */
  private add({ measures, make }: Shape, at: THREE.Vector3, way: THREE.Vector3, material: THREE.Material, group = this.body): void {
    const part = (this.parts[this.drawn++] ??= { mesh: new THREE.Mesh(), measures: "" });
    const { mesh } = part;
    if (part.measures !== measures) {
      mesh.geometry.dispose();
      mesh.geometry = make();
      part.measures = measures;
    }
    mesh.material = material;
    mesh.position.copy(at);
    mesh.quaternion.setFromUnitVectors(UP, way);
    if (mesh.parent !== group) group.add(mesh);
  }

  /** A joint whose axis runs along a link sits as a collar on that link, else at its origin. */
  private housingOf(origin: THREE.Vector3, axis: THREE.Vector3, knots: THREE.Vector3[], lengths: number[], radius: (along: number) => number) {
    let along = 0;
    let near = { distance: Infinity, along: 0 };
    let collar: { at: THREE.Vector3; along: number; gap: number } | null = null;
    lengths.forEach((length, i) => {
      const from = knots[i]!;
      const to = knots[i + 1]!;
      const way = to.clone().sub(from).divideScalar(length);
      for (const [end, here] of [[from, along], [to, along + length]] as const) {
        const distance = end.distanceTo(origin);
        if (distance < near.distance) near = { distance, along: here };
      }
      const off = origin.clone().sub(from);
      const reach = off.dot(way);
      const gap = off.clone().addScaledVector(way, -reach).length();
      if (Math.abs(way.dot(axis)) > 0.999 && gap < 1 && reach > -1 && reach < length + 1) {
        const t = Math.min(0.5 * length, radius(along) * 2.1);
        if (collar === null) collar = { at: from.clone().addScaledVector(way, t), along: along + t, gap };
      }
      along += length;
    });
    const found = collar as { at: THREE.Vector3; along: number } | null;
    return found ? { at: found.at, size: radius(found.along), on_link: true } : { at: origin, size: radius(near.along), on_link: false };
  }

  private pedestal(base: THREE.Vector3, thick: number): void {
    const profile = [[0, 0], [1.9, 0], [1.9, 0.22], [1.75, 0.3], [1.35, 0.36], [1.22, 1.1], [1.1, 1.25], [0, 1.25]].map(([r, z]) => new THREE.Vector2(r! * thick, z! * thick));
    const made = () => new THREE.LatheGeometry(profile, 56);
    this.add({ measures: shapeKey("pedestal", thick), make: made }, base, new THREE.Vector3(0, 0, 1), this.paints.housing);
    this.limbs.push({ from: base, to: base.clone().setZ(base.z + 1.2 * thick), radius: 1.5 * thick });
  }

  /** Cutter, holder and spindle along the axis of the tool; where that is not the way to the flange, on a bracket. */
  private tool(flange: THREE.Vector3, tip: THREE.Vector3, axis: THREE.Vector3, thick: number, cutter: CutterShape | null, own: OwnTool): void {
    this.add(drum(thick * 1.05, thick * 0.28), flange.clone().addScaledVector(axis, -thick * 0.25), axis, this.paints.steel, this.tooling);
    const length = tip.distanceTo(flange);
    this.limbs.push({ from: flange, to: tip, radius: thick * 0.7 });
    if (length > 2) {
      const back = axis.clone().negate();
      const straight = flange.clone().sub(tip).dot(back) > 0.98 * length;
      const radius = cutter ? cutter.diameter / 2 : thick * 0.14;
      const cuts = Math.min(0.4 * length, cutter ? Math.max(4 * cutter.diameter, 20) : thick);
      const holder = Math.min(0.3 * length, Math.max(3 * radius, 0.9 * thick));
      const spindle = straight ? length - cuts - holder : Math.max(0.45 * length, 2.2 * thick);
      const at = (along: number) => tip.clone().addScaledVector(back, along);
      const round = cutter !== null && cutter.corner > 0.98 * radius;
      if (!own.cutter) this.add(limb(cuts - (round ? radius : 0), radius, radius), at(round ? radius : 0), back, this.paints.tip, this.tooling);
      if (round && !own.cutter) this.add(ball(radius), at(radius), UP, this.paints.tip, this.tooling);
      if (!own.holder) this.add(limb(holder, Math.max(1.6 * radius, 0.34 * thick), 0.62 * thick), at(cuts), back, this.paints.housing, this.tooling);
      if (!own.holder) this.add(limb(spindle, 0.72 * thick, 0.72 * thick), at(cuts + holder), back, this.paints.steel, this.tooling);
      if (!straight && !own.holder) {
        const held = at(cuts + holder + 0.6 * spindle);
        this.add(limb(held.distanceTo(flange), 0.8 * thick, 0.5 * thick), flange, held.clone().sub(flange).normalize(), this.paints.steel, this.tooling);
      }
    }
    // The tip is seen also where the cutter is thin.
    if (!cutter && !own.cutter) this.add(ball(Math.max(6, thick * 0.24)), tip, UP, this.paints.tip, this.tooling);
  }
}

/** Identifies a shape by its dimensions, to 0.01 mm. */
const shapeKey = (kind: string, ...mm: number[]): string => `${kind} ${mm.map((m) => m.toFixed(2)).join(" ")}`;

/** From the origin along y. */
const limb = (length: number, r0: number, r1: number): Shape => ({
  measures: shapeKey("limb", length, r0, r1),
  make: () => new THREE.CylinderGeometry(r1, r0, Math.max(length, 0.01), 40).translate(0, length / 2, 0),
});

const ball = (radius: number): Shape => ({ measures: shapeKey("ball", radius), make: () => new THREE.SphereGeometry(radius, 28, 18) });

/** Round y. */
const ring = (radius: number, thick: number): Shape => ({
  measures: shapeKey("ring", radius, thick),
  make: () => new THREE.TorusGeometry(radius, thick, 8, 40).rotateX(Math.PI / 2),
});

/** A cylinder with bevelled edges; `half` its half length. */
const drum = (radius: number, half: number): Shape => ({
  measures: shapeKey("drum", radius, half),
  make: () => {
    const bevel = Math.min(radius, half) * 0.2;
    const profile = [[0, -half], [radius - bevel, -half], [radius, -half + bevel], [radius, half - bevel], [radius - bevel, half], [0, half]].map(([r, y]) => new THREE.Vector2(r, y));
    return new THREE.LatheGeometry(profile, 48);
  },
});
