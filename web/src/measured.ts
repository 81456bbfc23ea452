// Work measured for the performance panel of the browser and for `npm run path-speed`: measures of the same name do not pile up.

const MOST = 1000;
const counts = new Map<string, number>();

/** Time since `begun` (performance.now()) as the measure `armill:name`. */
export function measured(name: string, begun: number): void {
  const full = `armill:${name}`;
  const count = (counts.get(full) ?? 0) + 1;
  if (count > MOST) performance.clearMeasures(full);
  counts.set(full, count > MOST ? 1 : count);
  performance.measure(full, { start: begun });
}
