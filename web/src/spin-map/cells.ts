// The map that the server computes, cell by cell, in words.

import { fixed, mm, um } from "../format";
import type { SpinMap } from "../types";

/** Bits of a state. */
export const OUTSIDE = 1;
export const SINGULAR = 2;
export const OUT_OF_REACH = 4;
export const JUMPS = 8;
export const TOO_SLOW = 16;
export const IN_COLLISION = 32;
/** Postures that are not usable. */
export const BLOCKED = OUTSIDE | SINGULAR | OUT_OF_REACH | IN_COLLISION;

/** A number of the list that is nearest to the value; the list ascends. */
export function nearest(list: number[], value: number): number {
  let [low, high] = [0, list.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle]! <= value) low = middle;
    else high = middle;
  }
  return high >= 0 && Math.abs(list[high]! - value) < Math.abs(list[low]! - value) ? high : Math.max(0, low);
}

/** Row and column of a distance and a spin; a spin beyond the rows is whole turns away. */
export function cellAt(map: SpinMap, distance_mm: number, spin_deg: number): { row: number; column: number } {
  const [low, high] = [map.spins_deg[0]!, map.spins_deg.at(-1)!];
  const turned = high - low >= 359 ? low + (((spin_deg - low) % 360) + 360) % 360 : spin_deg;
  return { row: nearest(map.spins_deg, turned), column: nearest(map.distance_mm, distance_mm) };
}

/** Why the arm cannot be there, or cannot come there; empty where it can. */
export function reasons(map: SpinMap, row: number, column: number): string[] {
  const state = map.state[row]![column]!;
  const name = (index: number) => map.joint_names[index] ?? "a joint";
  const mover = name(map.move_joint[row]![column]!);
  const found: [number, string][] = [
    [OUT_OF_REACH, "out of reach"],
    [IN_COLLISION, "in collision"],
    [OUTSIDE, `${name(map.limit_joint[row]![column]!)} outside its limits`],
    [SINGULAR, "near a singularity"],
    [JUMPS, `${mover} jumps here`],
    [TOO_SLOW, `${mover} is too slow for the feed`],
  ];
  return found.filter(([bit]) => (state & bit) !== 0).map(([, words]) => words);
}

/** Names and values of a cell. */
export function cellRows(map: SpinMap, row: number, column: number): [string, string][] {
  const margin = map.limit_margin_deg[row]![column];
  const joint = map.joint_names[map.limit_joint[row]![column]!] ?? "";
  const rows: [string, string][] = [
    ["Distance", `${mm(map.distance_mm[column])} mm`],
    ["Spin", `${fixed(map.spins_deg[row], 0)}°`],
    ["In plane", `${um(map.in_plane_um[row]![column])} µm`],
  ];
  if (margin !== null && margin !== undefined) rows.push([`Margin (${joint})`, `${fixed(margin, 1)}°`]);
  for (const reason of reasons(map, row, column)) rows.push(["", reason]);
  return rows;
}

/** The same in one line. */
export function cellText(map: SpinMap, row: number, column: number): string {
  const value = map.in_plane_um[row]![column];
  const deviation = value === null || value === undefined ? null : `${um(value)} µm in plane`;
  return [deviation, ...reasons(map, row, column)].filter(Boolean).join(", ");
}
