import { describe, expect, it } from "vitest";
import { Axis } from "../../src/timeline/axis";
import { lastFrom, operationBands, toolBands } from "../../src/timeline/bands";
import { columnsOf, PathColumns } from "../../src/timeline/columns";
import { Pyramid } from "../../src/timeline/pyramid";

/** The same numbers at every run. */
function numbers(count: number): Float32Array {
  let state = 12345;
  return Float32Array.from({ length: count }, () => (state = (state * 1103515245 + 12345) % 2 ** 31) / 2 ** 31);
}

describe("the pyramid", () => {
  it("gives the least and largest value of any range, as a scan of its points does", () => {
    const values = numbers(5000);
    values[77] = NaN;
    values.fill(NaN, 1000, 1100);
    const pyramid = new Pyramid(values);
    const ends = [0, 1, 15, 16, 17, 255, 256, 257, 999, 1000, 1050, 1100, 3000, 4095, 4096, 4999, 5000];
    for (const first of ends)
      for (const end of ends) {
        const known = Array.from(values.subarray(first, end)).filter((v) => !Number.isNaN(v));
        expect(pyramid.range(first, end)).toEqual([Math.min(...known), Math.max(...known)]);
      }
  });

  it("reads few values of a long column", () => {
    const count = 1_000_000;
    let read = 0;
    const values = new Proxy(numbers(count), { get: (target, key) => (typeof key === "string" && /^\d+$/.test(key) && read++, Reflect.get(target, key)) });
    const pyramid = new Pyramid(values);
    read = 0;
    pyramid.range(3, count - 3);
    expect(read).toBeLessThan(100);
  });
});

describe("the axis", () => {
  const axis = new Axis(new Float32Array([0, 1, 2, 2, 4, 10]));
  it("has each point at its distance, and finds the nearest one", () => {
    expect([0, 1, 4, 5].map((i) => axis.place(i))).toEqual([0, 0.1, 0.4, 1].map(Math.fround).map((v) => expect.closeTo(v, 6)));
    expect([0, 0.04, 0.06, 0.69, 0.71, 1].map((place) => axis.point(place))).toEqual([0, 0, 1, 4, 5, 5]);
  });

  it("gives each pixel its points, each point to one pixel", () => {
    expect([...axis.pixels(5)]).toEqual([0, 2, 4, 5, 5, 6]);
    const long = new Axis(Float32Array.from({ length: 100_000 }, (_, i) => i * 0.25));
    const starts = long.pixels(640);
    expect([starts[0], starts[640]]).toEqual([0, 100_000]);
    expect(starts.every((start, x) => x === 0 || start >= starts[x - 1]!)).toBe(true);
  });

  it("has the points of a path without length side by side", () => {
    const still = new Axis(new Float32Array(5));
    expect([still.place(0), still.place(2), still.place(4), still.point(0.5)]).toEqual([0, 0.5, 1, 2]);
  });
});

describe("the columns", () => {
  it("are read from little-endian numbers, in the order of the request", () => {
    const bytes = new ArrayBuffer(4 * 2 * 4);
    const view = new DataView(bytes);
    [1, 2, 3, 4, 5, 6, 7, 8.5].forEach((v, i) => view.setFloat32(4 * i, v, true));
    const found = columnsOf(bytes, [{ key: "xyz_mm", components: 3 }, { key: "force_n", components: 1 }], 2);
    expect(found.map(([key, values]) => [key, [...values]])).toEqual([["xyz_mm", [1, 2, 3, 4, 5, 6]], ["force_n", [7, 8.5]]]);
    expect(() => columnsOf(bytes, [{ key: "force_n", components: 1 }], 2)).toThrow("32 bytes in place of 8");
  });

  it("are requested once, and only those that the path has", async () => {
    const requested: string[][] = [];
    const column = (key: string) => ({ key, components: 1, unit: null, joint: null, lower: null, upper: null });
    const path = new PathColumns({ points: 2, columns: [column("a"), column("b")], operations: [], worst: [], has_part: false }, async (keys) => (requested.push(keys), new ArrayBuffer(8 * keys.length)));
    await Promise.all([path.load(["a", "none"]), path.load(["a", "b"])]);
    expect(requested).toEqual([["a"], ["b"]]);
    expect(path.get("b")).toHaveLength(2);
    expect([path.get("none"), path.has("none")]).toEqual([null, false]);
  });
});

describe("the bands", () => {
  const operation = (first: number, points: number, tool: number | null, name: string | null = null) => ({ first, points, tool, name, line: first + 1 });
  it("join consecutive operations with the same tool", () => {
    const operations = [operation(0, 5, 1, "rough"), operation(5, 5, 1), operation(10, 2, 4), operation(12, 2, 1)];
    expect(toolBands(operations).map(({ first, end, text }) => [first, end, text])).toEqual([[0, 10, "T1"], [10, 12, "T4"], [12, 14, "T1"]]);
    expect(operationBands(operations).map(({ text }) => text)).toEqual(["rough", "Operation 2", "Operation 3", "Operation 4"]);
    expect(toolBands([operation(0, 5, null)])).toEqual([]);
  });

  it("contain the points from their first on", () => {
    const bands = [{ first: 2 }, { first: 10 }];
    expect([0, 1, 2, 9, 10, 99].map((index) => lastFrom(bands, index))).toEqual([-1, -1, 0, 0, 1, 1]);
    expect(lastFrom([], 3)).toBe(-1);
  });
});
