// The map and the search of the server for the text that is shown. The map is requested when the text rests, so that
// dragging a knot costs no map: its rows do not depend on the curve.

import type { Live } from "../live";
import { Newest } from "../newest";
import { api } from "../server";
import type { SpinMap, SpinSearch } from "../types";

/** The text rests for so long before its map is requested. */
const REST_MS = 200;

interface Wanted {
  text: string;
  analysis: string | null;
}

export class SpinSource {
  map: SpinMap | null = null;
  found: SpinSearch | null = null;
  searching = false;
  /** What the server says in place of a map or a search. */
  error: string | null = null;
  /** The state that map and search belong to. */
  private of: Wanted | null = null;
  private searched_of: Wanted | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;

  private readonly maps = new Newest<Wanted, SpinMap>({
    work: ({ text, analysis }, signal) => api.spinMap(text, analysis, signal),
    done: (map, wanted) => {
      [this.map, this.of, this.error] = [map, wanted, null];
      this.changed();
    },
    failed: (error) => this.fail(error),
  });
  private readonly searches = new Newest<Wanted, SpinSearch>(
    {
      work: ({ text, analysis }, signal) => api.spinSearch(text, analysis, signal),
      done: (found, wanted) => {
        [this.found, this.searched_of, this.error] = [found, wanted, null];
        this.changed();
      },
      failed: (error) => this.fail(error),
      busy: (busy) => {
        this.searching = busy;
        this.changed();
      },
    },
    // A search takes as long as it takes.
    1e9,
  );

  constructor(private readonly live: Live, private readonly changed: () => void) {}

  /** The map of the present text, once it rests. */
  want(): void {
    clearTimeout(this.timer);
    const { text, analysis } = this.live;
    if (this.of?.analysis !== analysis) this.map = null;
    if (this.searched_of?.analysis !== analysis) this.forget();
    if (this.of?.text === text && this.of.analysis === analysis) return;
    this.timer = setTimeout(() => this.maps.submit({ text, analysis }), this.map === null ? 0 : REST_MS);
  }

  /** The best spins for the present text. */
  search(): void {
    this.searches.submit({ text: this.live.text, analysis: this.live.analysis });
  }

  stop(): void {
    this.searches.cancel();
  }

  /** Removes the searched curve. */
  forget(): void {
    this.stop();
    this.found = this.searched_of = null;
  }

  /** Whether the map belongs to another text: it is replaced soon. */
  get isStale(): boolean {
    return this.map !== null && this.of?.text !== this.live.text;
  }

  /** Whether the study has changed since the search, except for curve and branch, which the result of the search sets. */
  get isSearchStale(): boolean {
    return this.searched_of !== null && withoutResult(this.searched_of.text) !== withoutResult(this.live.text);
  }

  private fail(error: unknown): void {
    this.error = error instanceof Error ? error.message : String(error);
    this.changed();
  }
}

/** The text without the lines that a used search changes. */
const withoutResult = (text: string): string => text.replace(/^.*\b(spin_curve_mm_deg|branch)\b.*\n?/gm, "");
