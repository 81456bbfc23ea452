// Lines of equal value over a grid, by marching squares, joined to polylines. Cells with a point without value have none.
// While the user drags, ten levels over ten thousand points are drawn anew each time: plain arrays, no maps.

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

export function contour(grid: Grid, level: number): Line[] {
  const { y_mm, z_mm, values } = grid;
  const columns = y_mm.length;
  const rows = z_mm.length;
  // Grid edge 2 p leads from point p along y, 2 p + 1 along z. Each edge that is crossed has at most two neighbours.
  const next = new Int32Array(4 * columns * rows).fill(-1);
  const crossed: number[] = [];
  const link = (from: number, to: number) => {
    if (next[2 * from] === -1) {
      crossed.push(from);
      next[2 * from] = to;
    } else next[2 * from + 1] = to;
  };
  for (let row = 0; row + 1 < rows; row++) {
    for (let column = 0; column + 1 < columns; column++) {
      const p = row * columns + column;
      const a = values[p]!;
      const b = values[p + 1]!;
      const c = values[p + columns + 1]!;
      const d = values[p + columns]!;
      const which = (a >= level ? 1 : 0) | (b >= level ? 2 : 0) | (c >= level ? 4 : 0) | (d >= level ? 8 : 0);
      if (which === 0 || which === 15 || a === null || b === null || c === null || d === null) continue;
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
  }
  const place = (edge: number): [number, number] => {
    const p = edge >> 1;
    const q = edge & 1 ? p + columns : p + 1;
    const a = values[p]!;
    const b = values[q]!;
    const t = a === b ? 0.5 : (level - a) / (b - a);
    const y = y_mm[p % columns]!;
    const z = z_mm[Math.floor(p / columns)]!;
    return edge & 1 ? [y, z + t * (z_mm[Math.floor(q / columns)]! - z)] : [y + t * (y_mm[q % columns]! - y), z];
  };
  return join(next, crossed, place);
}

/** Open lines first, from their ends; what is left is closed. */
function join(next: Int32Array, crossed: number[], place: (edge: number) => [number, number]): Line[] {
  const seen = new Uint8Array(next.length / 2);
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
