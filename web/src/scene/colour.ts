// Deviation to colour: viridis (Smith & van der Walt 2015), even in lightness and safe for the colour-blind, the same
// as in the pictures of the command. Ten anchors of the published table, linear between.

import * as THREE from "three";

export type Rgb = [number, number, number];

const ANCHORS = [0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725];

/** Differences: blue, white, red (RdBu of ColorBrewer, Brewer 2002, reversed), safe for the colour-blind. */
const DIVERGING = [0x053061, 0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b, 0x67001f];

/** Components 0 to 1 in sRGB, at 0 to 1 along the map. */
export const viridis = (at: number): Rgb => between(ANCHORS, at);

/** The same for values about zero, which is at one half. */
export const diverging = (at: number): Rgb => between(DIVERGING, at);

function between(anchors: number[], at: number): Rgb {
  const x = Math.min(1, Math.max(0, at)) * (anchors.length - 1);
  const low = Math.min(Math.floor(x), anchors.length - 2);
  const t = x - low;
  const a = anchors[low]!;
  const b = anchors[low + 1]!;
  const mix = (shift: number) => (((a >> shift) & 255) * (1 - t) + ((b >> shift) & 255) * t) / 255;
  return [mix(16), mix(8), mix(0)];
}

export const css = ([r, g, b]: Rgb): string => `rgb(${Math.round(r * 255)} ${Math.round(g * 255)} ${Math.round(b * 255)})`;

/** Levels of lines and ticks, µm; colours reach from the first to the last. */
export type Scale = number[];

export const ends = (scale: Scale): [number, number] => [scale[0]!, scale.at(-1)!];

/** Where a value is on the scale: 0 at its first level, 1 at its last. */
export function along(scale: Scale, value: number): number {
  const [low, high] = ends(scale);
  return (value - low) / (high - low);
}

const shades = new Map<string, THREE.Color>();
/** A colour of the page, by its name in the style; read once a theme, since reading it makes the browser style all there is. */
export function shade(name: string): THREE.Color {
  const key = `${document.documentElement.dataset.theme} ${name}`;
  let found = shades.get(key);
  if (!found) shades.set(key, (found = new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim())));
  return found;
}
