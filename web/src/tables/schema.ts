// What fields a study may have, read off its JSON schema: which kind of value each takes, in which unit, within which
// bounds. The schema is the server's own, so that no field is typed here.

export interface Schema {
  $ref?: string;
  $defs?: Record<string, Schema>;
  type?: string | string[];
  description?: string;
  properties?: Record<string, Schema>;
  required?: string[];
  items?: Schema;
  minItems?: number;
  maxItems?: number;
  minimum?: number;
  maximum?: number;
  anyOf?: Schema[];
  oneOf?: Schema[];
  enum?: string[];
  const?: string;
}

export type Kind =
  | { of: "number"; least: number | null; most: number | null }
  /** `count`: how many, null where any number of them may be. */
  | { of: "numbers"; count: number | null; least: number | null; most: number | null }
  | { of: "choice"; options: { value: string; about: string }[] }
  | { of: "flag" }
  | { of: "text" }
  /** Lists of texts and of lists: as they are written in the file. */
  | { of: "list" }
  | { of: "table"; fields: Field[] }
  | { of: "tables"; fields: Field[] };

export interface Field {
  key: string;
  about: string;
  needed: boolean;
  kind: Kind;
}

/** The fields of a table of this schema; `root` has the definitions. */
export function fieldsOf(schema: Schema, root: Schema): Field[] {
  const own = resolved(schema, root);
  return Object.entries(own.properties ?? {}).map(([key, value]) => ({
    key,
    about: (value.description ?? "").replaceAll("\n", " "),
    needed: own.required?.includes(key) ?? false,
    kind: kindOf(value, root),
  }));
}

/** Behind references, and without the `null` by which the schema says that a value may be left out. */
function resolved(schema: Schema, root: Schema): Schema {
  if (schema.$ref) return resolved(root.$defs?.[schema.$ref.split("/").at(-1)!] ?? {}, root);
  const some = schema.anyOf?.filter((s) => s.type !== "null");
  // One number or several: the several.
  if (some && some.length > 0) return resolved(some.at(-1)!, root);
  return schema;
}

function kindOf(schema: Schema, root: Schema): Kind {
  const own = resolved(schema, root);
  const type = [own.type].flat().find((t) => t !== "null");
  const options = own.oneOf?.filter((s) => s.const !== undefined).map((s) => ({ value: s.const!, about: s.description ?? "" })) ?? own.enum?.map((value) => ({ value, about: "" }));
  if (options && options.length > 0) return { of: "choice", options };
  const bounds = (s: Schema) => ({ least: s.minimum ?? null, most: s.maximum ?? null });
  if (type === "number" || type === "integer") return { of: "number", ...bounds(own) };
  if (type === "boolean") return { of: "flag" };
  if (type === "string") return { of: "text" };
  if (type === "object") return { of: "table", fields: fieldsOf(own, root) };
  const items = own.items ? resolved(own.items, root) : {};
  const inner = [items.type].flat().find((t) => t !== "null");
  if (inner === "object") return { of: "tables", fields: fieldsOf(items, root) };
  if (inner === "number" || inner === "integer") return { of: "numbers", count: own.minItems !== undefined && own.minItems === own.maxItems ? own.minItems : null, ...bounds(items) };
  return { of: "list" };
}

/** A new table with its required keys: values without a default are empty, and the server reports them. */
export function beginning(fields: Field[]): Record<string, unknown> {
  const needed = fields.filter((f) => f.needed);
  return Object.fromEntries(needed.map((f) => [f.key, first(f.kind)]));
}

function first(kind: Kind): unknown {
  const zero = ({ least, most }: { least: number | null; most: number | null }) => Math.min(Math.max(0, least ?? 0), most ?? Infinity);
  switch (kind.of) {
    case "number":
      return zero(kind);
    case "numbers":
      return Array<number>(kind.count ?? 0).fill(zero(kind));
    case "choice":
      return kind.options[0]!.value;
    case "flag":
      return false;
    case "text":
      return "";
    case "table":
      return beginning(kind.fields);
    case "list":
    case "tables":
      return [];
  }
}

const UNITS: [string, string][] = [
  ["_mm_deg", "mm, °"],
  ["_rad_per_n_m", "rad/(N m)"],
  ["_deg_per_mm", "°/mm"],
  ["_mm_per_min", "mm/min"],
  ["_um_per_n", "µm/N"],
  ["_um_mm", "µm mm"],
  ["_n_m", "N m"],
  ["_gpa", "GPa"],
  ["_percent", "%"],
  ["_rpm", "1/min"],
  ["_deg", "°"],
  ["_mm", "mm"],
  ["_um", "µm"],
  ["_kg", "kg"],
  ["_s", "s"],
  ["_n", "N"],
];

/** The words of a key, and its unit. */
export function named(key: string): { name: string; unit: string } {
  const found = UNITS.find(([end]) => key.endsWith(end) && key.length > end.length);
  const [end, unit] = found ?? ["", ""];
  return { name: key.slice(0, key.length - end.length).replaceAll("_", " "), unit };
}
