// Handles in the scene: the part is moved and turned, the tool is moved on its flange, by dragging; the deviation follows.
//
// | handle | changes |
// |---|---|
// | move the part | `plane.centre_mm` (`box.centre_mm`), along the axes of the reference frame |
// | turn the part | `plane.tilt_deg`, about y; a study with `plane.rotation_deg`: that, about all three axes |
// | move the tool | the position of the TCP in `tool.flange_from_tool_mm_deg`, along the axes of the flange |
// | turn the tool | its angles there, about the TCP and the axes of the flange |
//
// A drag is measured from its start: the text, not the drawing, has the value. The values of the chosen handle can be typed.

import * as THREE from "three";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import type { Live } from "../live";
import type { Axes, Scene, Vec3 } from "../types";
import type { Stage } from "./stage";

export type Handle = "move part" | "turn part" | "move tool" | "turn tool";

/** The values that a handle changes. */
export interface HandleValues {
  unit: "mm" | "°";
  names: string[];
  values: number[];
}

/** Snapped to these, mm and deg. */
export const SNAP_MM = 10;
export const SNAP_DEG = 5;
/** Digits of dragged values: 0.01 mm, 0.01 deg. */
const rounded = (value: number): number => Number(value.toFixed(2));

interface Start {
  position: THREE.Vector3;
  rotation: THREE.Quaternion;
  centre: Vec3 | null;
  tilt: number | null;
  turned: Vec3 | null;
  tool: number[];
}

export class Handles {
  private readonly controls: TransformControls;
  private readonly proxy = new THREE.Object3D();
  private start: Start | null = null;
  handle: Handle | null = null;
  snap = true;
  /** Called where a handle is chosen or no longer possible. */
  onChange: () => void = () => undefined;

  constructor(private readonly stage: Stage, private readonly live: Live) {
    this.controls = new TransformControls(stage.camera, stage.renderer.domElement);
    this.controls.setSize(0.8);
    stage.scene.add(this.proxy, this.controls.getHelper());
    this.controls.addEventListener("change", () => stage.draw());
    this.controls.addEventListener("dragging-changed", ({ value }) => {
      stage.controls.enabled = !value;
      this.start = value ? this.begin() : null;
      if (!value) this.place();
    });
    this.controls.addEventListener("objectChange", () => this.dragged());
    live.listen(["answer", "pose", "study"], () => this.place());
  }

  /** Whether the pointer is on a handle: a click there is not one on the part. */
  get busy(): boolean {
    return this.controls.dragging || this.controls.axis !== null;
  }

  possible(handle: Handle): boolean {
    const { values, pose, posture } = this.live;
    if (!values) return false;
    if (handle === "move tool" || handle === "turn tool") return pose?.drawings[posture] !== undefined;
    if (handle === "move part") return values.distances_mm === null;
    return values.tilts_deg === null;
  }

  choose(handle: Handle | null): void {
    this.handle = handle;
    this.place();
    this.stage.draw();
    this.onChange();
  }

  setSnap(on: boolean): void {
    this.snap = on;
    this.controls.setTranslationSnap(on ? SNAP_MM : null);
    this.controls.setRotationSnap(on ? THREE.MathUtils.degToRad(SNAP_DEG) : null);
  }

  /** Puts the handle where the part or tool is, unless it is dragged. */
  private place(): void {
    const { handle, live, controls, proxy } = this;
    if (this.start) return;
    const scene = live.scene;
    if (handle === null || !scene || !this.possible(handle)) {
      if (controls.object) controls.detach();
      return;
    }
    this.setSnap(this.snap);
    controls.setSpace("local");
    controls.setMode(handle.startsWith("turn") ? "rotate" : "translate");
    const all = handle !== "turn part" || live.values!.tilt_deg === null;
    controls.showX = controls.showZ = all;
    controls.showY = true;
    if (handle.endsWith("tool")) {
      const drawing = live.pose!.drawings[live.posture]!;
      proxy.position.set(...drawing.tool_mm);
      proxy.quaternion.copy(rotationOf(drawing.flange_axes));
    } else {
      const plate = scene.sections[live.section]?.plate ?? scene.plate;
      proxy.position.set(...plate.centre_mm);
      if (scene.box) middle(scene.box, proxy.position);
      proxy.quaternion.copy(rotationOf(scene.base_axes));
    }
    proxy.updateMatrixWorld();
    if (controls.object !== proxy) controls.attach(proxy);
  }

  private begin(): Start {
    const { position, quaternion } = this.proxy;
    const v = this.live.values!;
    return { position: position.clone(), rotation: quaternion.clone(), centre: v.centre_mm, tilt: v.tilt_deg, turned: v.rotation_deg, tool: [...v.flange_from_tool_mm_deg] };
  }

  private dragged(): void {
    const { start, proxy } = this;
    if (!start || !this.handle) return;
    if (this.handle.startsWith("turn")) return this.turned(start);
    // In the axes of the handle: those of the reference frame, or of the flange.
    const by = proxy.position.clone().sub(start.position).applyQuaternion(start.rotation.clone().invert());
    const from = this.handle === "move tool" ? start.tool.slice(0, 3) : start.centre;
    if (from) this.write([from[0]! + by.x, from[1]! + by.y, from[2]! + by.z].map(rounded));
  }

  private turned({ rotation, tilt, turned, tool }: Start): void {
    // In the axes of the reference frame, or of the flange, at the start of the drag.
    const by = rotation.clone().invert().multiply(this.proxy.quaternion);
    if (this.handle === "turn tool") return this.write(anglesOf(by.multiply(rotationBy(tool.slice(3) as Vec3))));
    if (tilt !== null) return this.write([rounded(wrapped(tilt + THREE.MathUtils.radToDeg(2 * Math.atan2(by.y, by.w))))]);
    if (turned !== null) this.write(anglesOf(by.multiply(rotationBy(turned))));
  }

  /** The values of the chosen handle; null without one. */
  get values(): HandleValues | null {
    const { handle, live } = this;
    const v = live.values;
    if (handle === null || !v || !this.possible(handle)) return null;
    const tool = v.flange_from_tool_mm_deg;
    if (handle === "move part") return { unit: "mm", names: ["x", "y", "z"], values: v.centre_mm };
    if (handle === "move tool") return { unit: "mm", names: ["x", "y", "z"], values: tool.slice(0, 3) };
    if (handle === "turn tool") return { unit: "°", names: ["rx", "ry", "rz"], values: tool.slice(3) };
    return v.rotation_deg ? { unit: "°", names: ["rx", "ry", "rz"], values: v.rotation_deg } : { unit: "°", names: ["tilt"], values: [v.tilt_deg ?? 0] };
  }

  /** Changes the values of the chosen handle. */
  write(values: number[]): void {
    const { handle, live } = this;
    const v = live.values!;
    const tool = v.flange_from_tool_mm_deg;
    if (handle === "move part") live.change(v.centre_key, values);
    else if (handle === "move tool") live.change("tool.flange_from_tool_mm_deg", [...values, ...tool.slice(3)]);
    else if (handle === "turn tool") live.change("tool.flange_from_tool_mm_deg", [...tool.slice(0, 3), ...values]);
    else if (v.rotation_deg) live.change("plane.rotation_deg", values);
    else live.change("plane.tilt_deg", values[0]);
  }
}

function middle({ corner_mm, sides_mm }: NonNullable<Scene["box"]>, to: THREE.Vector3): void {
  to.set(...(corner_mm as Vec3));
  for (const side of sides_mm) to.addScaledVector(new THREE.Vector3(...side), 0.5);
}

/** Between -180 and 180 deg. */
const wrapped = (deg: number): number => deg - 360 * Math.round(deg / 360);

const rotationOf = ([x, y, z]: Axes): THREE.Quaternion => new THREE.Quaternion().setFromRotationMatrix(new THREE.Matrix4().makeBasis(new THREE.Vector3(...x), new THREE.Vector3(...y), new THREE.Vector3(...z)));

/** Rotations about the fixed axes x, y, z, one after the other, deg. */
export function rotationBy(deg: Vec3): THREE.Quaternion {
  const [x, y, z] = deg.map(THREE.MathUtils.degToRad) as Vec3;
  return new THREE.Quaternion().setFromEuler(new THREE.Euler(x, y, z, "ZYX"));
}

export function anglesOf(rotation: THREE.Quaternion): Vec3 {
  const { x, y, z } = new THREE.Euler().setFromQuaternion(rotation, "ZYX");
  return [x, y, z].map((rad) => rounded(THREE.MathUtils.radToDeg(rad))) as Vec3;
}
