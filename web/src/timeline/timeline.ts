// The timeline of a path: operations and tools as bands, charts of deviation, force and joints under each other, one cursor over all of
// them. It is one slider: pointer, arrow keys, Page Up and Down, Home, End; Space plays.

import { h } from "../dom";
import { fixed, mm, newton, trimmed, um } from "../format";
import type { Live } from "../live";
import { measured } from "../measured";
import type { PathColumn } from "../types";
import { Axis } from "./axis";
import { BandRow, operationBands, toolBands } from "./bands";
import type { PathColumns } from "./columns";
import { Player } from "./play";
import { Pyramid, type Range } from "./pyramid";
import { Strip } from "./strip";
import { WorstList } from "./worst";

const OPEN = "armill-panel-timeline";
/** A limit nearer to the values than this part of their range, or this many degrees or mm, is in the chart. */
const NEAR_PART = 0.3;
const NEAR_LIMIT = 10;
/** Least range of a chart of a joint, deg or mm: smaller motions are not magnified. */
const LEAST_SPAN = 2;

export class Timeline {
  readonly root: HTMLDetailsElement;
  private readonly reading = h("span", { class: "timeline-reading" });
  private readonly charts = h("div", { class: "charts", role: "slider", tabindex: 0, "aria-label": "Point of the path", "aria-valuemin": 1 });
  private readonly cursor = h("i", { class: "timeline-cursor" });
  private readonly pointer = h("i", { class: "timeline-pointer", hidden: true });
  private readonly operations: BandRow;
  private readonly tools: BandRow;
  private readonly worst: WorstList;
  private readonly player: Player;
  private strips: { strip: Strip; key: string }[] = [];
  private path: PathColumns | null = null;
  private axis = new Axis(new Float32Array(0));
  private starts: Uint32Array = new Uint32Array(1);
  private pyramids = new Map<string, Pyramid>();
  private made = "";
  /** The point under the pointer. */
  private over: number | null = null;
  private wanted: number | null = null;

  /** `along`: called before the robot is sent to a point of the charts, of a band, or of play. */
  constructor(
    private readonly live: Live,
    private readonly along: (index: number) => void = () => {},
  ) {
    const go = (index: number) => {
      this.player.stop();
      this.goTo(index);
    };
    this.operations = new BandRow("Operations", go);
    this.tools = new BandRow("Tools", go);
    this.worst = new WorstList(live, (index) => {
      this.player.stop();
      live.goTo({ point: index });
    });
    this.player = new Player((index) => this.goTo(index), () => this.index);
    this.root = h(
      "details",
      { class: "timeline", id: "timeline", open: localStorage.getItem(OPEN) !== "false", hidden: true },
      h("summary", {}, h("h2", {}, "Along the path"), this.reading),
      h(
        "div",
        { class: "timeline-body" },
        h("div", { class: "timeline-bar" }, this.player.button, this.player.speed, this.worst.root),
        h("div", { class: "timeline-rows" }, this.operations.root, this.tools.root, this.charts),
      ),
    );
    this.root.addEventListener("toggle", () => {
      localStorage.setItem(OPEN, String(this.root.open));
      if (this.root.open) this.show();
    });
    live.listen(["answer"], () => this.show());
    live.listen(["at", "pose"], () => this.mark());
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.charts);
    new MutationObserver(() => this.draw()).observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
  }

  private goTo(point: number): void {
    this.along(point);
    this.live.goTo({ point });
  }

  /** The point at which the robot is. */
  private get index(): number {
    return Math.min(Math.max(0, (this.path?.count ?? 1) - 1), this.live.at?.point ?? 0);
  }

  // ---- A new answer ----

  private show(): void {
    const { path } = this.live;
    this.root.hidden = path === null || path.count === 0;
    if (path === null || path.count === 0) return this.player.stop();
    if (path !== this.path) {
      this.path = path;
      this.axis = new Axis(path.get("distance_mm") ?? new Float32Array(path.count));
      this.starts = this.axis.pixels(this.starts.length - 1);
      this.pyramids.clear();
      this.charts.setAttribute("aria-valuemax", String(path.count));
    }
    if (!this.root.open) return this.mark();
    this.makeStrips(path);
    const { operations } = path.about;
    this.operations.show(operationBands(operations), this.axis);
    this.tools.show(toolBands(operations), this.axis);
    this.worst.show(operations);
    this.draw();
    this.mark();
    void this.load(path);
  }

  /** The columns that only the charts need. */
  private async load(path: PathColumns): Promise<void> {
    try {
      await path.load(["time_s", ...this.strips.map(({ key }) => key)]);
    } catch {
      // Superseded, or the server has ended: the next answer requests them again.
      return;
    }
    if (path !== this.path) return;
    this.player.show(this.axis, path.get("time_s"));
    this.draw();
    this.mark();
  }

  private makeStrips(path: PathColumns): void {
    const key = path.about.columns.map((column) => `${column.key} ${column.lower} ${column.upper}`).join();
    if (key === this.made) return;
    this.made = key;
    const tolerance = () => this.live.setting?.tolerance_um ?? Infinity;
    const fromZero = ([, high]: Range): Range => [0, high > 0 ? 1.08 * high : 1];
    const deviation = new Strip({
      title: "Deviation",
      unit: "µm",
      height: 66,
      text: um,
      span: ([, high]) => [0, 1.12 * Math.max(high > 0 ? high : 0, tolerance())],
      marks: () => [{ at: tolerance(), text: `tolerance ${trimmed(tolerance(), 1)}` }],
      above: tolerance,
    });
    const force = new Strip({ title: "Force", unit: "N", height: 40, text: newton, span: fromZero, marks: () => [] });
    this.strips = [
      { strip: deviation, key: "in_plane_um" },
      { strip: force, key: "force_n" },
      ...path.joints.map((column) => ({ strip: jointStrip(column), key: column.key })),
    ];
    this.charts.replaceChildren(...this.strips.map(({ strip }) => strip.root), this.pointer, this.cursor);
  }

  // ---- Drawing ----

  private resize(): void {
    const canvas = this.strips[0]?.strip.canvas;
    const width = Math.round(canvas?.parentElement?.clientWidth ?? 0);
    if (!canvas || width < 2) return;
    const left = canvas.getBoundingClientRect().left - this.charts.getBoundingClientRect().left;
    this.charts.style.setProperty("--left", `${left}px`);
    this.charts.style.setProperty("--width", `${width}px`);
    if (width !== this.starts.length - 1) {
      this.starts = this.axis.pixels(width);
      this.draw();
    }
    this.mark();
  }

  private draw(): void {
    if (!this.path || !this.root.open || this.root.hidden) return;
    if (this.starts.length < 3) return this.resize();
    const begun = performance.now();
    for (const { strip, key } of this.strips) {
      const values = this.path.get(key);
      if (values && !this.pyramids.has(key)) this.pyramids.set(key, new Pyramid(values));
      strip.show(this.pyramids.get(key) ?? null);
      strip.draw(this.starts);
    }
    measured("strips", begun);
  }

  /** Cursor and values at the point of the robot, or at the one under the pointer. */
  private mark(): void {
    const path = this.path;
    if (!path || this.root.hidden) return;
    const { index } = this;
    const shown = this.over ?? index;
    this.reading.textContent = this.words(shown);
    if (!this.root.open) return;
    this.cursor.style.setProperty("--place", String(this.axis.place(index)));
    for (const { strip } of this.strips) strip.read(shown);
    this.operations.at(index);
    this.tools.at(index);
    this.charts.setAttribute("aria-valuenow", String(index + 1));
    this.charts.setAttribute("aria-valuetext", this.words(index));
  }

  private words(index: number): string {
    const path = this.path!;
    const time = path.get("time_s")?.[index];
    const deviation = path.get("in_plane_um")?.[index];
    const parts = [`point ${fixed(index + 1, 0)} of ${fixed(path.count, 0)}`, `${mm(this.axis.distance[index])} mm`];
    if (time !== undefined) parts.push(`${fixed(time, 1)} s`);
    parts.push(deviation === undefined || Number.isNaN(deviation) ? "no posture" : `${um(deviation)} µm`);
    return parts.join(" · ");
  }

  // ---- Pointer and keys ----

  private listen(): void {
    const { charts } = this;
    charts.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      charts.setPointerCapture(event.pointerId);
      this.player.stop();
      this.scrub(this.pointOf(event));
    });
    charts.addEventListener("pointermove", (event) => {
      const index = this.pointOf(event);
      if (event.buttons & 1) this.scrub(index);
      else this.hover(index);
    });
    charts.addEventListener("pointerleave", () => this.hover(null));
    charts.addEventListener("keydown", (event) => this.key(event));
  }

  private pointOf(event: PointerEvent): number | null {
    const box = this.strips[0]?.strip.canvas.getBoundingClientRect();
    if (!box || box.width === 0 || !this.path) return null;
    return this.axis.point(Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
  }

  /** Goes to a point with the next frame: pointers move more often than the screen shows it. */
  private scrub(index: number | null): void {
    if (index === null) return;
    const waits = this.wanted !== null;
    this.wanted = index;
    this.over = null;
    this.pointer.hidden = true;
    if (waits) return;
    requestAnimationFrame(() => {
      const begun = performance.now();
      const point = this.wanted!;
      this.wanted = null;
      if (point !== this.index || this.live.follow !== "place") this.goTo(point);
      measured("scrub", begun);
    });
  }

  private hover(index: number | null): void {
    const begun = performance.now();
    this.over = index;
    this.pointer.hidden = index === null;
    if (index !== null) this.pointer.style.setProperty("--place", String(this.axis.place(index)));
    this.mark();
    measured("strip-hover", begun);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.path) return;
    const last = this.path.count - 1;
    const page = Math.max(1, Math.round(this.path.count / 50));
    const one = event.shiftKey ? 10 : 1;
    const to: Record<string, number> = {
      ArrowRight: this.index + one,
      ArrowUp: this.index + one,
      ArrowLeft: this.index - one,
      ArrowDown: this.index - one,
      PageUp: this.index + page,
      PageDown: this.index - page,
      Home: 0,
      End: last,
    };
    const point = to[event.key];
    if (event.key === " ") this.player.toggle();
    else if (point !== undefined) {
      this.player.stop();
      this.scrub(Math.min(last, Math.max(0, point)));
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

function jointStrip({ joint, unit, lower, upper }: PathColumn): Strip {
  const limits = [lower, upper].filter((limit) => limit !== null);
  return new Strip({
    title: joint ?? "",
    unit: unit === "deg" ? "°" : (unit ?? ""),
    height: 28,
    text: (value) => fixed(value, 1),
    span: ([low, high]) => {
      const wide = Math.max(LEAST_SPAN, high - low);
      const near = Math.max(NEAR_LIMIT, NEAR_PART * wide);
      const [least, most] = [Math.min(low, (low + high - wide) / 2), Math.max(high, (low + high + wide) / 2)];
      return [lower !== null && low - lower < near ? Math.min(least, lower) : least, upper !== null && upper - high < near ? Math.max(most, upper) : most];
    },
    marks: () => limits.map((limit) => ({ at: limit, text: "limit" })),
  });
}
