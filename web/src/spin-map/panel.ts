// Path × spin map below the scene: deviation over the length of the path and the spin of the tool, the chosen curve, which is
// dragged, and the searched one.

import { fill, h, renew, type Child } from "../dom";
import { fixed, mm, um } from "../format";
import type { Live } from "../live";
import { panel } from "../panels/panel";
import { css, viridis } from "../scene/colour";
import { known } from "../scene/points";
import { theme } from "../theme";
import { BLOCKED, cellAt, cellRows, cellText, IN_COLLISION, JUMPS, OUT_OF_REACH, OUTSIDE, TOO_SLOW } from "./cells";
import { DARK, drawCells, LIGHT } from "./draw";
import { distanceOf, spinOf, type Frame } from "./frame";
import { knotsOf, written, type Knot, type Range } from "./knots";
import { Lines, type Curves } from "./lines";
import { SpinSource } from "./source";

const KEY = "spin_curve_mm_deg";
const HEIGHT = 236;
/** Points of a searched spin that are drawn at most. */
const MOST_DRAWN = 2000;

export function spinMap(live: Live): HTMLElement {
  const { root, body } = panel("spin-map", "Path × spin map", false);
  const canvas = h("canvas", { role: "img", "aria-label": "Deviation over path and spin" });
  const tip = h("div", { class: "spin-tip card", hidden: true });
  const status = h("p", { class: "note spin-status", role: "status" });
  const legend = h("div", { class: "spin-legend" });
  const tools = h("div", { class: "spin-tools" });
  let focused: number | null = null;
  /** Knots that the study does not have yet. */
  let own: Knot[] | null = null;
  let drawn = "";

  const source = new SpinSource(live, () => draw());
  const lines = new Lines({
    change: (knots) => {
      own = knots;
      live.change(KEY, written(knots, live.values?.spin_deg ?? 0));
      draw();
    },
    words: (knot) => words(knot),
    focus: (index) => {
      focused = index;
      draw();
    },
  });
  const plot = h("div", { class: "spin-plot" }, canvas, lines.root, tip);
  fill(body, plot, legend, h("div", { class: "spin-foot" }, tools, status));

  const isPath = () => (live.answer?.paths.length ?? 0) > 0 && live.values?.kind === "path";
  const words = ([distance_mm, spin_deg]: Knot): string => {
    const map = source.map;
    if (!map) return "not computed yet";
    const { row, column } = cellAt(map, distance_mm, spin_deg);
    return cellText(map, row, column);
  };
  const frameOf = (): Frame | null => {
    const map = source.map;
    if (!map || plot.clientWidth === 0) return null;
    const [low, high] = [map.spins_deg[0]!, map.spins_deg.at(-1)!];
    const single = high - low < 1e-6;
    return { width: plot.clientWidth, height: HEIGHT, length_mm: map.length_mm, low_deg: single ? low - 5 : low, high_deg: single ? high + 5 : high };
  };
  const knots = (range: Range): Knot[] => own ?? knotsOf(live.values?.spin_curve_mm_deg ?? null, live.values?.spin_deg ?? 0, range);

  /** The spin that a search of the study found at each point. */
  const ofStudy = (): [number, number][] | null => {
    const { path } = live;
    const [distance, turn] = [path?.get("distance_mm"), path?.get("turn_deg")];
    if (!live.answer?.paths[0]?.search || !turn || !distance) return null;
    const constant = live.values?.spin_deg ?? 0;
    // More points than the picture has columns would only cost.
    const every = Math.ceil(distance.length / MOST_DRAWN);
    return Array.from({ length: Math.ceil(distance.length / every) }, (_, i) => [distance[every * i]!, known(turn, every * i) ?? 0]).map(([d, t]) => [d!, t! + constant]);
  };

  const hasSearched = (): boolean => source.found !== null || ofStudy() !== null;

  const curves = (frame: Frame): Curves => {
    const search = live.answer?.paths[0]?.search ?? null;
    const of_study = ofStudy();
    const own_knots = knots(frame);
    const robot = live.at?.point;
    const at = typeof robot === "number" ? live.scene?.points?.distance?.[robot] : null;
    const searched = source.found?.distance_mm.map((d, i): [number, number | null] => [d, source.found!.spins_deg[i] ?? null]) ?? null;
    return {
      knots: search ? null : own_knots,
      chosen: search?.applied && of_study ? of_study : own_knots,
      searched: search ? (search.applied ? null : of_study) : searched,
      robot_mm: at ?? null,
    };
  };

  const draw = () => {
    root.hidden = !isPath();
    if (root.hidden || !(root as HTMLDetailsElement).open) return;
    plot.classList.toggle("waits", source.isStale && !lines.isDragged);
    const frame = frameOf();
    drawFoot();
    if (!frame) {
      if (source.error) status.textContent = source.error;
      return;
    }
    const map = source.map!;
    const levels = live.wanted.fix_scale && live.levels_um ? live.levels_um : map.levels_um;
    const key = JSON.stringify([frame, theme(), levels, devicePixelRatio, hasSearched()]);
    if (key !== drawn || drawn_map !== map) {
      [drawn, drawn_map] = [key, map];
      drawCells(canvas, map, frame, levels, theme() === "dark" ? DARK : LIGHT);
      canvas.setAttribute("aria-label", summary());
      renew(legend, scale(levels, map.tolerance_um), marks());
    }
    lines.draw(frame, curves(frame));
  };
  let drawn_map: unknown = null;

  const summary = (): string => {
    const map = source.map!;
    const levels = map.levels_um;
    const cells = map.state.flat();
    const usable = cells.filter((state) => (state & BLOCKED) === 0).length;
    const share = cells.length > 0 ? Math.round((100 * usable) / cells.length) : 0;
    return `In-plane deviation over ${mm(map.length_mm)} mm of the path and spins from ${fixed(map.spins_deg[0], 0)} to ${fixed(map.spins_deg.at(-1), 0)} degrees${levels ? `: ${um(levels[0])} to ${um(levels.at(-1))} micrometres` : ""}; ${share} per cent can be used`;
  };

  const marks = (): HTMLElement => {
    const states = source.map!.state.flat();
    const has = (test: (state: number) => boolean) => states.some(test);
    const entries: [boolean, string, string][] = [
      [has((s) => (s & OUT_OF_REACH) === 0 && (s & OUTSIDE) !== 0), "outside", "outside joint limits"],
      [has((s) => (s & (OUT_OF_REACH | IN_COLLISION | OUTSIDE)) === 0 && (s & BLOCKED) !== 0), "singular", "near a singularity"],
      [has((s) => (s & IN_COLLISION) !== 0), "collision", "in collision"],
      [has((s) => (s & OUT_OF_REACH) !== 0), "empty", "out of reach"],
      [has((s) => (s & JUMPS) !== 0), "jump", "a joint jumps"],
      [has((s) => (s & TOO_SLOW) !== 0), "slow", "a joint is too slow"],
    ];
    return h("p", { class: "marks" }, entries.filter(([there]) => there).map(([, kind, text]) => h("span", {}, h("i", { class: `mark spin-${kind}` }), text)), h("span", {}, h("i", { class: "mark spin-line" }), "chosen spin"), hasSearched() ? h("span", {}, h("i", { class: "mark spin-line searched" }), "searched spin") : null);
  };

  const drawFoot = () => {
    const search = live.answer?.paths[0]?.search ?? null;
    const curve = own !== null || (live.values?.spin_curve_mm_deg ?? null) !== null;
    const { found, searching } = source;
    const button = (key: string, text: string, act: () => void, more: { title?: string; disabled?: boolean } = {}): Child => h("button", { type: "button", class: "quiet small", "data-key": key, onclick: act, ...more }, text);
    const count = own?.length ?? live.values?.spin_curve_mm_deg?.length ?? 2;
    renew(
      tools,
      search
        ? null
        : [
            button("spin-add", "Add a knot", () => lines.add(focused), { title: "Insert at a knot, or double-click the map" }),
            button("spin-remove", "Remove a knot", () => lines.remove(focused), { title: "Delete at a knot", disabled: count <= 2 }),
            button("spin-constant", "Constant spin", () => set(null), { title: "Removes the curve; the constant spin stays", disabled: !curve }),
            searching ? button("spin-stop", "Stop the search", () => source.stop()) : button("spin-search", "Search", () => source.search(), { title: "Searches the spin with the smallest deviation at each point" }),
            found && !searching ? button("spin-use", "Use the searched spin", () => use()) : null,
          ],
    );
    const text = searching ? "Searching the best spin at each point …" : (source.error ?? (found && !search ? foundText() : search ? searchText(search) : "Drag a knot, or move it by the arrow keys."));
    if (status.textContent !== text) status.textContent = text;
  };

  const foundText = (): string => {
    const { max_in_plane_um, unusable, breaks } = source.found!;
    const lost = unusable > 0 ? `; no usable spin at ${unusable} points` : breaks.length > 0 ? `; the arm has to stop ${breaks.length === 1 ? "once" : `${breaks.length} times`}` : "";
    const stale = source.isSearchStale ? " The study has changed since: search again." : "";
    return `Searched: at most ${um(max_in_plane_um)} µm, now ${um(live.worst?.in_plane_um)} µm${lost}.${stale}`;
  };
  const searchText = (search: { applied: boolean }): string => `The study searches the spin (posture.search)${search.applied ? "" : "; it is not used, because its gain is not significant"}. Remove the search to draw a curve.`;

  const set = (curve: Knot[] | null) => {
    own = null;
    live.change(KEY, curve);
  };
  const use = () => {
    const { curve_mm_deg, branch } = source.found!;
    own = null;
    live.changeTogether({ [KEY]: curve_mm_deg, ...(branch ? { "posture.branch": branch } : {}) });
  };

  const hover = (event: PointerEvent) => {
    const frame = frameOf();
    const box = plot.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const [distance_mm, spin_deg] = frame ? [distanceOf(frame, x), spinOf(frame, y)] : [-1, 0];
    tip.hidden = !frame || lines.isDragged || distance_mm < 0 || distance_mm > frame.length_mm || spin_deg < frame.low_deg || spin_deg > frame.high_deg;
    if (tip.hidden) return;
    const { row, column } = cellAt(source.map!, distance_mm, spin_deg);
    renew(tip, h("dl", {}, cellRows(source.map!, row, column).map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])), h("p", {}, "Click: the robot goes to this point"));
    const left = x > box.width - 240 ? x - 225 : x + 16;
    tip.style.transform = `translate(${left}px, ${Math.max(0, Math.min(y - 20, HEIGHT - tip.offsetHeight))}px)`;
  };
  plot.addEventListener("pointermove", hover);
  plot.addEventListener("pointerleave", () => (tip.hidden = true));
  plot.addEventListener("click", (event) => {
    const frame = frameOf();
    if (!frame || (event.target as Element).closest(".spin-knot")) return;
    const distance_mm = distanceOf(frame, event.clientX - plot.getBoundingClientRect().left);
    if (distance_mm >= 0 && distance_mm <= frame.length_mm) live.goTo({ point: source.map!.points[cellAt(source.map!, distance_mm, 0).column]! });
  });

  root.addEventListener("toggle", () => {
    const { open } = root as HTMLDetailsElement;
    if (open && isPath()) source.want();
    draw();
    // It may open below what is seen.
    if (open) root.scrollIntoView({ block: "nearest" });
  });
  live.listen(["answer"], () => {
    // What the study has now.
    if (live.settled && !lines.isDragged) own = null;
    root.hidden = !isPath();
    if (!root.hidden && (root as HTMLDetailsElement).open) source.want();
  });
  live.listen(["error"], () => live.error && (own = null));
  live.listen(["answer", "pose", "view", "error"], () => draw());
  new ResizeObserver(() => draw()).observe(plot);
  return root;
}

/** The colours from the first level to the last, with the tolerance. */
function scale(levels: number[] | null, tolerance_um: number): HTMLElement | null {
  if (!levels) return null;
  const [low, high] = [levels[0]!, levels.at(-1)!];
  const stops = Array.from({ length: 11 }, (_, i) => css(viridis(i / 10))).join(", ");
  const at = (tolerance_um - low) / (high - low);
  const mark = at >= 0 && at <= 1 ? h("i", { class: "spin-tolerance", style: `left:${(100 * at).toFixed(1)}%` }) : null;
  const tolerance = at < 0 ? `tolerance ${um(tolerance_um)}: all above it` : at > 1 ? `tolerance ${um(tolerance_um)}: all below it` : `tolerance ${um(tolerance_um)}`;
  return h("p", { class: "spin-scale" }, h("span", {}, "In plane, µm"), h("span", { class: "num" }, um(low)), h("span", { class: "spin-bar", style: `background:linear-gradient(90deg, ${stops})` }, mark), h("span", { class: "num" }, um(high)), h("small", {}, tolerance));
}
