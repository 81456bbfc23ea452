// One chart of the timeline: the values of a column as the range that each pixel has, so that a redraw costs its width and not the
// length of the path.

import { h } from "../dom";
import { shade } from "../scene/colour";
import type { Pyramid, Range } from "./pyramid";

export interface StripAbout {
  title: string;
  unit: string;
  /** Height of the chart, px. */
  height: number;
  /** A value without its unit. */
  text: (value: number) => string;
  /** What the chart shows, from the range of the values. */
  span: (values: Range) => Range;
  /** Lines across the chart, at most within its span. */
  marks: () => { at: number; text: string }[];
  /** Values above it have the colour of a tolerance that is exceeded. */
  above?: () => number;
}

export class Strip {
  readonly root: HTMLElement;
  readonly canvas = h("canvas", { "aria-hidden": "true" });
  private readonly reading = h("output", { class: "strip-value" });
  private pyramid: Pyramid | null = null;

  constructor(private readonly about: StripAbout) {
    this.canvas.style.height = `${about.height}px`;
    this.root = h("div", { class: "strip" }, h("span", { class: "strip-name", title: about.title }, about.title), h("span", { class: "strip-chart" }, this.canvas), this.reading);
  }

  show(pyramid: Pyramid | null): void {
    this.pyramid = pyramid;
    this.root.classList.toggle("waits", pyramid === null);
  }

  /** The value at a point, as text. */
  read(index: number): void {
    const value = this.pyramid?.values[index];
    const text = value === undefined || Number.isNaN(value) ? "–" : `${this.about.text(value)} ${this.about.unit}`;
    if (this.reading.textContent !== text) this.reading.textContent = text;
    const above = this.about.above?.() ?? Infinity;
    this.reading.classList.toggle("over", value !== undefined && value > above);
  }

  /** `starts`: the first point of each pixel, and their number at the end. */
  draw(starts: Uint32Array): void {
    const { canvas, pyramid, about } = this;
    const [width, height] = [starts.length - 1, about.height];
    const ratio = Math.min(2, devicePixelRatio);
    const [w, hh] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== w) canvas.width = w;
    if (canvas.height !== hh) canvas.height = hh;
    const context = canvas.getContext("2d");
    if (!context) return;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    if (!pyramid) return;
    const [low, high] = about.span(pyramid.all);
    if (!(high > low)) return;
    const y = (value: number) => 3 + (height - 6) * (1 - (value - low) / (high - low));
    const line = outline(pyramid, starts, y);
    const draw = (colour: string, top: number, bottom: number) => {
      context.save();
      context.beginPath();
      context.rect(0, top, width, bottom - top);
      context.clip();
      context.strokeStyle = colour;
      context.lineWidth = 1.4;
      context.lineJoin = "round";
      context.stroke(line);
      context.restore();
    };
    const limit = about.above?.();
    const edge = limit === undefined ? 0 : Math.max(0, Math.min(height, y(limit)));
    draw(css("--bar"), edge, height);
    if (edge > 0) draw(css("--bad"), 0, edge);
    context.font = "11px system-ui, sans-serif";
    for (const { at, text } of about.marks()) {
      if (at < low || at > high) continue;
      context.strokeStyle = css("--ink");
      context.lineWidth = 1;
      context.setLineDash([5, 4]);
      context.beginPath();
      context.moveTo(0, Math.round(y(at)) + 0.5);
      context.lineTo(width, Math.round(y(at)) + 0.5);
      context.stroke();
      context.setLineDash([]);
      if (text === "") continue;
      const wide = context.measureText(text).width;
      // Values above a tolerance are the ones that matter: its name is beneath it.
      const beneath = y(at) < height - 15;
      context.fillStyle = css("--surface");
      context.globalAlpha = 0.8;
      context.fillRect(width - wide - 6, beneath ? y(at) + 1 : y(at) - 13, wide + 6, 13);
      context.globalAlpha = 1;
      context.fillStyle = css("--ink");
      context.fillText(text, width - wide - 3, beneath ? y(at) + 12 : y(at) - 3);
    }
  }
}

/** Through the range of each pixel; it breaks where no value is known. Few points are joined as they are. */
function outline(pyramid: Pyramid, starts: Uint32Array, y: (value: number) => number): Path2D {
  const path = new Path2D();
  let joined = false;
  for (let x = 0; x + 1 < starts.length; x++) {
    const [first, end] = [starts[x]!, starts[x + 1]!];
    // Between two points that are more than a pixel apart.
    if (first >= end) continue;
    const [low, high] = pyramid.range(first, end);
    if (low > high) {
      joined = false;
      continue;
    }
    const at = x + 0.5;
    if (joined) path.lineTo(at, y(high));
    else path.moveTo(at, y(high));
    path.lineTo(at, y(low));
    joined = true;
  }
  return path;
}

const css = (name: string): string => `#${shade(name).getHexString()}`;
