// The machined part: its surface in the colours of its deviation, drawn displaced along the normals by a multiple of it; in process it is
// plain, lighter where it is cut. The multiple is one number of the picture: nothing is sent to the graphics card when it changes.

import * as THREE from "three";
import { TriangleBoxes, nearest, type Hit } from "../machined-part/boxes";
import { colourTable, scaleOf } from "../machined-part/colours";
import { filled } from "../machined-part/fill";
import type { PartState } from "../machined-part/state";
import type { PartSurface, Quantity } from "../machined-part/surface";
import { measured } from "../measured";
import { matrixOf } from "./bodies";
import { shade, type Rgb } from "./colour";
import type { Labels } from "./labels";

/** Colours are so much darker than in the legend, so that the lights of the stage do not take them beyond white. */
const UNDER_LIGHT = 0.72;
/** Opacity of a surface of an earlier state of the study. */
const STALE = 0.35;

interface Drawn {
  surface: PartSurface;
  quantity: Quantity;
  boxes: TriangleBoxes;
}

export class MachinedView {
  readonly group = new THREE.Group();
  private readonly magnified = { value: 0 };
  private readonly mesh = new THREE.Mesh(new THREE.BufferGeometry(), material(this.magnified));
  private drawn: Drawn | null = null;
  private theme = "";

  constructor(private readonly labels: Labels) {
    this.group.matrixAutoUpdate = false;
    this.group.visible = false;
    // Displaced vertices are outside of the box of the geometry.
    this.mesh.frustumCulled = false;
    this.group.add(this.mesh);
  }

  draw(part: PartState, tolerance_um: number): void {
    const { surface } = part;
    this.group.visible = surface !== null && part.visible;
    this.labels.group("machined");
    if (!this.group.visible || !surface) {
      if (!surface) this.clear();
      return;
    }
    this.group.matrix.copy(matrixOf(surface.about.program));
    this.group.matrixWorldNeedsUpdate = true;
    if (this.drawn?.surface !== surface) this.build(surface);
    const theme = document.documentElement.dataset.theme ?? "";
    if (this.drawn?.surface !== surface || this.drawn.quantity !== part.quantity || theme !== this.theme) this.paint(surface, part.quantity);
    this.theme = theme;
    this.magnified.value = part.magnified;
    const { material } = this.mesh;
    material.opacity = part.stale ? STALE : 1;
    if (material.transparent !== part.stale) {
      material.transparent = part.stale;
      material.needsUpdate = true;
    }
    if (!surface.finished || part.stale) return;
    surface.about.part!.worst_places.forEach(({ xyz_mm, deviation_um }, i) => {
      const at = new THREE.Vector3(...(xyz_mm as [number, number, number])).applyMatrix4(this.group.matrix);
      this.labels.add("machined", at, String(i + 1), Math.abs(deviation_um) > tolerance_um ? "place over" : "place");
    });
  }

  /** The first place of the surface on a ray of base; null without any. */
  under(ray: THREE.Ray): Hit | null {
    if (!this.group.visible || !this.drawn) return null;
    const own = ray.clone().applyMatrix4(this.group.matrix.clone().invert());
    return this.drawn.boxes.under(own.origin.toArray(), own.direction.toArray(), this.magnified.value);
  }

  /** The point of the path whose move made the surface there; -1 of the stock. */
  pointOf(hit: Hit): number {
    return this.drawn ? this.drawn.surface.points[nearest(this.drawn.surface, hit)]! : -1;
  }

  /** Diagonal of the surface, mm. */
  get size(): number {
    this.mesh.geometry.computeBoundingBox();
    return this.mesh.geometry.boundingBox?.getSize(new THREE.Vector3()).length() || 100;
  }

  private build(surface: PartSurface): void {
    this.mesh.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(surface.triangles, 1));
    geometry.setAttribute("position", new THREE.BufferAttribute(surface.xyz, 3));
    geometry.setAttribute("normal", new THREE.InterleavedBufferAttribute(new THREE.InterleavedBuffer(surface.normals, 4), 3, 0, true));
    this.mesh.geometry = geometry;
    this.drawn = null;
  }

  /** Colours and offsets of a quantity. */
  private paint(surface: PartSurface, quantity: Quantity): void {
    const begun = performance.now();
    const { vertices } = surface.about;
    const column = surface.column(quantity);
    const predicted = surface.column("deviation_um");
    const values = column && predicted && column !== predicted ? filled(column, surface.triangles, predicted) : column;
    const colours = new Float32Array(3 * vertices);
    const offsets = new Float32Array(vertices);
    const scale = scaleOf(surface);
    const [plain, cut] = ["--part-plain", "--part-cut"].map((name) => shade(name).toArray() as Rgb);
    const table = scale && colourTable(scale);
    for (let v = 0; v < vertices; v++) {
      const value = values ? values[v]! : NaN;
      const known = table !== null && !Number.isNaN(value);
      const unknown = surface.finished || surface.points[v]! < 0 ? plain! : cut!;
      colours.set(known ? table.of(value) : unknown, 3 * v);
      if (known) offsets[v] = value / 1000;
    }
    this.mesh.geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
    this.mesh.geometry.setAttribute("offset", new THREE.BufferAttribute(offsets, 1));
    this.drawn = { surface, quantity, boxes: new TriangleBoxes(surface, offsets) };
    measured("machined", begun);
  }

  private clear(): void {
    if (!this.drawn) return;
    this.mesh.geometry.dispose();
    this.mesh.geometry = new THREE.BufferGeometry();
    this.drawn = null;
  }
}

/** As that of the bodies, with vertices displaced by `magnified` times their offset. */
function material(magnified: { value: number }): THREE.MeshStandardMaterial {
  const made = new THREE.MeshStandardMaterial({ color: new THREE.Color().setScalar(UNDER_LIGHT), roughness: 0.75, metalness: 0, vertexColors: true, flatShading: true, side: THREE.DoubleSide });
  made.onBeforeCompile = (shader) => {
    shader.uniforms["magnified"] = magnified;
    shader.vertexShader = shader.vertexShader
      .replace("#include <common>", "#include <common>\nattribute float offset;\nuniform float magnified;")
      .replace("#include <begin_vertex>", "vec3 transformed = position + normal * (offset * magnified);");
  };
  return made;
}
