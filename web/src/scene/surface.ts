// The surface about all points of a box whose value is below a level: surface nets (Gibson 1998). One vertex in each
// cell that the surface passes, at the mean of its crossings; one quad for each crossed edge.

export interface Values3 {
  origin_mm: [number, number, number];
  step_mm: number;
  counts: [number, number, number];
  /** x fastest; null where there is none: outside. */
  values: (number | null)[];
}

export interface Mesh3 {
  positions: number[];
  index: number[];
}

const OUTSIDE = 1e6;

export function surfaceBelow(field: Values3, level: number): Mesh3 {
  const [nx, ny, nz] = field.counts;
  // One layer more on every side, so that the surface closes at the walls of the box.
  const inside = (x: number, y: number, z: number) => x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz;
  const value = (x: number, y: number, z: number): number => {
    const v = inside(x, y, z) ? field.values[(z * ny + y) * nx + x] : null;
    // A wall cuts off half a step outside, whatever the values are.
    return v === null || v === undefined ? OUTSIDE : v - level;
  };
  const cells = new Map<number, number>();
  const positions: number[] = [];
  const [wx, wy] = [nx + 2, ny + 2];
  const key = (x: number, y: number, z: number) => ((z + 1) * wy + (y + 1)) * wx + (x + 1);

  for (let z = -1; z < nz; z++)
    for (let y = -1; y < ny; y++)
      for (let x = -1; x < nx; x++) {
        const corner = Array.from({ length: 8 }, (_, i) => value(x + (i & 1), y + ((i >> 1) & 1), z + ((i >> 2) & 1)));
        const mask = corner.reduce((m, v, i) => (v <= 0 ? m | (1 << i) : m), 0);
        if (mask === 0 || mask === 255) continue;
        const mean = [0, 0, 0];
        let crossings = 0;
        for (let a = 0; a < 8; a++)
          for (const bit of [1, 2, 4]) {
            const b = a | bit;
            if (b === a || corner[a]! <= 0 === corner[b]! <= 0) continue;
            const far = corner[a] === OUTSIDE || corner[b] === OUTSIDE;
            const t = far ? (corner[a]! <= 0 ? 0.02 : 0.98) : corner[a]! / (corner[a]! - corner[b]!);
            mean[0]! += (a & 1) + (bit === 1 ? t : 0);
            mean[1]! += ((a >> 1) & 1) + (bit === 2 ? t : 0);
            mean[2]! += ((a >> 2) & 1) + (bit === 4 ? t : 0);
            crossings++;
          }
        cells.set(key(x, y, z), positions.length / 3);
        [x, y, z].forEach((at, i) => positions.push(field.origin_mm[i]! + field.step_mm * (at + mean[i]! / crossings)));
      }

  const index: number[] = [];
  const quad = (a: number, b: number, c: number, d: number, turned: boolean) => {
    const at = [a, b, c, d].map((k) => cells.get(k));
    if (at.some((v) => v === undefined)) return;
    const [p, q, r, s] = at as [number, number, number, number];
    if (turned) index.push(p, r, q, p, s, r);
    else index.push(p, q, r, p, r, s);
  };
  for (let z = -1; z <= nz; z++)
    for (let y = -1; y <= ny; y++)
      for (let x = -1; x <= nx; x++) {
        const here = value(x, y, z) <= 0;
        if (here !== value(x + 1, y, z) <= 0) quad(key(x, y - 1, z - 1), key(x, y, z - 1), key(x, y, z), key(x, y - 1, z), !here);
        if (here !== value(x, y + 1, z) <= 0) quad(key(x - 1, y, z - 1), key(x - 1, y, z), key(x, y, z), key(x, y, z - 1), !here);
        if (here !== value(x, y, z + 1) <= 0) quad(key(x - 1, y - 1, z), key(x, y - 1, z), key(x, y, z), key(x - 1, y, z), !here);
      }
  return { positions, index };
}
