// The frame of the map: distance along the path to the right, spin of the tool upwards, in pixels.

import { niceStep } from "../format";

export interface Frame {
  width: number;
  height: number;
  length_mm: number;
  low_deg: number;
  high_deg: number;
}

/** Room for the labels of the axes, pixels. */
export const ROOM = { left: 46, right: 12, top: 8, bottom: 30 };

export const plotWidth = (f: Frame): number => Math.max(1, f.width - ROOM.left - ROOM.right);
export const plotHeight = (f: Frame): number => Math.max(1, f.height - ROOM.top - ROOM.bottom);
export const xOf = (f: Frame, distance_mm: number): number => ROOM.left + (plotWidth(f) * distance_mm) / (f.length_mm || 1);
export const yOf = (f: Frame, spin_deg: number): number => ROOM.top + (plotHeight(f) * (f.high_deg - spin_deg)) / (f.high_deg - f.low_deg || 1);
export const distanceOf = (f: Frame, x: number): number => ((x - ROOM.left) / plotWidth(f)) * f.length_mm;
export const spinOf = (f: Frame, y: number): number => f.high_deg - ((y - ROOM.top) / plotHeight(f)) * (f.high_deg - f.low_deg);

/** Round values along an axis. */
export function ticks(low: number, high: number, count: number): number[] {
  const step = niceStep(high - low, count);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
}

/** Spins have steps of 15, 30, 45 or 90 degrees over wide ranges. */
export function spinTicks(low: number, high: number): number[] {
  const span = high - low;
  if (span < 60) return ticks(low, high, 5);
  const step = span > 270 ? 90 : span > 140 ? 45 : span > 90 ? 30 : 15;
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, i) => (first + i) * step);
}

/** Lower and upper edge of each value: halfway to its neighbours, and the ends. */
export function edges(values: number[], low: number, high: number): number[] {
  return [low, ...values.slice(1).map((v, i) => (v + values[i]!) / 2), high];
}
