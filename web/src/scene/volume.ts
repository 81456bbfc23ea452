// A volume: its edges, the translucent surface around all points within tolerance, and three sections through one of its
// points, coloured by the layer.

import * as THREE from "three";
import type { Scene, Vec3 } from "../types";
import { colourOf, type ShownLayer } from "./layers";
import { known, type Points } from "./points";
import { surfaceBelow } from "./surface";

type Box = NonNullable<Scene["box"]>;

export class VolumeView {
  readonly group = new THREE.Group();
  readonly sections: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>[];
  private readonly surface = new THREE.Mesh(
    new THREE.BufferGeometry(),
    new THREE.MeshStandardMaterial({ color: 0x21918c, transparent: true, opacity: 0.3, side: THREE.DoubleSide, roughness: 0.6, depthWrite: false }),
  );
  private readonly edges = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x6b7683 }));
  private box: Box | null = null;
  private points: Points | null = null;
  /** From base to the unit cube. */
  private back = new THREE.Matrix4();
  /** Points of the answer by their place in the box, x first; -1 where there is none. */
  private order = new Int32Array(0);
  /** The place of the sections. */
  private at: [number, number, number] | null = null;

  constructor() {
    const material = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.sections = [0, 1, 2].map(() => new THREE.Mesh(new THREE.BufferGeometry(), material));
    this.surface.renderOrder = 2;
    this.group.add(this.surface, this.edges, ...this.sections);
  }

  draw({ box, points }: Scene, shown: ShownLayer, tolerance_um: number): void {
    this.group.visible = box !== null;
    this.box = box;
    this.points = points;
    if (!box) return;
    const place = frame(box);
    this.back.copy(place).invert();
    this.edges.geometry.dispose();
    this.edges.geometry = new THREE.EdgesGeometry(new THREE.BoxGeometry(1, 1, 1).translate(0.5, 0.5, 0.5)).applyMatrix4(place);
    this.surface.visible = points !== null;
    if (!points) return;
    const [nx, ny, nz] = box.counts;
    const values: (number | null)[] = Array<number | null>(nx * ny * nz).fill(null);
    this.order = new Int32Array(nx * ny * nz).fill(-1);
    const in_plane = points.column("in_plane_um");
    for (let i = 0; i < points.count; i++) {
      const [x, y, z] = this.placeOf(points.at(i));
      const cell = (z * ny + y) * nx + x;
      values[cell] = known(in_plane, i);
      this.order[cell] = i;
    }
    const mesh = surfaceBelow({ origin_mm: [0, 0, 0], step_mm: 1, counts: box.counts, values }, tolerance_um);
    this.surface.geometry.dispose();
    this.surface.geometry = new THREE.BufferGeometry()
      .setAttribute("position", new THREE.Float32BufferAttribute(mesh.positions, 3))
      .setIndex(mesh.index)
      .applyMatrix4(new THREE.Matrix4().makeScale(1 / Math.max(1, nx - 1), 1 / Math.max(1, ny - 1), 1 / Math.max(1, nz - 1)).premultiply(place));
    this.surface.geometry.computeVertexNormals();
    this.cut(shown, this.at);
  }

  /** Sections through the point at this place (mm), as far as it is in the box; else through the middle. */
  through(point: Vec3 | null, shown: ShownLayer): void {
    if (this.box) this.cut(shown, point ? this.placeOf(point) : null);
  }

  /** The index of the point of the answer that is nearest to this place. */
  nearest(place: THREE.Vector3): number | null {
    if (!this.box) return null;
    const [nx, ny] = this.box.counts;
    const [x, y, z] = this.placeOf([place.x, place.y, place.z]);
    const index = this.order[(z * ny + y) * nx + x] ?? -1;
    return index < 0 ? null : index;
  }

  extent(box: Box): THREE.Box3 {
    return new THREE.Box3(new THREE.Vector3(), new THREE.Vector3(1, 1, 1)).applyMatrix4(frame(box));
  }

  /** Numbers of the point along x, y, z. */
  private placeOf(p: Vec3): [number, number, number] {
    const at = new THREE.Vector3(...p).applyMatrix4(this.back);
    return [at.x, at.y, at.z].map((v, k) => {
      const last = this.box!.counts[k]! - 1;
      return Math.min(last, Math.max(0, Math.round(Number.isFinite(v) ? v * last : 0)));
    }) as [number, number, number];
  }

  private cut(shown: ShownLayer, at: [number, number, number] | null): void {
    const { counts } = this.box!;
    const [nx, ny] = counts;
    const middle = at ?? (counts.map((n) => Math.floor((n - 1) / 2)) as [number, number, number]);
    this.at = at;
    const place = frame(this.box!);
    const values = shown.values(0);
    this.sections.forEach((section, axis) => {
      const [u, v] = [0, 1, 2].filter((k) => k !== axis) as [number, number];
      const [nu, nv] = [counts[u]!, counts[v]!];
      const [positions, colours, index]: [number[], number[], number[]] = [[], [], []];
      const corner = new THREE.Vector3();
      const colour = new THREE.Color();
      for (let j = 0; j < nv; j++)
        for (let i = 0; i < nu; i++) {
          const cell: [number, number, number] = [...middle];
          [cell[u], cell[v]] = [i, j];
          corner.set(...(cell.map((c, k) => c / Math.max(1, counts[k]! - 1)) as Vec3)).applyMatrix4(place);
          positions.push(corner.x, corner.y, corner.z);
          const point = this.order[(cell[2] * ny + cell[1]) * nx + cell[0]]!;
          const [r, g, b] = colourOf(shown, point < 0 ? null : (values[point] ?? null), this.points?.in_collision[point] === 1);
          colours.push(...colour.setRGB(r, g, b, THREE.SRGBColorSpace).toArray());
          if (i + 1 < nu && j + 1 < nv) index.push(j * nu + i, j * nu + i + 1, (j + 1) * nu + i, j * nu + i + 1, (j + 1) * nu + i + 1, (j + 1) * nu + i);
        }
      section.geometry.dispose();
      section.geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(positions, 3)).setAttribute("color", new THREE.Float32BufferAttribute(colours, 3)).setIndex(index);
    });
  }
}

/** From the unit cube to the box. */
function frame({ corner_mm, sides_mm }: Box): THREE.Matrix4 {
  // A side of no length would fold the space flat.
  const [x, y, z] = sides_mm.map((s, i) => (Math.hypot(...s) > 0 ? new THREE.Vector3(...s) : new THREE.Vector3().setComponent(i, 1e-3)));
  return new THREE.Matrix4().makeBasis(x!, y!, z!).setPosition(...corner_mm);
}
