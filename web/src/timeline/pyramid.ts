// Least and largest value of any range of a column, without reading its points: each level has one entry for 16 of the level below.

const FACTOR = 16;

interface Level {
  low: Float32Array;
  high: Float32Array;
}

/** `[Infinity, -Infinity]` of a range without a known value. */
export type Range = [low: number, high: number];

export class Pyramid {
  private readonly levels: Level[];

  constructor(readonly values: Float32Array) {
    this.levels = [{ low: values, high: values }];
    for (let below = this.levels[0]!; below.low.length > FACTOR; below = this.levels.at(-1)!) this.levels.push(above(below));
  }

  /** Of the points from `first` up to, but not including, `end`. */
  range(first: number, end: number): Range {
    const found: Range = [Infinity, -Infinity];
    let [a, b] = [Math.max(0, first), Math.min(this.values.length, end)];
    for (let i = 0; a < b; i++) {
      const level = this.levels[i]!;
      const [inner, outer] = [Math.ceil(a / FACTOR), Math.floor(b / FACTOR)];
      if (i + 1 >= this.levels.length || inner >= outer) {
        widen(found, level, a, b);
        break;
      }
      widen(found, level, a, inner * FACTOR);
      widen(found, level, outer * FACTOR, b);
      [a, b] = [inner, outer];
    }
    return found;
  }

  get all(): Range {
    return this.range(0, this.values.length);
  }
}

function above(below: Level): Level {
  const count = Math.ceil(below.low.length / FACTOR);
  const level = { low: new Float32Array(count), high: new Float32Array(count) };
  for (let i = 0; i < count; i++) {
    const range: Range = [Infinity, -Infinity];
    widen(range, below, i * FACTOR, Math.min(below.low.length, (i + 1) * FACTOR));
    [level.low[i], level.high[i]] = range;
  }
  return level;
}

/** NaN, a value that is not known, is neither smaller nor larger than another. */
function widen(range: Range, { low, high }: Level, a: number, b: number): void {
  for (let i = a; i < b; i++) {
    if (low[i]! < range[0]) range[0] = low[i]!;
    if (high[i]! > range[1]) range[1] = high[i]!;
  }
}
