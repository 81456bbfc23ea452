import { describe, expect, it } from "vitest";
import { TriangleBoxes, nearest, valueAt, type Vec } from "../../src/machined-part/boxes";
import { colourTable, scaleOf } from "../../src/machined-part/colours";
import { filled } from "../../src/machined-part/fill";
import { PartSurface } from "../../src/machined-part/surface";

/** A surface as the server sends it. */
function sent({ triangles, xyz, normals, values }: { triangles: number[]; xyz: number[]; normals: number[]; values: Record<string, number[]> }, range_um: number | null): ArrayBuffer {
  const vertices = xyz.length / 3;
  const deviations = Object.keys(values);
  const about = {
    points: 7,
    vertices,
    triangles: triangles.length / 3,
    program: { xyz_mm: [1, 2, 3], quaternion_wxyz: [1, 0, 0, 0] },
    columns: [
      ...[["triangles", 3], ["xyz_mm", 3], ["normal", 1], ["point", 1]].map(([key, components]) => ({ key, components, range_um: null })),
      ...deviations.map((key) => ({ key, components: 1, range_um: key === "u_um" ? null : range_um })),
    ],
    part: deviations.length > 0 ? { worst_places: [] } : null,
  };
  const text = JSON.stringify(about);
  const header = new TextEncoder().encode(text + " ".repeat((4 - (text.length % 4)) % 4));
  const words = triangles.length + xyz.length + 2 * vertices + deviations.length * vertices;
  const bytes = new ArrayBuffer(4 + header.length + 4 * words);
  const view = new DataView(bytes);
  view.setUint32(0, header.length, true);
  new Uint8Array(bytes).set(header, 4);
  let at = 4 + header.length;
  const next = () => (at += 4) - 4;
  triangles.forEach((v) => view.setUint32(next(), v, true));
  xyz.forEach((x) => view.setFloat32(next(), x, true));
  for (let v = 0; v < vertices; v++) {
    const start = next();
    for (let k = 0; k < 3; k++) view.setInt8(start + k, 127 * normals[3 * v + k]!);
  }
  for (let v = 0; v < vertices; v++) view.setInt32(next(), v - 1, true);
  for (const key of deviations) values[key]!.forEach((value) => view.setFloat32(next(), value, true));
  return bytes;
}

/** The square from 0 to 1 at z = 2, normal along z. */
const SQUARE = { triangles: [0, 1, 2, 0, 2, 3], xyz: [0, 0, 2, 1, 0, 2, 1, 1, 2, 0, 1, 2], normals: [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1] };

describe("the surface of a machined part", () => {
  it("is read without conversion, with what is known of each vertex", () => {
    const surface = PartSurface.read(sent({ ...SQUARE, values: { deviation_um: [1, 2, NaN, -40], u_um: [5, 6, NaN, 8] } }, 30));
    expect([...surface.triangles]).toEqual(SQUARE.triangles);
    expect([...surface.xyz]).toEqual(SQUARE.xyz);
    expect([...surface.normals].slice(0, 4)).toEqual([0, 0, 127, 0]);
    expect([...surface.points]).toEqual([-1, 0, 1, 2]);
    expect([...surface.column("deviation_um")!]).toEqual([1, 2, NaN, -40]);
    expect([...surface.column("u_um")!]).toEqual([5, 6, NaN, 8]);
    expect([surface.column("measured_um"), surface.finished, surface.range_um]).toEqual([null, true, 30]);
    expect(surface.quantities.map(({ key }) => key)).toEqual(["deviation_um"]);
  });

  it("in process has no deviations", () => {
    const surface = PartSurface.read(sent({ ...SQUARE, values: {} }, null));
    expect([surface.finished, surface.range_um, scaleOf(surface), surface.quantities]).toEqual([false, null, null, []]);
  });

  it("of another length is refused", () => {
    const bytes = sent({ ...SQUARE, values: {} }, null);
    expect(() => PartSurface.read(bytes.slice(0, -4))).toThrow(/bytes in place of/);
    expect(() => PartSurface.read(bytes.slice(0, 20))).toThrow("20 bytes without a header");
    expect(() => PartSurface.read(new ArrayBuffer(2))).toThrow("2 bytes without a header");
  });
});

describe("colours of the part", () => {
  it("are blue where too much is removed, red where material is left, and the same for all quantities", () => {
    const surface = PartSurface.read(sent({ ...SQUARE, values: { deviation_um: [1, 2, 3, 4], measured_um: [1, 2, 3, 4] } }, 173));
    const scale = scaleOf(surface)!;
    expect([scale[0], scale.at(-1)]).toEqual([-200, 200]);
    const { of } = colourTable(scale);
    const [blue, white, red] = [of(-200), of(0), of(200)];
    expect(blue[2]).toBeGreaterThan(3 * blue[0]);
    expect(red[0]).toBeGreaterThan(3 * red[2]);
    expect(Math.min(...white)).toBeGreaterThan(0.9);
    // Beyond the ends the nearer end.
    expect([of(-1e9), of(1e9)]).toEqual([blue, red]);
  });
});

/** A wavy sheet of n x n squares of 1 mm, with offsets of 1 mm at every third vertex. */
function sheet(n: number) {
  const xyz = new Float32Array(3 * (n + 1) ** 2);
  const normals = new Int8Array(4 * (n + 1) ** 2);
  const offsets = new Float32Array((n + 1) ** 2);
  const triangles: number[] = [];
  for (let i = 0; i <= n; i++)
    for (let j = 0; j <= n; j++) {
      const v = i * (n + 1) + j;
      xyz.set([j, i, 3 * Math.sin(0.3 * i) * Math.cos(0.2 * j)], 3 * v);
      normals[4 * v + 2] = 127;
      offsets[v] = v % 3 === 0 ? 1 : v % 7 === 0 ? NaN : 0;
      if (i < n && j < n) triangles.push(v, v + 1, v + n + 2, v, v + n + 2, v + n + 1);
    }
  return { surface: { xyz, normals, triangles: new Uint32Array(triangles) }, offsets };
}

/** What the ray meets first, by all triangles: as in `TriangleBoxes`, without boxes, by planes. */
function bruteForce({ surface, offsets }: ReturnType<typeof sheet>, origin: Vec, direction: Vec, times: number): number | null {
  const dot = (a: Vec, b: Vec) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a: Vec, b: Vec): Vec => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const minus = (a: Vec, b: Vec): Vec => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const vertex = (v: number): Vec => [surface.xyz[3 * v]!, surface.xyz[3 * v + 1]!, surface.xyz[3 * v + 2]! + times * (offsets[v]! || 0)];
  let first: number | null = null;
  for (let t = 0; 3 * t < surface.triangles.length; t++) {
    const [a, b, c] = [0, 1, 2].map((k) => vertex(surface.triangles[3 * t + k]!)) as [Vec, Vec, Vec];
    const normal = cross(minus(b, a), minus(c, a));
    const distance = dot(normal, minus(a, origin)) / dot(normal, direction);
    const at: Vec = [0, 1, 2].map((k) => origin[k]! + distance * direction[k]!) as Vec;
    const inside = [[a, b], [b, c], [c, a]].every(([p, q]) => dot(normal, cross(minus(q!, p!), minus(at, p!))) >= 0);
    if (inside && distance >= 0 && (first === null || distance < first)) first = distance;
  }
  return first;
}

describe("boxes of triangles", () => {
  it("find what a ray meets first, as a search of all triangles, also displaced", () => {
    const made = sheet(40);
    const boxes = new TriangleBoxes(made.surface, made.offsets);
    let met = 0;
    for (const times of [0, 5])
      for (let k = 0; k < 60; k++) {
        const origin: Vec = [-5 + 0.83 * k, 47 - 0.79 * k, 30];
        const direction: Vec = [0.3 * Math.sin(k), 0.4 * Math.cos(2 * k), -1];
        const expected = bruteForce(made, origin, direction, times);
        const hit = boxes.under(origin, direction, times);
        if (expected === null) expect(hit).toBeNull();
        else {
          met++;
          expect(hit!.distance).toBeCloseTo(expected, 5);
          expect(hit!.weights.reduce((a, b) => a + b)).toBeCloseTo(1, 12);
        }
      }
    expect(met).toBeGreaterThan(50);
  });

  it("a displaced surface is not met where it was", () => {
    const [offsets, square] = [new Float32Array([0.5, 0.5, 0.5, 0.5]), PartSurface.read(sent({ ...SQUARE, values: {} }, null))];
    const boxes = new TriangleBoxes(square, offsets);
    const height = (times: number) => 10 - (boxes.under([0.4, 0.3, 10], [0, 0, -1], times)?.distance ?? NaN);
    expect([height(0), height(4), height(-2)]).toEqual([2, 4, 1]);
    expect(boxes.under([1.4, 0.3, 10], [0, 0, -1], 0)).toBeNull();
    // Behind the origin is nothing.
    expect(boxes.under([0.4, 0.3, 10], [0, 0, 1], 0)).toBeNull();
    // Along the sheet, at its height and above it.
    expect(boxes.under([-1, 0.5, 3], [1, 0, 0], 0)).toBeNull();
  });

  it("a value is between those of the vertices, or that of the nearest where one is not known", () => {
    const hit = { triangle: 0, distance: 1, weights: [0.25, 0.25, 0.5] as Vec };
    const surface = { triangles: new Uint32Array([4, 2, 0]) };
    expect(valueAt(surface, [8, 0, 4, 0, 0], hit)).toBe(5);
    expect(valueAt(surface, [8, 0, NaN, 0, 0], hit)).toBe(8);
    expect(valueAt(surface, [NaN, 0, 4, 0, 0], hit)).toBeNaN();
    expect(nearest(surface, hit)).toBe(0);
  });
});

describe("between measured points", () => {
  it("is the mean of the neighbours, and nothing far from them", () => {
    // A strip of triangles: vertex v has the neighbours v - 2, v - 1, v + 1, v + 2.
    const triangles = new Uint32Array(Array.from({ length: 30 }, (_, t) => [t, t + 1, t + 2]).flat());
    const values = new Float32Array(32).fill(NaN);
    [values[0], values[2]] = [10, 20];
    const compared = new Float32Array(32);
    const found = filled(values, triangles, compared);
    // Edges inside of the strip are in two triangles and count twice: vertex 1 has 0 and 2, once and twice.
    expect([found[0], found[2]]).toEqual([10, 20]);
    expect(found[1]).toBeGreaterThan(10);
    expect(found[1]).toBeLessThan(20);
    expect([found[3], found[4], found[10]]).toEqual([20, 20, 20]);
    expect(found[11]).toBeNaN();
    expect(values[1]).toBeNaN();
    // Where nothing is compared, nothing is drawn, and nothing is reached through it.
    compared.fill(NaN, 3, 5);
    expect([...filled(values, triangles, compared)].slice(3, 8)).toEqual([NaN, NaN, NaN, NaN, NaN]);
  });
});
