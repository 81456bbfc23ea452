import * as THREE from "three";
import { describe, expect, it } from "vitest";
import { PathTree, Screen } from "../../src/scene/path-tree";
import { Points } from "../../src/scene/points";
import type { ScenePoints } from "../../src/types";

const [WIDTH, HEIGHT] = [800, 600];

/** A spiral of passes over a dome. */
function path(count: number): Points {
  const xyz_mm = Array.from({ length: count }, (_, i): [number, number, number] => {
    const t = i / count;
    return [1000 + 300 * t * Math.cos(200 * t), 300 * t * Math.sin(200 * t), 500 - 200 * t * t];
  });
  const in_plane_um = xyz_mm.map((_, i) => (i === 54_321 ? 900 : 100 + (i % 7)));
  return Points.ofAnswer({ xyz_mm, deviation_um: xyz_mm.map(() => null), outside_joint_limits: [], columns: { in_plane_um } } as unknown as ScenePoints);
}

function screen(from: [number, number, number], to: [number, number, number]): Screen {
  const camera = new THREE.PerspectiveCamera(32, WIDTH / HEIGHT, 1, 60000);
  camera.up.set(0, 0, 1);
  camera.position.set(...from);
  camera.lookAt(...to);
  camera.updateMatrixWorld();
  return new Screen(camera, WIDTH, HEIGHT);
}

const points = path(100_000);
const tree = new PathTree(points);
const far = screen([-500, -1200, 1500], [1000, 0, 400]);
const near = screen([1080, -40, 560], [1150, 0, 470]);
/** The camera is between the points. */
const within = screen([1000, 0, 480], [1200, 0, 410]);

/** Where each point is in the picture: x, y, and the distance from the camera. */
function projected(view: Screen): Float64Array[] {
  return Array.from({ length: points.count }, (_, i) => {
    const out = new Float64Array(3);
    view.project(...points.at(i), out);
    return out;
  });
}

describe("the tree of a path", () => {
  it("finds the point under the pointer that a look at every point finds", () => {
    for (const [name, view] of Object.entries({ far, near, within })) {
      const all = projected(view);
      const inside = ([x, y, w]: Float64Array) => w! > 0 && x! > 0 && x! < WIDTH && y! > 0 && y! < HEIGHT;
      const there = all.filter(inside);
      expect(there.length, name).toBeGreaterThan(50);
      const some = there.filter((_, i) => i % Math.ceil(there.length / 40) === 0).map(([x, y]) => [x! + 5, y! - 4] as const);
      for (const [x, y] of [...some, [20, 20] as const, [790, 30] as const]) {
        const apart = all.map(([px, py, w]) => (w! > 0 ? Math.hypot(px! - x, py! - y) : Infinity));
        const least = apart.reduce((a, b) => Math.min(a, b));
        const given = tree.nearest(view, x, y, 9);
        if (least >= 9) expect(given, `${name} ${x} ${y}`).toBeNull();
        else expect(apart[given!], `${name} ${x} ${y}`).toBe(least);
      }
    }
  });

  it("looks at few points of a long path", () => {
    let projected = 0;
    const counted = Object.create(far) as Screen;
    counted.project = (...args) => (projected++, far.project(...args));
    expect(tree.nearest(counted, 400, 300, 9)).not.toBeNull();
    expect(projected).toBeLessThan(4000);
  });

  it("draws parts smaller than a pixel as one point, and no peak is lost", () => {
    const shown: number[] = [];
    tree.visible(far, 4, points.column("in_plane_um")!, Infinity, (index) => shown.push(index));
    expect(shown.length).toBeLessThan(points.count / 3);
    expect(shown).toContain(54_321);
    expect(shown.every((index, i) => i === 0 || index > shown[i - 1]!)).toBe(true);
  });

  it("ends where there would be too many points", () => {
    let count = 0;
    expect(tree.visible(far, 0, points.column("in_plane_um")!, 500, () => count++)).toBe(false);
    expect(count).toBeLessThan(520);
  });

  it("has every point that is in the picture, in the drawing and in its ranges", () => {
    for (const view of [far, near, within]) {
      const shown: number[] = [];
      tree.visible(view, 0, points.column("in_plane_um")!, Infinity, (index) => shown.push(index));
      const there = new Set(shown);
      const ranges = tree.ranges(view);
      const out = new Float64Array(3);
      for (let i = 0; i < points.count; i += 7) {
        view.project(...points.at(i), out);
        const inside = out[2]! > 0 && out[0]! >= 0 && out[0]! <= WIDTH && out[1]! >= 0 && out[1]! <= HEIGHT;
        if (!inside) continue;
        expect(there.has(i), String(i)).toBe(true);
        expect(ranges.some(([first, end]) => first <= i && i < end), String(i)).toBe(true);
      }
    }
    expect(tree.ranges(near).reduce((sum, [first, end]) => sum + end - first, 0)).toBeLessThan(points.count / 2);
  });
});
