// The knots of the spin along a path: they are moved, added and removed here, and written as the study has them.

/** Distance along the path and spin of the tool. */
export type Knot = [distance_mm: number, spin_deg: number];

/** Where knots may be. */
export interface Range {
  length_mm: number;
  low_deg: number;
  high_deg: number;
}

/** Knots are apart by at least this fraction of the path. */
const LEAST_GAP = 0.002;

/** As in the study: to a tenth of a degree, and never beyond the end of the path. */
const rounded = ([distance_mm, spin_deg]: Knot, { length_mm }: Range): Knot => {
  const decimals = length_mm < 10 ? 3 : 1;
  const step = 10 ** decimals;
  const at = Math.min(Math.round(distance_mm * step), Math.floor(length_mm * step + 1e-6));
  return [Math.max(0, at) / step, Math.round(spin_deg * 10) / 10];
};

/** The knots of the study, in total spin; those of a constant spin are at both ends. */
export function knotsOf(curve_mm_deg: readonly number[][] | null, constant_deg: number, range: Range): Knot[] {
  if (curve_mm_deg && curve_mm_deg.length > 1) return curve_mm_deg.map(([d, s]) => [d!, s! + constant_deg]);
  return [[0, constant_deg], rounded([range.length_mm, constant_deg], range)];
}

/** As the study has them: in addition to its constant spin. */
export const written = (knots: Knot[], constant_deg: number): Knot[] => knots.map(([d, s]) => [d, Math.round((s - constant_deg) * 1000) / 1000]);

/** The spin at a distance: linear between knots, constant outside. */
export function spinAt(knots: Knot[], distance_mm: number): number {
  const after = knots.findIndex(([d]) => d > distance_mm);
  if (after < 0) return knots.at(-1)![1];
  if (after === 0) return knots[0]![1];
  const [[d0, s0], [d1, s1]] = [knots[after - 1]!, knots[after]!];
  return s0 + ((s1 - s0) * (distance_mm - d0)) / (d1 - d0);
}

/** With one knot moved, between its neighbours and inside the range. */
export function moved(knots: Knot[], index: number, to: Knot, range: Range): Knot[] {
  const gap = LEAST_GAP * range.length_mm;
  const low = index === 0 ? 0 : knots[index - 1]![0] + gap;
  const high = index === knots.length - 1 ? range.length_mm : knots[index + 1]![0] - gap;
  const at: Knot = [Math.max(low, Math.min(high, to[0])), Math.max(range.low_deg, Math.min(range.high_deg, to[1]))];
  const new_knot = rounded(at, range);
  const ascends = (index === 0 || new_knot[0] > knots[index - 1]![0]) && (index === knots.length - 1 || new_knot[0] < knots[index + 1]![0]);
  return knots.map((knot, i) => (i !== index ? knot : ascends ? new_knot : [knot[0], new_knot[1]]));
}

/** With one knot more, on the curve at this distance; null where there is no room. */
export function added(knots: Knot[], distance_mm: number, range: Range): { knots: Knot[]; index: number } | null {
  const knot = rounded([distance_mm, spinAt(knots, distance_mm)], range);
  const index = knots.findIndex(([d]) => d >= knot[0]);
  const at = index < 0 ? knots.length : index;
  const gap = LEAST_GAP * range.length_mm;
  const near = [knots[at - 1], knots[at]].some((other) => other && Math.abs(other[0] - knot[0]) < gap);
  return near ? null : { knots: [...knots.slice(0, at), knot, ...knots.slice(at)], index: at };
}

/** Where a knot is added after this one: halfway to the next, or to the one before at the end. */
export function between(knots: Knot[], index: number): number {
  const other = knots[index + 1] ?? knots[index - 1]!;
  return (knots[index]![0] + other[0]) / 2;
}

/** Without this knot; two are the least. */
export const removed = (knots: Knot[], index: number): Knot[] => (knots.length <= 2 ? knots : knots.filter((_, i) => i !== index));
