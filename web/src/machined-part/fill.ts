// A scan has fewer points than the surface has vertices: between them the mean of the neighbours is drawn.

/** So many edges from a measured vertex at most. */
const RINGS = 4;

/** The values, and where there is none (NaN) the mean of the neighbours that have one, some edges far and only where `compared` has a value. */
export function filled(values: Float32Array, triangles: Uint32Array, compared: Float32Array): Float32Array {
  let known = values;
  for (let ring = 0; ring < RINGS; ring++) {
    const sums = new Float64Array(values.length);
    const counts = new Uint16Array(values.length);
    let reached = 0;
    for (let t = 0; t < triangles.length; t += 3)
      for (let k = 0; k < 3; k++) {
        const [from, to] = [triangles[t + k]!, triangles[t + ((k + 1) % 3)]!];
        for (const [a, b] of [[from, to], [to, from]] as const) {
          const value = known[a]!;
          if (Number.isNaN(value) || !Number.isNaN(known[b]!) || Number.isNaN(compared[b]!)) continue;
          sums[b]! += value;
          counts[b]!++;
          reached++;
        }
      }
    if (reached === 0) break;
    known = known.map((value, v) => (counts[v]! > 0 ? sums[v]! / counts[v]! : value));
  }
  return known;
}
