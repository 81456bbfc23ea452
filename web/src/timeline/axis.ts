// The horizontal axis of the timeline: the distance along all cuts. From a point to its place, and back.

export class Axis {
  readonly length: number;

  /** `distance`: never falls from point to point. */
  constructor(readonly distance: Float32Array) {
    this.length = distance.at(-1) ?? 0;
  }

  get count(): number {
    return this.distance.length;
  }

  /** 0 at the first point, 1 at the last. */
  place(index: number): number {
    // A path without length has its points side by side.
    if (!(this.length > 0)) return this.count > 1 ? index / (this.count - 1) : 0;
    return (this.distance[Math.min(this.count - 1, index)] ?? 0) / this.length;
  }

  /** The point nearest to this place. */
  point(place: number): number {
    const last = this.count - 1;
    if (!(this.length > 0)) return Math.max(0, Math.min(last, Math.round(place * last)));
    const at = place * this.length;
    const after = Math.min(last, firstFrom(this.distance, at));
    const before = Math.max(0, after - 1);
    return at - this.distance[before]! < this.distance[after]! - at ? before : after;
  }

  /** For each pixel of a width, and at its end, the first point at or after it. */
  pixels(width: number): Uint32Array {
    const starts = new Uint32Array(width + 1);
    for (let x = 0; x <= width; x++) {
      const place = x / width;
      starts[x] = this.length > 0 ? firstFrom(this.distance, place * this.length) : Math.ceil(place * Math.max(0, this.count - 1));
    }
    starts[0] = 0;
    starts[width] = this.count;
    return starts;
  }
}

/** The first index whose value is at least `value`; the length if none is. */
export function firstFrom(rising: Float32Array, value: number): number {
  let [low, high] = [0, rising.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (rising[middle]! < value) low = middle + 1;
    else high = middle;
  }
  return low;
}
