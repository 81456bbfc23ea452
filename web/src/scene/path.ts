// Paths and holes: a line through the points and a bead at each, coloured by the deviation there. Of a long path the parts that are in
// the picture are drawn, as finely as the picture shows them; they follow the camera.

import * as THREE from "three";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { Rgb } from "./colour";
import { colourOf, type ShownLayer } from "./layers";
import { fat } from "./lines";
import { measured } from "../measured";
import { PathTree, Screen } from "./path-tree";
import { known, type Points } from "./points";
import { Segments } from "./segments";

const MOST_BEADS = 4000;
/** A point so near to the pointer is under it. */
const NEAR_PX = 9;
/** More deviation vectors in the picture would be a sheet. */
const MOST_WHISKERS = 96;
/** Parts of a long path that are smaller than this are one point; coarser if there are more pieces than MOST_PIECES. */
const FINE_PX = 2;
const MOST_PIECES = 6000;
const [COARSER, COARSEST_PX] = [1.4, 60];
/** With more pieces in the picture the ends of the deviations would be a sheet. */
const MOST_RIM = 1500;
/** Width of the line, of a long path and of others. */
const [THIN_PX, WIDE_PX] = [4, 7];
/** Where another load case begins to decide, the end of the deviation leaps by more than this part of it. */
const LEAP = 0.4;

interface Drawn {
  points: Points;
  shown: ShownLayer;
  joined: boolean;
  magnified: number;
  tree: PathTree;
}

export class PathView {
  readonly group = new THREE.Group();
  beads: THREE.InstancedMesh | null = null;
  private readonly line = new Segments({ width: WIDE_PX, colour: 0xffffff, opacity: 1 }, true);
  private readonly whiskers = new Segments({ width: 1.3, colour: 0xcc3fa0, opacity: 0.55 });
  private readonly rim = new Segments({ width: 2.2, colour: 0xcc3fa0, opacity: 1 });
  private readonly kept = new THREE.Group();
  private drawn: Drawn | null = null;
  /** Parts smaller than this were one point in the last picture, px. */
  private fine = FINE_PX;
  /** The camera and the size of the picture that the line was drawn for. */
  private seen = "";

  constructor() {
    this.line.object.material.depthWrite = true;
    this.line.object.material.transparent = false;
    this.group.add(this.kept, this.line.object, this.whiskers.object, this.rim.object);
  }

  /** `magnified`: mm drawn for 1 µm; 0 draws no deviation. */
  draw(points: Points, shown: ShownLayer, joined: boolean, magnified: number): void {
    const tree = this.drawn?.points === points ? this.drawn.tree : new PathTree(points);
    this.clear();
    this.drawn = { points, shown, joined, magnified, tree };
    const n = points.count;
    const values = shown.values(0);
    if (n <= MOST_BEADS) {
      const size = (points.size || 100) * (joined ? 0.012 : 0.02);
      this.beads = new THREE.InstancedMesh(new THREE.SphereGeometry(Math.max(3, Math.min(14, size)), 14, 10), new THREE.MeshBasicMaterial(), n);
      const matrix = new THREE.Matrix4();
      const colour = new THREE.Color();
      for (let i = 0; i < n; i++) {
        this.beads.setMatrixAt(i, matrix.makeTranslation(...points.at(i)));
        this.beads.setColorAt(i, colour.setRGB(...colourOf(shown, known(values, i), points.in_collision[i] === 1), THREE.SRGBColorSpace));
      }
      this.beads.computeBoundingSphere();
      this.kept.add(this.beads);
    }
    this.line.object.material.linewidth = n > MOST_BEADS ? THIN_PX : WIDE_PX;
    if (joined) this.outside(points);
  }

  /** Before a frame: what is in the picture of this camera; whether it has changed. */
  update(camera: THREE.Camera, size: THREE.Vector2): boolean {
    if (!this.drawn) return false;
    camera.updateMatrixWorld();
    const seen = [size.x, size.y, ...camera.matrixWorldInverse.elements, ...camera.projectionMatrix.elements].join();
    if (seen === this.seen) return false;
    this.seen = seen;
    const begun = performance.now();
    const screen = new Screen(camera, size.x, size.y);
    const order = this.order(this.drawn, screen);
    if (this.drawn.joined) this.drawLine(this.drawn, order);
    this.drawWhiskers(this.drawn, screen);
    measured("path", begun);
    return true;
  }

  /** Points of the line, one after the other; where it breaks, -1. */
  private order({ points, shown, joined, tree }: Drawn, screen: Screen): number[] {
    const n = points.count;
    if (!joined) return [];
    if (n <= MOST_BEADS) {
      const all: number[] = [];
      for (let i = 0; i < n; i++) {
        if (i > 0 && points.begins(i)) all.push(-1);
        all.push(i);
      }
      return isClosed(points) ? [...all, 0] : all;
    }
    const values = shown.layer.named ? (points.column("in_plane_um") ?? []) : shown.values(0);
    // From the last picture on: coarser until there are few enough pieces, or finer as long as there are.
    for (let best: number[] | null = null; ; ) {
      const found: number[] = [];
      const few = tree.visible(screen, this.fine, values, MOST_PIECES, (index, follows) => {
        if (!follows || points.begins(index)) found.push(-1);
        found.push(index);
      });
      if (!few && (best || this.fine > COARSEST_PX)) return best ?? found;
      if (few && (this.fine <= FINE_PX || found.length > MOST_PIECES / 2)) return found;
      if (few) best = found;
      this.fine = few ? Math.max(FINE_PX, this.fine / COARSER) : this.fine * COARSER;
    }
  }

  private drawLine({ points, shown, magnified }: Drawn, order: number[]): void {
    const { xyz, deviation } = points;
    const values = shown.values(0);
    const colour = new THREE.Color();
    const of = (i: number): Rgb => colour.setRGB(...colourOf(shown, known(values, i), points.in_collision[i] === 1), THREE.SRGBColorSpace).toArray() as Rgb;
    const end = (i: number) => [0, 1, 2].map((k) => xyz[3 * i + k]! + magnified * deviation[3 * i + k]!);
    const rim = magnified > 0 && (points.count <= MOST_BEADS || order.length <= MOST_RIM);
    this.line.begin();
    this.rim.begin();
    let [before, colour_before, end_before] = [-1, [0, 0, 0] as Rgb, [NaN, NaN, NaN]];
    for (const i of order) {
      if (i >= 0) {
        const [own, own_end] = [of(i), end(i)];
        if (before >= 0) {
          this.line.add(xyz, 3 * before, xyz, 3 * i);
          this.line.colour(colour_before, own);
          if (rim && !leaps(deviation, before, i)) this.rim.add(end_before, 0, own_end, 0);
        }
        [colour_before, end_before] = [own, own_end];
      }
      before = i;
    }
    this.line.end();
    this.rim.end();
  }

  /**
   * Where the tool goes in truth: arrows without head from some points of the picture, about as many at every zoom. A point that has one
   * keeps it while the camera moves at the same zoom.
   */
  private drawWhiskers({ points, magnified, tree }: Drawn, screen: Screen): void {
    this.whiskers.begin();
    if (magnified > 0) {
      const ranges = tree.ranges(screen);
      const count = ranges.reduce((sum, [first, end]) => sum + end - first, 0);
      const every = 2 ** Math.max(0, Math.ceil(Math.log2(count / MOST_WHISKERS)));
      const { xyz, deviation } = points;
      for (const [first, last] of ranges)
        for (let i = Math.ceil(first / every) * every; i < last; i += every) {
          if (Number.isNaN(deviation[3 * i]!)) continue;
          const end = [0, 1, 2].map((k) => xyz[3 * i + k]! + magnified * deviation[3 * i + k]!);
          this.whiskers.add(xyz, 3 * i, end, 0);
        }
    }
    this.whiskers.end();
  }

  /** Where postures are outside joint limits: dashes over the line. */
  private outside(points: Points): void {
    if (!points.any_outside) return;
    const ends: number[] = [];
    for (let i = 1; i < points.count; i++) if ((points.outside[i] === 1 || points.outside[i - 1] === 1) && !points.begins(i)) ends.push(...points.at(i - 1), ...points.at(i));
    if (ends.length === 0) return;
    const line = fat({ width: 8, colour: 0x10151b, opacity: 0.9, dashed: true });
    line.geometry = new LineSegmentsGeometry().setPositions(ends);
    line.computeLineDistances();
    const length = Math.max(2, 0.02 * (points.size || 100));
    [line.material.dashSize, line.material.gapSize] = [length, length];
    line.material.depthTest = false;
    line.renderOrder = 3;
    line.visible = true;
    this.kept.add(line);
  }

  /** The point nearest to (x, y) in the picture, if it is within some pixels. */
  under(camera: THREE.Camera, x: number, y: number, width: number, height: number): number | null {
    return this.drawn?.tree.nearest(new Screen(camera, width, height), x, y, NEAR_PX) ?? null;
  }

  /** Deviation vectors in the picture. */
  get vectors(): number {
    return this.whiskers.size;
  }

  get empty(): boolean {
    return this.drawn === null;
  }

  clear(): void {
    for (const child of this.kept.children) (child as THREE.Mesh).geometry.dispose();
    this.beads?.dispose();
    this.beads = null;
    this.kept.clear();
    this.drawn = null;
    this.seen = "";
    for (const each of [this.line, this.whiskers, this.rim]) {
      each.begin();
      each.end();
    }
  }
}

/** A shape whose end is next to its start is closed. */
function isClosed(points: Points): boolean {
  const n = points.count;
  if (n <= 3) return false;
  const apart = (a: number, b: number) => Math.hypot(...points.at(a).map((x, k) => x - points.at(b)[k]!));
  return apart(0, n - 1) < 2.1 * apart(0, 1);
}

function leaps(deviation: Float32Array, a: number, b: number): boolean {
  const [d, d0] = [deviation.subarray(3 * b, 3 * b + 3), deviation.subarray(3 * a, 3 * a + 3)];
  // A deviation that is not known is not near to any.
  return !(Math.hypot(...d.map((v, k) => v - d0[k]!)) < LEAP * Math.hypot(...d));
}
