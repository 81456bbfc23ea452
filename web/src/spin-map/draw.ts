// The cells of the map on a canvas: coloured by deviation where the arm can be, with a pattern by reason where it cannot,
// and marks where a joint jumps or is too slow.

import { along, viridis } from "../scene/colour";
import type { SpinMap } from "../types";
import { BLOCKED, IN_COLLISION, JUMPS, OUT_OF_REACH, OUTSIDE, TOO_SLOW } from "./cells";
import { edges, plotHeight, plotWidth, ROOM, xOf, yOf, type Frame } from "./frame";

/** Colours of what is not a deviation, by theme. */
export interface Inks {
  /** Of cells out of reach. */
  empty: string;
  /** Of cells in collision. */
  collision: string;
  /** Behind and of the hatching outside joint limits. */
  outside: [string, string];
  /** Behind and of the dots near a singularity. */
  singular: [string, string];
  /** Of jumps, and of joints too slow for the feed. */
  jump: string;
  slow: string;
}

export const LIGHT: Inks = { empty: "#8c949e", collision: "#cc262e", outside: ["#dfe3e8", "#5c6570"], singular: ["#f1e3cc", "#8a5a10"], jump: "#c2185b", slow: "#d55e00" };
export const DARK: Inks = { empty: "#5a636e", collision: "#cc262e", outside: ["#2b343f", "#8f9cab"], singular: ["#3a3120", "#e0ac55"], jump: "#ff7fae", slow: "#ff9d5c" };

export function drawCells(canvas: HTMLCanvasElement, map: SpinMap, frame: Frame, levels_um: number[] | null, inks: Inks): void {
  const ratio = Math.min(2, devicePixelRatio || 1);
  canvas.width = Math.round(frame.width * ratio);
  canvas.height = Math.round(frame.height * ratio);
  const context = canvas.getContext("2d");
  if (!context || map.points.length === 0) return;
  context.scale(ratio, ratio);
  context.save();
  context.beginPath();
  context.rect(ROOM.left, ROOM.top, plotWidth(frame), plotHeight(frame));
  context.clip();
  const xs = edges(map.distance_mm, 0, frame.length_mm).map((d) => xOf(frame, d));
  const ys = edges(map.spins_deg, frame.low_deg, frame.high_deg).map((s) => yOf(frame, s));
  colours(context, map, levels_um, xs, ys);
  patterns(context, map, inks, xs, ys);
  marks(context, map, inks, xs, ys);
  context.restore();
}

/** One picture of the cells, a pixel each, drawn column by column: columns may be unequal. */
function colours(context: CanvasRenderingContext2D, map: SpinMap, levels_um: number[] | null, xs: number[], ys: number[]): void {
  const [columns, rows] = [map.points.length, map.spins_deg.length];
  const image = new ImageData(columns, rows);
  for (let row = 0; row < rows; row++)
    for (let column = 0; column < columns; column++) {
      const value = map.in_plane_um[row]![column];
      if (value === null || value === undefined || !levels_um || (map.state[row]![column]! & BLOCKED) !== 0) continue;
      const rgb = viridis(along(levels_um, value));
      // The last row of the picture is the least spin.
      const at = 4 * ((rows - 1 - row) * columns + column);
      for (let k = 0; k < 3; k++) image.data[at + k] = Math.round(255 * rgb[k]!);
      image.data[at + 3] = 255;
    }
  const small = document.createElement("canvas");
  [small.width, small.height] = [columns, rows];
  small.getContext("2d")!.putImageData(image, 0, 0);
  context.imageSmoothingEnabled = false;
  // Rows are equal, but those at the ends are half as high.
  const pitch = rows > 2 ? (ys[1]! - ys[rows - 1]!) / (rows - 2) : (ys[0]! - ys[rows]!) / rows;
  const top = rows > 2 ? ys[rows - 1]! - pitch : ys[rows]!;
  for (let column = 0; column < columns; column++) {
    // A seam would show the ground between two columns.
    context.drawImage(small, column, 0, 1, rows, xs[column]!, top, xs[column + 1]! - xs[column]! + 0.4, pitch * rows);
  }
}

/** Cells that cannot be used, by reason; those of a row that follow each other are one rectangle. */
function patterns(context: CanvasRenderingContext2D, map: SpinMap, inks: Inks, xs: number[], ys: number[]): void {
  const kinds = [
    { is: (state: number) => (state & OUT_OF_REACH) !== 0, fill: inks.empty },
    { is: (state: number) => (state & IN_COLLISION) !== 0, fill: inks.collision },
    { is: (state: number) => (state & OUT_OF_REACH) === 0 && (state & OUTSIDE) !== 0, fill: hatched(context, inks.outside) },
    { is: (state: number) => (state & BLOCKED) !== 0 && (state & (OUT_OF_REACH | IN_COLLISION | OUTSIDE)) === 0, fill: dotted(context, inks.singular) },
  ];
  for (const { is, fill } of kinds) {
    context.beginPath();
    map.state.forEach((states, row) => {
      let from = -1;
      for (let column = 0; column <= states.length; column++) {
        const inside = column < states.length && is(states[column]!);
        if (inside && from < 0) from = column;
        if (inside || from < 0) continue;
        context.rect(xs[from]!, ys[row + 1]!, xs[column]! - xs[from]!, ys[row]! - ys[row + 1]! + 0.3);
        from = -1;
      }
    });
    context.fillStyle = fill;
    context.fill();
  }
}

/** Jumps as bars at the left edge of their cells, slow joints as a line at the top. */
function marks(context: CanvasRenderingContext2D, map: SpinMap, inks: Inks, xs: number[], ys: number[]): void {
  map.state.forEach((states, row) =>
    states.forEach((state, column) => {
      const height = ys[row]! - ys[row + 1]!;
      if ((state & JUMPS) !== 0) {
        context.fillStyle = inks.jump;
        context.fillRect(xs[column]! - 1, ys[row + 1]!, 2.5, height + 0.3);
      } else if ((state & TOO_SLOW) !== 0) {
        context.fillStyle = inks.slow;
        context.fillRect(xs[column]!, ys[row + 1]! + height / 2 - 0.6, xs[column + 1]! - xs[column]!, 1.2);
      }
    }),
  );
}

function tile(context: CanvasRenderingContext2D, size: number, paint: (tile: CanvasRenderingContext2D) => void): CanvasPattern | string {
  const small = document.createElement("canvas");
  small.width = small.height = size;
  paint(small.getContext("2d")!);
  return context.createPattern(small, "repeat") ?? "#888";
}

const hatched = (context: CanvasRenderingContext2D, [back, ink]: [string, string]): CanvasPattern | string =>
  tile(context, 8, (t) => {
    t.fillStyle = back;
    t.fillRect(0, 0, 8, 8);
    t.strokeStyle = ink;
    t.lineWidth = 1.2;
    t.beginPath();
    for (const offset of [-8, 0, 8]) {
      t.moveTo(offset, 8);
      t.lineTo(offset + 8, 0);
    }
    t.stroke();
  });

const dotted = (context: CanvasRenderingContext2D, [back, ink]: [string, string]): CanvasPattern | string =>
  tile(context, 6, (t) => {
    t.fillStyle = back;
    t.fillRect(0, 0, 6, 6);
    t.fillStyle = ink;
    t.fillRect(1, 1, 2, 2);
    t.fillRect(4, 4, 2, 2);
  });
