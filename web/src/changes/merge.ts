// Two changed versions of one text as one, line by line: possible where they changed different lines.

/** Products of lines above which texts are not compared line by line. */
const MOST_CELLS = 4_000_000;

/** A changed part: lines `from` to `to` of the original are replaced. */
interface Change {
  from: number;
  to: number;
  lines: string[];
}

/** Both changes of `base`; null if they change the same or adjacent lines differently. */
export function merge(base: string, mine: string, theirs: string): string | null {
  if (mine === base || mine === theirs) return theirs;
  if (theirs === base) return mine;
  const original = base.split("\n");
  const [a, b] = [changes(original, mine.split("\n")), changes(original, theirs.split("\n"))];
  if (!a || !b) return null;
  const both: Change[] = [];
  for (const change of [...a, ...b].sort((p, q) => p.from - q.from || p.to - q.to)) {
    const last = both.at(-1);
    if (last && last.from === change.from && last.to === change.to && last.lines.join("\n") === change.lines.join("\n")) continue;
    if (last && change.from <= last.to) return null;
    both.push(change);
  }
  const merged: string[] = [];
  let at = 0;
  for (const change of both) {
    merged.push(...original.slice(at, change.from), ...change.lines);
    at = change.to;
  }
  return [...merged, ...original.slice(at)].join("\n");
}

/** The changed parts of `now`, in order; null if the texts are too long to compare. */
function changes(original: string[], now: string[]): Change[] | null {
  let first = 0;
  while (first < original.length && first < now.length && original[first] === now[first]) first++;
  let last = 0;
  while (last < original.length - first && last < now.length - first && original.at(-1 - last) === now.at(-1 - last)) last++;
  const a = original.slice(first, original.length - last);
  const b = now.slice(first, now.length - last);
  if (a.length * b.length > MOST_CELLS) return null;
  // Length of the longest common sequence of the rests from i and j on.
  const width = b.length + 1;
  const common = new Uint32Array((a.length + 1) * width);
  for (let i = a.length - 1; i >= 0; i--)
    for (let j = b.length - 1; j >= 0; j--) common[i * width + j] = a[i] === b[j] ? common[(i + 1) * width + j + 1]! + 1 : Math.max(common[(i + 1) * width + j]!, common[i * width + j + 1]!);
  const found: Change[] = [];
  let open: Change | null = null;
  for (let i = 0, j = 0; i < a.length || j < b.length; ) {
    if (i < a.length && j < b.length && a[i] === b[j]) {
      open = null;
      i++;
      j++;
      continue;
    }
    if (!open) found.push((open = { from: first + i, to: first + i, lines: [] }));
    const takes = i < a.length && (j >= b.length || common[(i + 1) * width + j]! >= common[i * width + j + 1]!);
    if (takes) open.to = first + ++i;
    else open.lines.push(b[j++]!);
  }
  return found;
}
