// Deviation of a surface to colour: blue where too much is removed, red where material is left, as in the pictures of the command.

import * as THREE from "three";
import { aboutZero } from "../scene/difference";
import { along, diverging, type Scale } from "../scene/colour";
import type { Layer } from "../scene/layers";
import { um } from "../format";
import type { PartSurface } from "./surface";

/** What colours of a machined part show. */
export const LAYER: Layer = { title: "Deviation of the surface", unit: "µm", text: (v) => `${v > 0 ? "+" : ""}${um(v)}`, tolerance: false, diverging: true, about: "+ material left, − gouged" };

/** Colours of a table. */
const STEPS = 512;

/** Round levels of the range of its colours; null where no deviation is known. */
export const scaleOf = (surface: PartSurface): Scale | null => (surface.range_um === null ? null : aboutZero([surface.range_um]));

/** The colours of a scale as the scene adds light to them: linear components, 0 to 1. */
export function colourTable(scale: Scale): { of: (value: number) => [number, number, number] } {
  const colour = new THREE.Color();
  const table = Array.from({ length: STEPS }, (_, i) => colour.setRGB(...diverging(i / (STEPS - 1)), THREE.SRGBColorSpace).toArray() as [number, number, number]);
  return { of: (value) => table[Math.round(Math.min(1, Math.max(0, along(scale, value))) * (STEPS - 1))]! };
}
