// The layer shown minus the same layer of a pinned state, at the same points of the part.

import { niceStep } from "../format";
import type { Live } from "../live";
import type { ArmDrawing, LayerKey, Scene, Vec3 } from "../types";
import type { ShownLayer } from "./layers";
import { known, type Points, type Values } from "./points";

/** What the scene keeps of a pinned state. */
export interface PinnedScene {
  /** The arm as it was drawn. */
  drawing: ArmDrawing | null;
  /** `map`, `path`, ... */
  kind: string;
  /** Where the points are on the part, mm: one list a map. */
  places: ArrayLike<number>[];
  /** Values of a layer, as far as they are known. */
  values: Map<LayerKey, Values[]>;
}

/** Points that are apart by less, mm, are the same. */
const APART_MM = 0.01;

/** Where the points of the present answer are on the part: moved with it they stay the same. */
export function placesOf({ answer, scene }: Pick<Live, "answer" | "scene">): ArrayLike<number>[] {
  if (answer && answer.maps.length > 0) return answer.maps.map(({ grid }) => [...grid.y_mm, ...grid.z_mm]);
  return scene?.points ? [onPart(scene.points, scene)] : [];
}

// Of a path of a million points this is not repeated for each picture.
const places = new WeakMap<Points, Float64Array>();

function onPart(points: Points, scene: Omit<Scene, "points">): Float64Array {
  const found = places.get(points);
  if (found) return found;
  const { origin, axes } = frameOf(scene);
  const made = new Float64Array(3 * points.count);
  for (let i = 0; i < points.count; i++) {
    const at = points.at(i);
    const from: Vec3 = [at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]];
    axes.forEach((axis, k) => (made[3 * i + k] = dot(axis, from)));
  }
  places.set(points, made);
  return made;
}

function frameOf({ box, plate }: Omit<Scene, "points">): { origin: Vec3; axes: Vec3[] } {
  if (box) return { origin: box.corner_mm, axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]] };
  return { origin: plate.centre_mm, axes: [plate.y_axis, plate.z_axis, plate.normal_axis] };
}

const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Why there is no difference to the pinned state; null if there is one. */
export function whyNot(live: Pick<Live, "answer" | "scene" | "values" | "pinned">, shown: ShownLayer): string | null {
  const { pinned } = live;
  if (!pinned) return "Nothing is pinned.";
  if (shown.layer.named) return "Contributors have no difference.";
  if (pinned.kind !== (live.values?.kind ?? "")) return "The pinned state shows another kind of analysis.";
  const now = placesOf(live);
  if (now.length !== pinned.places.length || now.some((list, i) => list.length !== pinned.places[i]!.length)) return "The pinned state has other points.";
  if (now.some((list, i) => areApart(list, pinned.places[i]!))) return "The points are at other places of the part than those pinned.";
  return pinned.values.has(shown.key) ? null : "The pinned values are being computed.";
}

function areApart(a: ArrayLike<number>, b: ArrayLike<number>): boolean {
  if (a === b) return false;
  for (let k = 0; k < a.length; k++) if (Math.abs(a[k]! - b[k]!) > APART_MM) return true;
  return false;
}

// The last differences: every reading of the pointer asks for them.
const differences = new WeakMap<Values, { of: Values; minus: (number | null)[] }>();

function minus(before: Values, now: Values): (number | null)[] {
  const last = differences.get(before);
  if (last?.of === now) return last.minus;
  const made = Array.from({ length: before.length }, (_, k) => {
    const [a, b] = [known(now, k), known(before, k)];
    return a === null || b === null ? null : a - b;
  });
  differences.set(before, { of: now, minus: made });
  return made;
}

/** The values minus those pinned, on a scale about zero. */
export function minusPinned(shown: ShownLayer, pinned: PinnedScene): ShownLayer {
  const values = (pinned.values.get(shown.key) ?? []).map((before, i) => minus(before, shown.values(i)));
  const { text, title } = shown.layer;
  return {
    ...shown,
    layer: { ...shown.layer, title: `${title}, minus pinned`, about: "minus pinned: blue less, red more", tolerance: false, diverging: true, text: (v) => `${v > 0 ? "+" : ""}${text(v)}` },
    scale: aboutZero(values.flat()),
    values: (i) => values[i] ?? [],
    lines: () => [],
  };
}

/** Round levels as far below zero as above it; null without values. */
export function aboutZero(values: (number | null)[]): number[] | null {
  const known = values.filter((v) => v !== null);
  if (known.length === 0) return null;
  const most = known.reduce((m, v) => Math.max(m, Math.abs(v)), 0) || 1;
  const step = niceStep(2 * most, 8);
  const steps = Math.ceil(most / step - 1e-9);
  return Array.from({ length: 2 * steps + 1 }, (_, i) => Number(((i - steps) * step).toPrecision(12)));
}
