// Lines of equal value over a grid, by marching squares, joined to polylines. Cells with a point without value have none.

export interface Grid {
  y_mm: number[];
  z_mm: number[];
  /** Row by row: rows along z, columns along y. */
  values: (number | null)[];
}

export type Line = [number, number][];

// For each of the 16 cases the edges that a line joins: 0 bottom, 1 right, 2 top, 3 left.
const EDGES: number[][][] = [
  [], [[3, 0]], [[0, 1]], [[3, 1]], [[1, 2]], [], [[0, 2]], [[3, 2]],
  [[2, 3]], [[2, 0]], [], [[2, 1]], [[1, 3]], [[1, 0]], [[0, 3]], [],
];

export function contour(grid: Grid, level: number): Line[] {
  const columns = grid.y_mm.length;
  const rows = grid.z_mm.length;
  const points = new Map<number, [number, number]>();
  const links = new Map<number, number[]>();
  const value = (column: number, row: number) => grid.values[row * columns + column] ?? null;

  // An edge is known by its lower left grid point and whether it goes along y (0) or z (1).
  const edge = (column: number, row: number, side: number): number => {
    const [c, r, up] = side === 0 ? [column, row, 0] : side === 1 ? [column + 1, row, 1] : side === 2 ? [column, row + 1, 0] : [column, row, 1];
    const key = 2 * (r! * columns + c!) + up!;
    if (!points.has(key)) {
      const a = value(c!, r!)!;
      const [c2, r2] = up ? [c!, r! + 1] : [c! + 1, r!];
      const b = value(c2, r2)!;
      const t = a === b ? 0.5 : (level - a) / (b - a);
      points.set(key, [
        grid.y_mm[c!]! + t * (grid.y_mm[c2]! - grid.y_mm[c!]!),
        grid.z_mm[r!]! + t * (grid.z_mm[r2]! - grid.z_mm[r!]!),
      ]);
    }
    return key;
  };
  const link = (a: number, b: number) => {
    (links.get(a) ?? links.set(a, []).get(a)!).push(b);
    (links.get(b) ?? links.set(b, []).get(b)!).push(a);
  };

  for (let row = 0; row + 1 < rows; row++) {
    for (let column = 0; column + 1 < columns; column++) {
      const a = value(column, row);
      const b = value(column + 1, row);
      const c = value(column + 1, row + 1);
      const d = value(column, row + 1);
      if (a === null || b === null || c === null || d === null) continue;
      const which = (a >= level ? 1 : 0) | (b >= level ? 2 : 0) | (c >= level ? 4 : 0) | (d >= level ? 8 : 0);
      // A saddle is cut as the mean of its corners says.
      const high = (a + b + c + d) / 4 >= level;
      const pairs = which === 5 ? (high ? [[3, 2], [0, 1]] : [[3, 0], [1, 2]]) : which === 10 ? (high ? [[3, 0], [1, 2]] : [[3, 2], [0, 1]]) : EDGES[which]!;
      for (const [from, to] of pairs) link(edge(column, row, from!), edge(column, row, to!));
    }
  }
  return join(points, links);
}

/** Open lines first, from their ends; what is left is closed. */
function join(points: Map<number, [number, number]>, links: Map<number, number[]>): Line[] {
  const seen = new Set<number>();
  const lines: Line[] = [];
  const walk = (start: number) => {
    const line: Line = [];
    let at: number | undefined = start;
    while (at !== undefined && !seen.has(at)) {
      seen.add(at);
      line.push(points.get(at)!);
      at = links.get(at)!.find((next) => !seen.has(next));
    }
    return line;
  };
  for (const [key, next] of links) if (next.length === 1 && !seen.has(key)) lines.push(walk(key));
  for (const key of links.keys()) {
    if (seen.has(key)) continue;
    const line = walk(key);
    line.push(line[0]!);
    lines.push(line);
  }
  return lines;
}
