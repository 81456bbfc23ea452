// The scene of the live page: the answer on the stage, values under the pointer, clicks that send the robot.

import * as THREE from "three";
import { niceStep } from "../format";
import { lostHoles } from "../headline";
import { api } from "../server";
import type { Live } from "../live";
import { measured } from "../measured";
import { sharesOf } from "../shares";
import type { At, Body, Line, Plate, Vec3 } from "../types";
import { Arm } from "./arm";
import { Arrow } from "./arrows";
import { Bodies, matrixOf } from "./bodies";
import { BodyMeshes } from "./body-meshes";
import { shade } from "./colour";
import { isCovered } from "./covered";
import type { Hit } from "../machined-part/boxes";
import type { PartState } from "../machined-part/state";
import { Handles } from "./handles";
import { Crosses } from "./crosses";
import { Ellipsoid } from "./ellipsoid";
import { GhostArm } from "./ghost";
import { shownLayer } from "./layers";
import { MachinedView } from "./machined";
import { Marker } from "./marker";
import { NearestPair } from "./nearest";
import { Part } from "./part";
import { PathView } from "./path";
import { PlateView } from "./plate";
import { Shapes } from "./shapes";
import { Stage, type Subject, type View } from "./stage";
import { VolumeView } from "./volume";

export interface Show {
  arm: boolean;
  /** The machined part, in the colours of its deviation. */
  machined: boolean;
  /** The tool path with its deviations. */
  path: boolean;
  /** The arm of the pinned state. */
  pinned: boolean;
  /** The robot's own shape, where its file names one. */
  shape: boolean;
  /** The bodies of the cell, without those of links. */
  bodies: boolean;
  /** The bodies of links, where the robot's own shape is not shown. */
  link_bodies: boolean;
  /** The two nearest bodies. */
  nearest: boolean;
  forces: boolean;
  deviation: boolean;
  /** Its parts in the plane and along the normal. */
  parts: boolean;
  ellipsoid: boolean;
  certainty: boolean;
  /** The largest rectangle within tolerance. */
  rectangle: boolean;
  /** Times by which the deviation is drawn larger than it is. */
  magnified: number;
  magnified_by_hand: boolean;
  mm_per_n: number;
}

/** The object under the pointer. */
export type Under = { kind: "body"; body: Body } | { kind: "part"; hit: Hit } | { kind: "map"; index: number; y_mm: number; z_mm: number } | { kind: "point"; index: number } | null;

/** mm in the picture for 1 N, of a small force. */
const MM_PER_N = 25;
/** mm in the picture for 1 µm/N. */
export const ELLIPSOID = 8;

/** A robot's own shape is so much stouter than the drawn arm. */
const STOUT = 1.7;

/** Bodies are in the picture up to this part of the size of robot and part beyond them. */
const AROUND = 0.2;

/** So near to its tip the pointer takes the tool. */
const TIP_PX = 12;

export class SceneView {
  readonly stage: Stage;
  readonly show: Show = { arm: true, machined: true, path: true, pinned: true, shape: true, bodies: true, link_bodies: true, nearest: true, forces: true, deviation: true, parts: false, ellipsoid: false, certainty: true, rectangle: false, magnified: 1000, magnified_by_hand: false, mm_per_n: MM_PER_N };
  onHover: (under: Under, x: number, y: number) => void = () => {};
  onScale: () => void = () => {};
  private readonly arm = new Arm();
  private readonly shapes: Shapes;
  private readonly bodies: Bodies;
  private readonly nearest: NearestPair;
  private readonly pinned_arm = new GhostArm();
  private readonly force = new Arrow(0xd55e00);
  private readonly deviation = new Arrow(0xcc3fa0);
  private readonly in_plane = new Arrow(0x009e9a);
  private readonly normal = new Arrow(0x4a6fd6);
  private readonly ellipsoid = new Ellipsoid();
  private readonly path = new PathView();
  private readonly marker = new Marker();
  private readonly volume = new VolumeView();
  private readonly part = new Part();
  private readonly machined: MachinedView;
  /** Whether the user has chosen if the tool path is shown; else it is hidden once the part is shown, which it covers. */
  path_by_hand = false;
  readonly handles: Handles;
  private readonly crosses: Crosses;
  private readonly plates: PlateView[] = [];
  private readonly caster = new THREE.Raycaster();
  private looked = "";
  private ghost = false;
  /** Until the arm has come too, the view is not final. */
  private new_subject = false;

  constructor(private readonly host: HTMLElement, private readonly live: Live, private readonly machined_part: PartState) {
    this.stage = new Stage(host);
    this.machined = new MachinedView(this.stage.labels);
    this.crosses = new Crosses(this.stage.labels);
    this.shapes = new Shapes((file) => api.mesh(live.text, file), () => this.drawPose());
    this.bodies = new Bodies(new BodyMeshes((key) => api.bodyMesh(live.text, live.analysis, key), () => this.redraw()));
    this.nearest = new NearestPair(this.stage.labels);
    this.stage.covered = (group, at) => group !== "arm" && group !== "nearest" && this.show.arm && !this.ghost && this.live.pose !== null && isCovered(this.arm.limbs, this.stage.camera.position, at, this.shapes.group.visible ? STOUT : 1);
    this.stage.scene.add(this.arm.group, this.shapes.group, this.pinned_arm.group, this.force.group, this.deviation.group, this.in_plane.group, this.normal.group, this.ellipsoid.group, this.path.group, this.marker.group, this.volume.group, this.part.group, this.machined.group, this.crosses.group, this.bodies.group, this.nearest.group);
    live.listen(["answer", "view"], () => this.drawAnswer());
    live.listen(["pose", "view"], () => this.drawPose());
    live.listen(["at", "pose"], () => this.drawMarker());
    live.listen(["part", "view"], () => this.drawMachined());
    this.stage.before = () => {
      if (this.path.update(this.stage.camera, this.stage.size)) host.dataset.vectors = String(this.path.vectors);
    };
    this.handles = new Handles(this.stage, live);
    this.point();
  }

  redraw(): void {
    this.drawAnswer();
    this.drawPose();
  }

  look(view: View): void {
    this.faint(view === "plate");
    this.stage.look(view, this.subject());
  }

  /** Whether the arm is faint, so that the part is seen through it. */
  private faint(on: boolean): void {
    this.ghost = on;
    this.arm.ghost(on);
    this.shapes.ghost(on);
    this.bodies.ghost(on);
    this.stage.axes(!on);
  }

  /** All of it, from the present direction. */
  fit(): void {
    this.stage.fit(this.subject());
  }

  // ---- The answer: plates, path, volume ----

  private drawAnswer(): void {
    const { answer, scene, setting } = this.live;
    if (!answer || !scene || !setting) return;
    const shown = shownLayer(this.live);
    const plates = answer.maps.length > 0 ? this.platesOf() : [];
    while (this.plates.length < plates.length) {
      const plate = new PlateView(this.stage.labels, `plate ${this.plates.length}`);
      this.plates.push(plate);
      this.stage.scene.add(plate.group);
    }
    this.plates.forEach((view, i) => {
      const map = answer.maps[i];
      const plate = plates[i];
      const lines = this.live.lines[i];
      if (!map || !plate || !lines) return view.hide();
      if (answer.maps.length > 1 && i !== this.live.section) return view.outline(map, plate);
      view.draw(map, plate, shown, i, lines.tolerance_mm as Line[], { certainty: this.show.certainty, rectangle: this.show.rectangle });
    });
    if (scene.points && !scene.box) this.path.draw(scene.points, shown, answer.paths.length > 0, this.show.deviation ? this.show.magnified / 1000 : 0);
    else this.path.clear();
    this.volume.draw(scene, shown, setting.tolerance_um);
    this.drawLost();
    this.part.draw(answer.paths.length + answer.holes.length > 0 ? scene.plate : null);
    this.bodies.drawStill(scene.cell, scene.sections[this.live.section]?.part ?? null);
    this.stage.floor(0, this.reach());
    const key = `${this.live.analysis} ${scene.robot} ${answer.maps.length}`;
    if (key !== this.looked) {
      this.looked = key;
      this.new_subject = true;
      this.look("overview");
    }
    this.onScale();
    this.stage.draw();
  }

  /** Crosses over the holes that cannot be drilled. */
  private drawLost(): void {
    const { answer, scene } = this.live;
    const lost = answer ? lostHoles(answer) : [];
    const points = scene?.points;
    if (!points || lost.length === 0) return this.crosses.draw([], [], [], 0);
    const at = Array.from({ length: points.count }, (_, i) => points.at(i));
    const rows = new Map(answer?.holes[0]?.each.map((row) => [row.hole, row.normal_axis]));
    const size = Math.max(6, Math.min(40, 0.05 * (points.size || 100)));
    this.crosses.draw(lost, at, lost.map(({ hole }) => rows.get(hole) ?? null), size);
  }

  /** One plate a map. */
  private platesOf(): Plate[] {
    const scene = this.live.scene;
    if (!scene) return [];
    return scene.sections.length > 0 ? scene.sections.map((s) => s.plate) : [scene.plate];
  }

  /** The machined part in place of the plate, of the part of the cell and of the tool path on it. */
  private drawMachined(): void {
    const { machined_part: part, show, live } = this;
    if (part.visible !== show.machined) part.show(show.machined);
    this.machined.draw(part, live.answer?.paths[0]?.setting.tolerance_um ?? Infinity);
    const shown = this.machined.group.visible;
    if (shown && !this.path_by_hand) show.path = false;
    this.path.group.visible = show.path || !part.there;
    this.part.group.visible = !shown;
    this.bodies.withPart(!shown);
    this.host.dataset.part = shown ? String(part.surface!.about.points) : "";
    this.onScale();
    this.stage.draw();
  }

  /** Looks at a place of the machined part (base), against its normal, so that its surroundings are seen; the arm is faint. */
  lookAtPart(at: THREE.Vector3, normal: THREE.Vector3): void {
    this.faint(true);
    const size = this.machined.size;
    // Steep walls are seen from above: the direction is between the normal and that of the tool.
    const up = this.live.scene?.plate.normal_axis;
    const direction = normal.clone().addScaledVector(up ? new THREE.Vector3(...up) : new THREE.Vector3(0, 0, 1), 1.2).normalize();
    this.stage.close(at, 0.16 * size, direction);
  }

  /** Where a point of the machined part is, and a direction there, base. */
  ofPart(xyz_mm: Vec3, normal: Vec3): [THREE.Vector3, THREE.Vector3] {
    const base = this.machined.group.matrix;
    return [new THREE.Vector3(...xyz_mm).applyMatrix4(base), new THREE.Vector3(...normal).transformDirection(base)];
  }

  // ---- The pose: arm, arrows, ellipsoid ----

  private drawPose(): void {
    const { pose, posture, load_case, setting } = this.live;
    const drawing = pose?.drawings[posture];
    const answer = pose?.answer.postures[posture];
    if (this.live.scene?.box) this.volume.through(this.pointOfRobot(), shownLayer(this.live));
    this.stage.labels.group("arm");
    this.arm.group.visible = this.show.arm;
    this.shapes.group.visible = false;
    // At an unreachable point it stays faintly at its last position.
    if (!drawing) this.arm.ghost(true);
    for (const hidden of [this.force, this.deviation, this.in_plane, this.normal, this.ellipsoid]) hidden.group.visible = false;
    if (drawing) this.stage.standOn(matrixOf(drawing.ground));
    if (drawing && this.new_subject) {
      this.new_subject = false;
      this.stage.floor(0, this.reach());
      this.look("overview");
      this.magnify();
    }
    if (drawing && answer && setting) {
      const shares = this.shares();
      const process = this.live.values?.process;
      const cutter = process ? { diameter: process.diameter_mm, corner: process.corner_radius_mm ?? 0 } : null;
      const [holder, own_cutter] = (["holder", "cutter"] as const).map((role) => this.show.bodies && this.bodies.has(role));
      this.arm.draw(drawing, shares, shade("--joint-quiet"), shade("--joint-loud"), cutter, { holder: holder!, cutter: own_cutter! });
      const own = this.show.arm && this.show.shape && this.shapes.draw(pose!.answer.robot, drawing.meshes);
      this.arm.bare(own);
      this.arm.ghost(this.ghost);
      this.shapes.ghost(this.ghost);
      const most = shares.indexOf(Math.max(...shares));
      if (this.show.arm)
        this.arm.knuckles.forEach(({ name, at }, i) => {
          const labelled = shares[i]! >= 0.1;
          this.stage.labels.add("arm", at, labelled ? `${name} ${Math.round(100 * shares[i]!)} %` : name, i === most && labelled ? "joint loud" : "joint");
        });
      const tip = drawing.tool_mm;
      // An arrow at a small part is not stouter than the part.
      const size = Math.max(2, Math.min(Math.max(7, this.reach() * 0.008), 0.03 * (this.partSize() ?? Infinity)));
      const force = pose?.in_plane[posture]?.[load_case - 1]?.force_n;
      if (this.show.forces && force) {
        this.scaleForce(Math.hypot(...force));
        this.force.draw(tip, new THREE.Vector3(...force).multiplyScalar(this.show.mm_per_n), size, true);
        if (this.force.group.visible) this.stage.labels.add("arm", this.force.start, `force ${Math.hypot(...force).toFixed(1)} N`, "force");
      }
      const moved = pose?.in_plane[posture]?.[load_case - 1]?.deviation_um;
      if (this.show.deviation && moved) {
        this.deviation.draw(tip, new THREE.Vector3(...moved).multiplyScalar(this.show.magnified / 1000), size);
        // The tool is perpendicular to the part: its axis is the normal everywhere.
        const normal = new THREE.Vector3(...drawing.tool_axis);
        const drawn = new THREE.Vector3(...moved).multiplyScalar(this.show.magnified / 1000);
        const out = normal.clone().multiplyScalar(drawn.dot(normal));
        if (this.show.parts) {
          this.in_plane.draw(tip, drawn.clone().sub(out), size * 0.7);
          this.normal.draw(tip, out, size * 0.7);
        }
        if (this.deviation.group.visible) this.stage.labels.add("arm", this.deviation.end, `${Math.hypot(...moved).toFixed(0)} µm`, "moved");
      }
      if (this.show.ellipsoid) this.ellipsoid.draw(tip, answer.stiffness, ELLIPSOID);
    }
    this.drawCell();
    const pinned = this.pinned_arm.draw(this.show.arm && this.show.pinned && !this.ghost ? (this.live.pinned?.drawing ?? null) : null, drawing ?? null);
    this.stage.labels.group("pinned");
    if (pinned) this.stage.labels.add("pinned", pinned, "pinned", "pinned");
    this.stage.draw();
  }

  /** The bodies of the arm, and the two nearest. */
  private drawCell(): void {
    const { pose, posture } = this.live;
    const cell = pose?.drawings[posture]?.cell ?? null;
    const answer = pose?.answer.postures[posture] ?? null;
    const near = cell && !cell.keeps_clearance ? (answer?.nearest ?? []) : [];
    this.bodies.group.visible = this.show.bodies;
    this.bodies.drawArm(this.show.arm ? cell : null, this.show.link_bodies && !this.shapes.group.visible && !(this.show.shape && this.shapes.loading), near);
    this.bodies.ghost(this.ghost);
    this.nearest.draw(this.show.nearest ? cell : null, answer, Math.max(4, 0.005 * this.reach()));
  }

  /** A large force is drawn at a smaller scale, by a round number, so that its arrow stays in the picture. */
  private scaleForce(force_n: number): void {
    const longest = 0.25 * this.reach();
    const scale = force_n * MM_PER_N <= longest ? MM_PER_N : 1 / niceStep(force_n / longest, 1);
    if (scale === this.show.mm_per_n) return;
    this.show.mm_per_n = scale;
    this.onScale();
  }

  /** The point of the answer at which the robot is. */
  private pointOfRobot(): Vec3 | null {
    const { at, scene } = this.live;
    const points = scene?.points;
    return typeof at?.point === "number" && points && at.point < points.count ? points.at(at.point) : null;
  }

  /** The point of a path to which the robot is sent. */
  private drawMarker(): void {
    this.marker.draw(this.live.path ? this.pointOfRobot() : null);
    this.stage.draw();
  }

  /** Draws deviations so large that they are seen, by a round number, until the user says how large. */
  private magnify(): void {
    const worst = this.live.worst;
    if (this.show.magnified_by_hand || !worst || !(worst.full_um > 0)) return;
    this.show.magnified = Math.min(1e5, Math.max(100, niceStep(Math.min(0.16 * this.reach(), 0.7 * (this.partSize() ?? Infinity)) / (worst.full_um / 1000), 1)));
    this.onScale();
  }

  /** Shares of the joints in the deviation that is shown, as fractions. */
  private shares(): number[] {
    const { pose, posture, load_case } = this.live;
    const shown = pose?.in_plane[posture]?.[load_case - 1];
    const parts = sharesOf(this.live) ?? [];
    return (pose?.answer.joint_names ?? []).map((_, i) => (shown && shown.in_plane_um > 0 ? Math.max(0, (parts[i] ?? 0) / shown.in_plane_um) : 0));
  }

  // ---- Sizes and pointer ----

  /** Diagonal of a path or of a set of holes; null of plates and volumes. */
  private partSize(): number | null {
    const { scene, answer } = this.live;
    if (!scene?.points || !answer || answer.paths.length + answer.holes.length === 0) return null;
    return scene.points.size || null;
  }

  private reach(): number {
    const size = this.subject().box.getSize(new THREE.Vector3());
    return Math.max(size.x, size.y, size.z);
  }

  private subject(): Subject {
    const { scene, pose, posture } = this.live;
    const box = new THREE.Box3();
    const drawing = pose?.drawings[posture];
    box.expandByPoint(new THREE.Vector3());
    drawing?.links_mm.forEach((p) => box.expandByPoint(new THREE.Vector3(...p)));
    if (scene?.points) box.union(scene.points.box);
    if (scene?.box) box.union(this.volume.extent(scene.box));
    const plates = this.platesOf();
    for (const plate of plates) plate.corners_mm.forEach((p) => box.expandByPoint(new THREE.Vector3(...p)));
    // Of a hall around the cell no more than what is near to robot and part.
    if (this.show.bodies) box.union(this.bodies.extent.intersect(box.clone().expandByScalar(AROUND * box.getSize(new THREE.Vector3()).length())));
    const plate = plates[this.live.section] ?? null;
    if (!plate) return { box, plate: null };
    const [a, b] = [new THREE.Vector3(...plate.corners_mm[0]!), new THREE.Vector3(...plate.corners_mm[2]!)];
    return { box, plate: { centre: new THREE.Vector3(...plate.centre_mm), normal: new THREE.Vector3(...plate.normal_axis), up: new THREE.Vector3(...plate.z_axis), size: a.distanceTo(b) } };
  }

  private point(): void {
    const canvas = this.stage.renderer.domElement;
    let down: [number, number] | null = null;
    let tool = false;
    canvas.addEventListener("pointerdown", (e) => {
      down = [e.clientX, e.clientY];
      tool = !this.handles.busy && this.onTool(e);
      if (tool) this.stage.controls.enabled = false;
    });
    canvas.addEventListener("pointermove", (e) => {
      if (tool) return this.dragTool(e);
      const begun = performance.now();
      this.onHover(e.buttons || this.handles.busy ? null : this.under(e), e.clientX, e.clientY);
      canvas.style.cursor = this.onTool(e) ? "grab" : "";
      measured("hover", begun);
    });
    canvas.addEventListener("pointerleave", () => this.onHover(null, 0, 0));
    canvas.addEventListener("pointerup", (e) => {
      if (tool) this.stage.controls.enabled = true;
      if (tool || this.handles.busy) return void (tool = false);
      if (!down || Math.hypot(e.clientX - down[0], e.clientY - down[1]) > 4) return;
      const under = this.under(e);
      const at = under && this.placeOf(under);
      if (at) this.live.goTo(at);
    });
  }

  /** Whether the pointer is on the tip of the tool. */
  private onTool(event: PointerEvent): boolean {
    const tip = this.live.pose?.drawings[this.live.posture]?.tool_mm;
    if (!tip || !this.show.arm) return false;
    const box = this.host.getBoundingClientRect();
    const at = new THREE.Vector3(...tip).project(this.stage.camera);
    return Math.hypot(((at.x + 1) / 2) * box.width - (event.clientX - box.left), ((1 - at.y) / 2) * box.height - (event.clientY - box.top)) < TIP_PX;
  }

  /** The robot follows the pointer over the part. */
  private dragTool(event: PointerEvent): void {
    const under = this.under(event);
    const at = under && this.placeOf(under);
    if (at && JSON.stringify(at) !== JSON.stringify(this.live.at)) this.live.goTo(at);
  }

  private placeOf(under: NonNullable<Under>): At | null {
    if (under.kind === "body") return null;
    if (under.kind === "part") {
      const point = this.machined.pointOf(under.hit);
      return point < 0 ? null : { point };
    }
    if (under.kind === "point") return { point: under.index };
    return this.live.onPlate(under.y_mm, under.z_mm);
  }

  private under(event: PointerEvent): Under {
    const box = this.host.getBoundingClientRect();
    this.caster.setFromCamera(new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2), this.stage.camera);
    if (this.volume.group.visible) {
      const hit = this.caster.intersectObjects(this.volume.sections)[0];
      const index = hit ? this.volume.nearest(hit.point) : null;
      return index === null ? null : { kind: "point", index };
    }
    if (this.path.beads && this.path.group.visible) {
      const hit = this.caster.intersectObject(this.path.beads)[0];
      if (hit?.instanceId !== undefined) return { kind: "point", index: hit.instanceId };
    } else if (!this.path.empty && this.path.group.visible) {
      const index = this.path.under(this.stage.camera, event.clientX - box.left, event.clientY - box.top, box.width, box.height);
      if (index !== null) return { kind: "point", index };
    }
    for (const plate of this.plates) {
      if (!plate.group.visible || !plate.surface.visible) continue;
      const hit = this.caster.intersectObject(plate.surface)[0];
      if (!hit) continue;
      const index = plate.nearest(...plate.place(hit.point));
      const grid = this.live.map!.grid;
      return { kind: "map", index, y_mm: grid.y_mm[index % grid.y_mm.length]!, z_mm: grid.z_mm[Math.floor(index / grid.y_mm.length)]! };
    }
    const hit = this.machined.under(this.caster.ray);
    if (hit) return { kind: "part", hit };
    const body = this.bodies.under(this.caster);
    return body && { kind: "body", body };
  }
}
