// Axes, curves and knots over the cells. A knot is dragged, or moved by keys; each has its values in words.

import { h, renew, s } from "../dom";
import { fixed, mm, trimmed } from "../format";
import { distanceOf, plotHeight, plotWidth, ROOM, spinOf, spinTicks, ticks, xOf, yOf, type Frame } from "./frame";
import { added, between, moved, removed, type Knot, type Range } from "./knots";

export interface Curves {
  /** Null: the curve is shown, but cannot be changed. */
  knots: Knot[] | null;
  chosen: Knot[];
  searched: [distance_mm: number, spin_deg: number | null][] | null;
  /** Where the robot is. */
  robot_mm: number | null;
}

export interface LinesHandlers {
  change: (knots: Knot[]) => void;
  /** What the map has at a knot, in words. */
  words: (knot: Knot) => string;
  /** A knot has the focus, or none. */
  focus: (index: number | null) => void;
}

/** Steps of the arrow keys: degrees, and parts of the path; ten times that with Shift. */
const STEP_DEG = 1;
const STEP_LENGTH = 0.01;

export class Lines {
  readonly root = s("svg", { class: "spin-lines", role: "group", "aria-label": "Spin along the path" });
  private readonly axes = s("g", { class: "spin-axes", "aria-hidden": "true" });
  private readonly paths = s("g", { "aria-hidden": "true" });
  private readonly handles: SVGGElement[] = [];
  private frame: Frame | null = null;
  private curves: Curves | null = null;
  private dragged: number | null = null;

  constructor(private readonly on: LinesHandlers) {
    this.root.append(this.axes, this.paths);
    this.root.addEventListener("pointermove", (e) => this.drag(e));
    for (const end of ["pointerup", "pointercancel"]) this.root.addEventListener(end, () => this.drop());
    this.root.addEventListener("dblclick", (e) => this.addAt(distanceOf(this.frame!, this.place(e)[0])));
  }

  get isDragged(): boolean {
    return this.dragged !== null;
  }

  draw(frame: Frame, curves: Curves): void {
    this.frame = frame;
    this.curves = curves;
    this.root.setAttribute("viewBox", `0 0 ${frame.width} ${frame.height}`);
    renew(this.axes, axes(frame));
    const line = (points: (Knot | null)[], kind: string) => s("path", { class: kind, d: pathOf(points, frame) });
    const { chosen, searched, robot_mm } = curves;
    const whole: Knot[] = [[0, chosen[0]![1]], ...chosen, [frame.length_mm, chosen.at(-1)![1]]];
    const drawn = whole.flatMap((knot, i) => wrapped(whole[i - 1] ?? null, knot, frame));
    renew(
      this.paths,
      robot_mm === null ? null : s("path", { class: "spin-robot", d: `M${xOf(frame, robot_mm).toFixed(1)} ${ROOM.top}v${plotHeight(frame)}` }),
      searched ? [line(broken(searched, frame), "spin-casing"), line(broken(searched, frame), "spin-searched")] : null,
      line(drawn, "spin-casing"),
      line(drawn, "spin-chosen"),
    );
    this.drawHandles(curves.knots ?? [], frame);
  }

  /** A knot more, on the curve. */
  addAt(distance_mm: number): void {
    const { knots } = this.curves!;
    const more = knots && added(knots, distance_mm, this.range);
    if (!more) return;
    this.on.change(more.knots);
    this.handles[more.index]?.focus();
  }

  /** A knot more after the one with the focus, or in the widest gap. */
  add(index: number | null): void {
    const { knots } = this.curves!;
    if (knots) this.addAt(between(knots, index ?? widest(knots)));
  }

  remove(index: number | null): void {
    const { knots } = this.curves!;
    if (!knots || knots.length <= 2) return;
    const which = index ?? knots.length - 1;
    this.on.change(removed(knots, which));
    this.handles[Math.min(which, knots.length - 2)]?.focus();
  }

  private get range(): Range {
    const { length_mm, low_deg, high_deg } = this.frame!;
    return { length_mm, low_deg, high_deg };
  }

  private drawHandles(knots: Knot[], frame: Frame): void {
    while (this.handles.length > knots.length) this.handles.pop()!.remove();
    while (this.handles.length < knots.length) {
      const index = this.handles.length;
      const handle = s("g", { class: "spin-knot", role: "slider", tabindex: "0", "aria-orientation": "vertical" }, s("circle", { r: 13, class: "spin-catch" }), s("circle", { r: 5.5 }));
      handle.addEventListener("keydown", (e) => this.key(e, index));
      handle.addEventListener("focus", () => this.on.focus(index));
      handle.addEventListener("blur", () => this.on.focus(null));
      handle.addEventListener("pointerdown", (e) => {
        this.dragged = index;
        handle.focus();
        this.root.setPointerCapture(e.pointerId);
        e.preventDefault();
      });
      this.handles.push(handle);
      this.root.append(handle);
    }
    knots.forEach((knot, i) => {
      const [distance_mm, spin_deg] = knot;
      const handle = this.handles[i]!;
      handle.setAttribute("transform", `translate(${xOf(frame, distance_mm).toFixed(1)} ${yOf(frame, shown(spin_deg, frame)).toFixed(1)})`);
      handle.setAttribute("aria-label", `Knot ${i + 1} of ${knots.length}, spin in degrees`);
      handle.setAttribute("aria-valuemin", fixedNumber(frame.low_deg));
      handle.setAttribute("aria-valuemax", fixedNumber(frame.high_deg));
      handle.setAttribute("aria-valuenow", fixedNumber(spin_deg));
      handle.setAttribute("aria-valuetext", `${fixed(spin_deg, 1)}° at ${mm(distance_mm)} mm: ${this.on.words(knot)}`);
    });
  }

  private key(event: KeyboardEvent, index: number): void {
    const knots = this.curves?.knots;
    if (!knots) return;
    const times = event.shiftKey ? 10 : 1;
    const along = STEP_LENGTH * this.range.length_mm * times;
    const steps: Record<string, Knot> = { ArrowUp: [0, STEP_DEG * times], ArrowDown: [0, -STEP_DEG * times], PageUp: [0, 10 * STEP_DEG], PageDown: [0, -10 * STEP_DEG], ArrowRight: [along, 0], ArrowLeft: [-along, 0] };
    const step = steps[event.key];
    if (step) this.on.change(moved(knots, index, [knots[index]![0] + step[0], knots[index]![1] + step[1]], this.range));
    else if (event.key === "Insert") this.add(index);
    else if (event.key === "Delete" || event.key === "Backspace") this.remove(index);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private drag(event: PointerEvent): void {
    const knots = this.curves?.knots;
    if (this.dragged === null || !knots) return;
    const [x, y] = this.place(event);
    const frame = this.frame!;
    this.on.change(moved(knots, this.dragged, [distanceOf(frame, x), spinOf(frame, y)], this.range));
  }

  private drop(): void {
    if (this.dragged === null) return;
    this.dragged = null;
    const index = this.handles.findIndex((handle) => handle === document.activeElement);
    this.on.focus(index < 0 ? null : index);
  }

  private place(event: MouseEvent): [number, number] {
    const box = this.root.getBoundingClientRect();
    return [((event.clientX - box.left) / box.width) * this.frame!.width, ((event.clientY - box.top) / box.height) * this.frame!.height];
  }
}

const fixedNumber = (value: number): string => String(Math.round(value * 10) / 10);

/** A spin beyond the rows is drawn whole turns away. */
function shown(spin_deg: number, { low_deg, high_deg }: Frame): number {
  if (spin_deg >= low_deg && spin_deg <= high_deg) return spin_deg;
  const turned = low_deg + ((((spin_deg - low_deg) % 360) + 360) % 360);
  return Math.min(high_deg, turned);
}

/** The end of a straight piece, with a break where it leaves the rows and comes back whole turns away. */
function wrapped(before: Knot | null, knot: Knot, frame: Frame): (Knot | null)[] {
  const here: Knot = [knot[0], shown(knot[1], frame)];
  if (before === null) return [here];
  const apart = Math.abs(shown(before[1], frame) - here[1]);
  return Math.abs(apart - Math.abs(before[1] - knot[1])) < 1e-6 ? [here] : [null, here];
}

/** With breaks where there is no spin, and where it passes from the last row to the first. */
function broken(points: [number, number | null][], frame: Frame): (Knot | null)[] {
  const found: (Knot | null)[] = [];
  for (const [distance_mm, spin_deg] of points) {
    const last = found.at(-1);
    if (spin_deg === null) {
      if (last) found.push(null);
      continue;
    }
    const here: Knot = [distance_mm, shown(spin_deg, frame)];
    if (last && Math.abs(last[1] - here[1]) > 180) found.push(null);
    found.push(here);
  }
  return found;
}

function pathOf(points: (Knot | null)[], frame: Frame): string {
  let pen = false;
  const parts = points.map((point) => {
    const command = point === null ? "" : `${pen ? "L" : "M"}${xOf(frame, point[0]).toFixed(1)} ${yOf(frame, point[1]).toFixed(1)}`;
    pen = point !== null;
    return command;
  });
  return parts.join("");
}

/** The knot before the widest gap. */
function widest(knots: Knot[]): number {
  const gaps = knots.slice(1).map(([d], i) => d - knots[i]![0]);
  return gaps.indexOf(Math.max(...gaps));
}

function axes(frame: Frame): SVGElement[] {
  const [right, bottom] = [ROOM.left + plotWidth(frame), ROOM.top + plotHeight(frame)];
  const count = Math.max(2, Math.min(8, Math.floor(plotWidth(frame) / 80)));
  const along = ticks(0, frame.length_mm, count).map((d) => [s("path", { d: `M${xOf(frame, d).toFixed(1)} ${bottom}v4` }), s("text", { x: xOf(frame, d), y: bottom + 14, "text-anchor": "middle" }, trimmed(d, 2))]);
  const up = spinTicks(frame.low_deg, frame.high_deg).map((d) => [s("path", { d: `M${ROOM.left} ${yOf(frame, d).toFixed(1)}h-4` }), s("text", { x: ROOM.left - 6, y: yOf(frame, d) + 3.5, "text-anchor": "end" }, `${trimmed(d, 1)}°`)]);
  const border = s("rect", { x: ROOM.left, y: ROOM.top, width: plotWidth(frame), height: plotHeight(frame), class: "spin-border" });
  return [border, ...along.flat(), ...up.flat(), s("text", { x: right, y: bottom + 27, "text-anchor": "end", class: "spin-axis-name" }, "mm along the path"), s("text", { x: ROOM.left, y: bottom + 27, class: "spin-axis-name" }, "spin of the tool")];
}

/** A place for the canvas and the lines over it. */
export const stacked = (canvas: HTMLCanvasElement, lines: SVGElement): HTMLElement => h("div", { class: "spin-plot" }, canvas, lines);
