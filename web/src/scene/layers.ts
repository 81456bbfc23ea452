// What colours show: one entry of this list for each quantity that the server gives at every point. Legend, tooltip, colours
// and lines follow the entry. To add one: its variant in `crates/study/src/live/layer.rs`, `npm run types`, its entry here.

import { fixed, percent, trimmed, um } from "../format";
import type { Live } from "../live";
import type { LayerAnswer, LayerKey, Line } from "../types";
import { along, diverging, viridis, type Rgb, type Scale } from "./colour";
import { minusPinned, whyNot } from "./difference";
import type { Values } from "./points";

export interface Layer {
  title: string;
  /** Empty if the values have none. */
  unit: string;
  /** A value without unit, as the tooltip shows it. */
  text: (value: number) => string;
  /** Whether values are compared with the tolerance. */
  tolerance: boolean;
  /** Whether values are names, not sizes. */
  named?: boolean;
  /** Whether values are about zero: differences. */
  diverging?: boolean;
  /** What it is, where the title does not say it. */
  about?: string;
}

export const LAYERS: Record<LayerKey, Layer> = {
  in_plane_um: { title: "In-plane deviation", unit: "µm", text: um, tolerance: true },
  normal_um: { title: "Deviation along the normal", unit: "µm", text: um, tolerance: false, about: "positive out of the part" },
  full_um: { title: "Full deviation", unit: "µm", text: um, tolerance: false },
  in_plane_u_um: { title: "Uncertainty of the in-plane deviation", unit: "µm", text: um, tolerance: false, about: "one standard uncertainty" },
  probability_within: { title: "Probability within the tolerance", unit: "", text: percent, tolerance: false },
  limit_margin_deg: { title: "Margin to the joint limits", unit: "°", text: (v) => fixed(v, 1), tolerance: false, about: "negative outside" },
  largest_share: { title: "Largest contributor", unit: "", text: String, tolerance: false, named: true, about: "largest share of the in-plane deviation" },
};

/** The one that is shown first, whose values are in every answer. */
export const FIRST: LayerKey = "in_plane_um";

/** The colours of names: Okabe and Ito 2008, safe for the colour-blind. */
const NAMED = [0xe69f00, 0x56b4e9, 0x009e73, 0xf0e442, 0x0072b2, 0xd55e00, 0xcc79a7, 0x7f7f7f, 0x3b3b98, 0x9acd32];
const NONE: Rgb = [0.55, 0.58, 0.62];
/** Of a point where no posture keeps the demanded clearance. */
export const COLLISION: Rgb = [0.8, 0.15, 0.18];

/** A layer with its values. */
export interface ShownLayer {
  key: LayerKey;
  layer: Layer;
  /** Null if no point has a value, and for names. */
  scale: Scale | null;
  names: string[];
  /** Of a map by its index, of points 0. */
  values: (index: number) => Values;
  lines: (index: number) => { level: number; lines_mm: Line[] }[];
}

/** The chosen layer; its difference to the pinned state where that is wanted and there is one. */
export function shownLayer(live: Live): ShownLayer {
  const shown = presentLayer(live);
  return live.differs && live.pinned && whyNot(live, shown) === null ? minusPinned(shown, live.pinned) : shown;
}

/** The values of a layer, a list a map: those of a path are in its columns. */
export function valuesOf({ path }: Pick<Live, "path">, { key, values }: LayerAnswer): Values[] {
  const column = path?.get(key);
  return column ? [column] : values;
}

/** The chosen layer, or the first one until its values have come. */
export function presentLayer(live: Live): ShownLayer {
  const got = live.layer_answer;
  if (got && got.key === live.layer) {
    return { key: got.key, layer: LAYERS[got.key], scale: got.levels, names: got.names, values: (i) => valuesOf(live, got)[i] ?? [], lines: (i) => (got.lines[i] ?? []) as { level: number; lines_mm: Line[] }[] };
  }
  return {
    key: FIRST,
    layer: LAYERS[FIRST],
    scale: live.levels_um,
    names: [],
    values: (i) => live.answer?.maps[i]?.grid.in_plane_um ?? live.scene?.points?.column(FIRST) ?? [],
    lines: (i) => (live.lines[i]?.levels ?? []).map(({ level_um, lines_mm }) => ({ level: level_um, lines_mm: lines_mm as Line[] })),
  };
}

/** The colour of a value of this layer; without one, red where the point is in collision, and grey elsewhere. */
export function colourOf({ layer, scale, names }: Pick<ShownLayer, "layer" | "scale" | "names">, value: number | null, collides = false): Rgb {
  if (value === null) return collides ? COLLISION : NONE;
  if (layer.named) return value < names.length ? namedColour(value) : NONE;
  return scale ? (layer.diverging ? diverging : viridis)(along(scale, value)) : NONE;
}

export function namedColour(index: number): Rgb {
  const hex = NAMED[index % NAMED.length]!;
  return [(hex >> 16) / 255, ((hex >> 8) & 255) / 255, (hex & 255) / 255];
}

/** A value with its unit. */
export function textOf({ layer, names }: Pick<ShownLayer, "layer" | "names">, value: number | null | undefined): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "not known";
  if (layer.named) return names[value] ?? "not known";
  return layer.unit === "°" ? `${layer.text(value)}°` : layer.unit ? `${layer.text(value)} ${layer.unit}` : layer.text(value);
}

/** A level at its line or tick. */
export const levelText = (layer: Layer, level: number): string => (layer.unit === "" && !layer.named ? percent(level) : trimmed(level, 2));
