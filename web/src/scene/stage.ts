// The stage: camera, light, ground, axes in mm, standard views. x forward, z up, lengths in mm. Draws on demand only.
//
// A graphics card smooths edges as it draws. Without one the processor draws, and smoothing would take most of its time:
// there a changing picture is drawn without smoothing, and redrawn with four samples per pixel once it no longer changes.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { niceStep } from "../format";
import { shade } from "./colour";
import { Labels } from "./labels";

export type View = "overview" | "front" | "side" | "top" | "plate";
/** What a view looks at, and the outward normal of the plate. */
export interface Subject {
  box: THREE.Box3;
  plate: { centre: THREE.Vector3; normal: THREE.Vector3; up: THREE.Vector3; size: number } | null;
}

/** Options of WebGL. */
const CONTEXT = { alpha: true, antialias: true };
/** So long a picture of the processor rests before it is drawn finely. */
const REST_MS = 300;

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(32, 1, 10, 60000);
  readonly renderer: THREE.WebGLRenderer;
  readonly controls: OrbitControls;
  readonly labels: Labels;
  readonly size = new THREE.Vector2(1, 1);
  private readonly ground = new THREE.Group();
  private readonly lights = new THREE.Group();
  /** Whether an object is in front of a label of this group at this point. */
  covered: (group: string, at: THREE.Vector3) => boolean = () => false;
  /** Called before each frame is drawn. */
  before: () => void = () => {};
  private ground_key = "";
  /** From the ground to the base; only where a positioner moves the table is it not the same. */
  private base_from_ground = new THREE.Matrix4();
  private ticks: { text: string; at: THREE.Vector3 }[] = [];
  private requested = false;
  private readonly by_card: boolean;
  private rests: ReturnType<typeof setTimeout> | undefined;

  constructor(readonly host: HTMLElement) {
    let renderer = new THREE.WebGLRenderer(CONTEXT);
    this.by_card = !isProcessor(renderer.getContext());
    if (!this.by_card) {
      // Antialiasing is chosen when a context is created.
      renderer.dispose();
      renderer.forceContextLoss();
      renderer = new THREE.WebGLRenderer({ ...CONTEXT, antialias: false });
    }
    this.renderer = renderer;
    this.renderer.setClearAlpha(0);
    host.append(this.renderer.domElement);
    this.renderer.domElement.setAttribute("aria-hidden", "true");
    this.labels = new Labels(host);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(-1400, -3000, 2100);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.target.set(500, 0, 700);
    this.controls.minDistance = 150;
    this.controls.maxDistance = 30000;
    this.controls.addEventListener("change", () => this.draw());
    this.light();
    this.scene.add(this.ground);
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  /** Draws before the next frame, once for any number of calls. `data-picture` of the stage: `waits` until then, `moving` while
   * it has the resolution of moving pictures, `still` after that. */
  draw(): void {
    if (this.requested) return;
    this.requested = true;
    clearTimeout(this.rests);
    const { dataset } = this.host;
    dataset.picture = "waits";
    requestAnimationFrame(() => {
      this.requested = false;
      this.before();
      this.render(this.by_card ? Math.min(devicePixelRatio, 2) : Math.min(devicePixelRatio, 1));
      this.labels.place(this.camera, this.size, this.covered);
      if (this.requested) return;
      dataset.picture = this.by_card ? "still" : "moving";
      if (this.by_card) return;
      this.rests = setTimeout(() => {
        this.render(Math.min(2 * devicePixelRatio, 2));
        dataset.picture = "still";
      }, REST_MS);
    });
  }

  private render(pixel_ratio: number): void {
    if (this.renderer.getPixelRatio() !== pixel_ratio) this.renderer.setPixelRatio(pixel_ratio);
    this.renderer.render(this.scene, this.camera);
  }

  /** The ground grid under what is shown: 100 mm fine, 500 mm strong, labelled along x and y. */
  floor(height: number, reach: number): void {
    const half = Math.max(1000, Math.ceil(reach / 500) * 500);
    const key = `${height} ${half} ${document.documentElement.dataset.theme}`;
    if (key === this.ground_key) return;
    this.ground_key = key;
    this.ground.clear();
    const step = niceStep(half, 10);
    const lines = (every: number, skip: number, name: string, opacity: number) => {
      const points: number[] = [];
      for (let x = -half; x <= half + 1; x += every) {
        if (skip && Math.round(x) % skip === 0) continue;
        points.push(x, -half, 0, x, half, 0, -half, x, 0, half, x, 0);
      }
      const geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
      return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: shade(name), transparent: true, opacity }));
    };
    this.ground.add(lines(step / 2, step * 2.5, "--scene-grid", 0.45), lines(step * 2.5, 0, "--scene-grid-strong", 0.9));
    for (const [axis, direction] of [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]] as const) {
      const to = new THREE.Vector3(...direction).multiplyScalar(axis === "z" ? half * 0.9 : half);
      const geometry = new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), to]);
      this.ground.add(new THREE.Line(geometry, new THREE.LineBasicMaterial({ color: shade(`--axis-${axis}`) })));
    }
    this.ground.children.forEach((child) => (child.position.z = height));
    this.ticks = [];
    for (let at = 500; at <= half; at += half > 2500 ? 1000 : 500) {
      const last = at + 500 > half;
      this.ticks.push({ text: last ? `x ${at} mm` : String(at), at: new THREE.Vector3(at, 0, height) }, { text: last ? `y ${at} mm` : String(at), at: new THREE.Vector3(0, at, height) });
      if (at <= half * 0.9) this.ticks.push({ text: `z ${at}`, at: new THREE.Vector3(0, 0, height + at) });
    }
    this.labelGround();
    this.draw();
  }

  /** Where the ground is, on which robot and observer stand: in the picture it stands still, and the table of a positioner turns. */
  standOn(base_from_ground: THREE.Matrix4): void {
    const moved = base_from_ground.clone().multiply(this.base_from_ground.clone().invert());
    if (moved.elements.every((value, i) => Math.abs(value - (i % 5 === 0 ? 1 : 0)) < 1e-9)) return;
    this.base_from_ground.copy(base_from_ground);
    this.ground.matrixAutoUpdate = false;
    this.ground.matrix.copy(base_from_ground);
    this.lights.matrixAutoUpdate = false;
    this.lights.matrix.copy(base_from_ground);
    this.labelGround();
    this.camera.position.applyMatrix4(moved);
    this.controls.target.applyMatrix4(moved);
    this.camera.up.set(0, 0, 1).transformDirection(base_from_ground);
    orbitAbout(this.controls, this.camera.up);
    this.controls.update();
    this.draw();
  }

  private labelGround(): void {
    this.labels.group("ground");
    for (const { text, at } of this.ticks) this.labels.add("ground", at.clone().applyMatrix4(this.base_from_ground), text, "tick");
  }

  /** Ground and axes; hidden where they would be in front of the plate. */
  axes(on: boolean): void {
    this.ground.visible = on;
    this.labels.visible("ground", on);
  }

  look(view: View, subject: Subject): void {
    const { box, plate } = subject;
    const target = view === "plate" && plate ? plate.centre.clone() : box.getCenter(new THREE.Vector3());
    const radius = view === "plate" && plate ? plate.size * 0.46 : box.getBoundingSphere(new THREE.Sphere()).radius;
    const from: Record<View, THREE.Vector3> = {
      overview: new THREE.Vector3(-0.62, -1, 0.42),
      front: new THREE.Vector3(1, 0, 0.0001),
      side: new THREE.Vector3(0, -1, 0.0001),
      top: new THREE.Vector3(-0.0001, 0, 1),
      plate: plate ? plate.normal.clone().addScaledVector(plate.up, 0.0001) : new THREE.Vector3(-1, 0, 0.0001),
    };
    const direction = from[view].normalize();
    this.aim(target, radius, view === "plate" ? direction : direction.transformDirection(this.base_from_ground));
  }

  /** All of the subject, from the present direction. */
  fit({ box }: Subject): void {
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    this.aim(box.getCenter(new THREE.Vector3()), box.getBoundingSphere(new THREE.Sphere()).radius, direction);
  }

  /** A place from this direction, with so much around it. */
  close(target: THREE.Vector3, radius: number, direction: THREE.Vector3): void {
    this.aim(target, radius, direction);
  }

  private aim(target: THREE.Vector3, radius: number, direction: THREE.Vector3): void {
    const fov = (this.camera.fov * Math.PI) / 180;
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (radius * 1.08) / Math.sin(fov / 2) / narrow;
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.camera.near = Math.max(5, distance / 200);
    this.camera.far = distance * 12 + 20000;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  private light(): void {
    const sky = new THREE.HemisphereLight(0xffffff, 0x8d97a5, 1.7);
    sky.position.set(0, 0, 1);
    const key = new THREE.DirectionalLight(0xffffff, 2.1);
    key.position.set(-900, -1600, 2600);
    const rim = new THREE.DirectionalLight(0xdde8ff, 0.8);
    rim.position.set(1800, 1500, 900);
    this.lights.add(sky, key, rim);
    this.scene.add(this.lights);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    this.size.set(width, height);
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}

/** Whether the processor draws: there is no graphics card, or none that the browser would use. */
function isProcessor(gl: WebGLRenderingContext | WebGL2RenderingContext): boolean {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(String(gl.getParameter(info?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER)));
}

/** Orbits about another vertical direction, which the controls take from the camera only when they are made. */
function orbitAbout(controls: OrbitControls, up: THREE.Vector3): void {
  const own = controls as unknown as { _quat: THREE.Quaternion; _quatInverse: THREE.Quaternion };
  own._quat.setFromUnitVectors(up, new THREE.Vector3(0, 1, 0));
  own._quatInverse.copy(own._quat).invert();
}
