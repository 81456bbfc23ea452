import { expect, test } from "vitest";
import { beginning, fieldsOf, named, type Schema } from "../../src/tables/schema";

const SCHEMA: Schema = {
  type: "object",
  required: ["tolerance_um", "plane"],
  properties: {
    tolerance_um: { type: "number", minimum: 0, maximum: 1e9, description: "Greatest\ndeviation." },
    load_dependent: { type: "boolean" },
    title: { type: ["string", "null"] },
    plane: { $ref: "#/$defs/Plane" },
    place: { anyOf: [{ $ref: "#/$defs/Place" }, { type: "null" }] },
    analysis: { type: "array", items: { $ref: "#/$defs/Plane" } },
  },
  $defs: {
    Plane: { type: "object", properties: { half_size_mm: { anyOf: [{ type: "number" }, { type: "array", items: { type: "number" }, minItems: 2, maxItems: 2 }] }, cases_n: { type: "array", items: { type: "array", items: { type: "number" } } } } },
    Place: { type: "object", properties: { x_mm: { type: ["array", "null"], items: { type: "number", minimum: -1, maximum: 1 }, minItems: 2, maxItems: 2 }, joints_deg: { type: "array", items: { type: "number" } }, goal: { anyOf: [{ $ref: "#/$defs/Goal" }, { type: "null" }] } } },
    Goal: { oneOf: [{ type: "string", const: "worst", description: "The largest." }, { type: "string", const: "mean" }] },
  },
};

test("each field has the kind of its schema, behind references and without null", () => {
  const fields = fieldsOf(SCHEMA, SCHEMA);
  const of = (key: string) => fields.find((f) => f.key === key)!;
  expect(of("tolerance_um")).toEqual({ key: "tolerance_um", about: "Greatest deviation.", needed: true, kind: { of: "number", least: 0, most: 1e9 } });
  expect(of("load_dependent").kind).toEqual({ of: "flag" });
  expect(of("title").kind).toEqual({ of: "text" });
  expect(of("analysis").kind.of).toBe("tables");
  const plane = of("plane").kind;
  if (plane.of !== "table") throw new Error(plane.of);
  expect(plane.fields.map((f) => f.kind.of)).toEqual(["numbers", "list"]);
  const place = of("place").kind;
  if (place.of !== "table") throw new Error(place.of);
  expect(place.fields[0]!.kind).toEqual({ of: "numbers", count: 2, least: -1, most: 1 });
  expect(place.fields[1]!.kind).toEqual({ of: "numbers", count: null, least: null, most: null });
  expect(place.fields[2]!.kind).toEqual({ of: "choice", options: [{ value: "worst", about: "The largest." }, { value: "mean", about: "" }] });
});

test("the unit is the end of a key", () => {
  expect(named("x_mm")).toEqual({ name: "x", unit: "mm" });
  expect(named("flange_from_tool_mm_deg")).toEqual({ name: "flange from tool", unit: "mm, °" });
  expect(named("u_rad_per_n_m")).toEqual({ name: "u", unit: "rad/(N m)" });
  expect(named("turn_deg_per_mm")).toEqual({ name: "turn", unit: "°/mm" });
  expect(named("cases_n")).toEqual({ name: "cases", unit: "N" });
  expect(named("kind")).toEqual({ name: "kind", unit: "" });
});

test("a new entry has what its table needs, within its bounds, and no more", () => {
  const schema: Schema = {
    type: "object",
    required: ["kind", "name", "mass_kg", "centre_mm", "files", "inner", "least_mm"],
    properties: {
      kind: { oneOf: [{ const: "map" }, { const: "path" }] },
      name: { type: "string" },
      mass_kg: { type: "number", minimum: 0 },
      centre_mm: { type: "array", items: { type: "number", minimum: -1, maximum: 1 }, minItems: 3, maxItems: 3 },
      files: { type: "array", items: { type: "string" } },
      inner: { type: "object", required: ["on"], properties: { on: { type: "boolean" }, off: { type: "boolean" } } },
      least_mm: { type: "number", minimum: 5 },
      title: { type: "string" },
    },
  };
  expect(beginning(fieldsOf(schema, schema))).toEqual({ kind: "map", name: "", mass_kg: 0, centre_mm: [0, 0, 0], files: [], inner: { on: false }, least_mm: 5 });
});
