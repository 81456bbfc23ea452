// Problems of a study in the words of the page: the field as it is labelled, the limit with its unit, the value that was given.

import { named } from "./tables/schema";

export interface ProblemWords {
  /** The field, such as "Analysis 1, tolerance"; null if the message names none. */
  field: string | null;
  /** What is wrong, without the field. */
  what: string;
}

/** Labels of the live view, by the key of the study that they set. */
const LABELS: Record<string, string> = {
  centre_mm: "part position",
  tolerance_um: "tolerance",
  tilt_deg: "tilt",
  flange_from_tool_mm_deg: "tool length and orientation",
  cases_n: "load cases",
  half_size_mm: "half-width",
  step_mm: "grid step",
  spin_deg: "tool spin",
  axial_depth_mm: "depth of cut",
  radial_depth_mm: "width of cut",
  feed_mm_per_min: "feed",
  spindle_rpm: "spindle speed",
  diameter_mm: "diameter",
  corner_radius_mm: "corner radius",
  spin_curve_mm_deg: "spin along the path, point",
};
/** Lists of three coordinates: each has its own field in the live view. */
const AXES: Record<string, string[]> = { centre_mm: ["distance x", "sideways y", "height z"] };

/** `analysis[0].plane.step_mm`: "analysis 1, plane, grid step". */
export function fieldWords(path: string): string {
  const parts = path.split(".").map((part, i, all) => {
    const [, key = part, rest = ""] = /^([^[]*)((?:\[\d+\])*)$/.exec(part) ?? [];
    const indices = [...rest.matchAll(/\d+/g)].map(([n]) => Number(n));
    const axis = AXES[key]?.[indices[0] ?? -1];
    if (axis) return axis;
    const name = LABELS[key] ?? (i === all.length - 1 || key.includes("_") ? named(key).name : key);
    return [name, ...indices.map((n) => n + 1)].join(" ");
  });
  // The plane of the study has its fields in the live view without a heading.
  return parts.filter((part, i) => !(part === "plane" && i < parts.length - 1)).join(", ");
}

/** The key that a message is about, as the study writes it; null if it names none. */
export const pathOf = (message: string): string | null => /^`([\w.[\]-]+)`/.exec(message)?.[1] ?? null;

export function problemWords(message: string): ProblemWords {
  const path = pathOf(message);
  if (path === null) return { field: null, what: units(message) };
  const rest = message.slice(path.length + 2);
  const [, given, limit] = /^ is (?:the (?:number|string|boolean) )?(.+?): (must be .+)$/s.exec(rest) ?? [];
  const what = given !== undefined && limit !== undefined ? `${limit} (got ${given})` : rest.trimStart().replace(/^: /, "");
  return { field: capital(fieldWords(path)), what: units(what) };
}

/** As one sentence. */
export function problemSentence(message: string): string {
  const { field, what } = problemWords(message);
  return field === null ? capital(what) : `${field}: ${what}`;
}

const capital = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

/** Units after a number as people write them, and names in quotation marks. */
const units = (text: string): string => text.replace(/`([^`]+)`/g, "“$1”").replace(/(?<=\d) um\b/g, " µm").replace(/(?<=\d) deg\b/g, "°").replace(/(?<![\w.)\]])-(?=\d)/g, "\u2212");
