// Lines of equal value over a grid, by marching squares, joined to polylines. Cells with a point without value have none.
// While the user drags, ten levels over ten thousand points are redrawn each time: plain arrays, no maps, and for each
// level only the cells that it passes.

export interface Grid {
  y_mm: number[];
  z_mm: number[];
  /** Row by row: rows along z, columns along y. */
  values: (number | null)[];
}

export type Line = [number, number][];

// For each of the 16 cases the sides that a line joins, in pairs: 0 bottom, 1 right, 2 top, 3 left. Saddles below.
const SIDES: number[][] = [[], [3, 0], [0, 1], [3, 1], [1, 2], [], [0, 2], [3, 2], [2, 3], [2, 0], [], [2, 1], [1, 3], [1, 0], [0, 3], []];
const SADDLE: Record<number, [number[], number[]]> = { 5: [[3, 0, 1, 2], [3, 2, 0, 1]], 10: [[3, 2, 0, 1], [3, 0, 1, 2]] };

export const contour = (grid: Grid, level: number): Line[] => contours(grid, [level])[0]!;

/** The lines of each level. */
export function contours(grid: Grid, levels: number[]): Line[][] {
  const columns = grid.y_mm.length;
  const values = Float64Array.from(grid.values, (value) => value ?? NaN);
  const cells = (columns - 1) * (grid.z_mm.length - 1);
  const low = new Float64Array(cells);
  const high = new Float64Array(cells);
  for (let cell = 0; cell < cells; cell++) {
    const p = cell + Math.floor(cell / (columns - 1));
    const [a, b, c, d] = [values[p]!, values[p + 1]!, values[p + columns + 1]!, values[p + columns]!];
    // Not a number where one of them is none: no level passes there.
    low[cell] = Math.min(a, b, c, d);
    high[cell] = Math.max(a, b, c, d);
  }
  // Grid edge 2 p leads from point p along y, 2 p + 1 along z. Each edge that is crossed has at most two neighbours.
  const next = new Int32Array(4 * values.length).fill(-1);
  const seen = new Uint8Array(2 * values.length);
  return levels.map((level) => {
    const crossed: number[] = [];
    const link = (from: number, to: number) => {
      if (next[2 * from] === -1) {
        crossed.push(from);
        next[2 * from] = to;
      } else next[2 * from + 1] = to;
    };
    for (let cell = 0; cell < cells; cell++) {
      if (!(low[cell]! < level && level <= high[cell]!)) continue;
      const p = cell + Math.floor(cell / (columns - 1));
      const [a, b, c, d] = [values[p]!, values[p + 1]!, values[p + columns + 1]!, values[p + columns]!];
      const which = (a >= level ? 1 : 0) | (b >= level ? 2 : 0) | (c >= level ? 4 : 0) | (d >= level ? 8 : 0);
      // A saddle is cut as the mean of its corners says.
      const sides = SADDLE[which]?.[(a + b + c + d) / 4 >= level ? 1 : 0] ?? SIDES[which]!;
      const edge = (side: number) => (side === 0 ? 2 * p : side === 1 ? 2 * (p + 1) + 1 : side === 2 ? 2 * (p + columns) : 2 * p + 1);
      for (let k = 0; k < sides.length; k += 2) {
        const from = edge(sides[k]!);
        const to = edge(sides[k + 1]!);
        link(from, to);
        link(to, from);
      }
    }
    const lines = join(next, seen, crossed, (edge) => place(grid, values, edge, level));
    for (const edge of crossed) next[2 * edge] = next[2 * edge + 1] = -1;
    for (const edge of crossed) seen[edge] = 0;
    return lines;
  });
}

/** Where the level crosses the edge. */
function place({ y_mm, z_mm }: Grid, values: Float64Array, edge: number, level: number): [number, number] {
  const columns = y_mm.length;
  const p = edge >> 1;
  const q = edge & 1 ? p + columns : p + 1;
  const a = values[p]!;
  const b = values[q]!;
  const t = a === b ? 0.5 : (level - a) / (b - a);
  const y = y_mm[p % columns]!;
  const z = z_mm[Math.floor(p / columns)]!;
  return edge & 1 ? [y, z + t * (z_mm[Math.floor(q / columns)]! - z)] : [y + t * (y_mm[q % columns]! - y), z];
}

/** Open lines first, from their ends; what is left is closed. */
function join(next: Int32Array, seen: Uint8Array, crossed: number[], place: (edge: number) => [number, number]): Line[] {
  const walk = (start: number): Line => {
    const line: Line = [];
    for (let at = start; at !== -1; ) {
      seen[at] = 1;
      line.push(place(at));
      const one = next[2 * at]!;
      const two = next[2 * at + 1]!;
      at = one !== -1 && !seen[one] ? one : two !== -1 && !seen[two] ? two : -1;
    }
    return line;
  };
  const lines: Line[] = [];
  for (const edge of crossed) if (next[2 * edge + 1] === -1 && !seen[edge]) lines.push(walk(edge));
  for (const edge of crossed) {
    if (seen[edge]) continue;
    const line = walk(edge);
    line.push(line[0]!);
    lines.push(line);
  }
  return lines;
}
