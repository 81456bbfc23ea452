// The stability of the cut at the target, in the posture shown: limit, cause, preferred speeds, and the lobes over the spindle speed.

import { h, s, type Child } from "../dom";
import { fixed, um } from "../format";
import type { Live } from "../live";
import { Newest } from "../newest";
import { Refused, api } from "../server";
import type { At, Lobes, Stability } from "../types";
import { panel } from "./panel";

/** A posture has to stay this long before its lobes are requested, ms. */
const PATIENCE_MS = 150;
/** Size of the drawing, and its margins, px. */
const [WIDTH, HEIGHT] = [320, 150];
const MARGIN = { left: 34, right: 8, top: 8, bottom: 24 };
/** Deepest cut of the drawing in multiples of the lowest limit, and of the programmed depth. */
const SHOWN = [8, 1.5] as const;

interface Target {
  at: At;
  joints_deg: number[];
}

export function lobes(live: Live): HTMLElement {
  const { root, show } = panel("lobes", "Stability of the cut");
  let waits: ReturnType<typeof setTimeout> | undefined;
  const requests = new Newest<Target, Lobes>({
    work: ({ at, joints_deg }, signal) => api.lobes(live.text, live.analysis, at, joints_deg, signal),
    done: (found) => draw(found),
    failed: (error) => {
      if (error instanceof Refused && error.kind === "superseded") return;
      show(h("p", { class: "note warn" }, error instanceof Error ? error.message : String(error)));
    },
  });
  const draw = ({ stability, missing }: Lobes) => {
    root.hidden = stability === null && missing === null;
    show(stability ? found(stability) : h("p", { class: "note" }, missing ? `${missing[0]!.toUpperCase()}${missing.slice(1)}.` : null));
  };
  const request = () => {
    clearTimeout(waits);
    const joints_deg = live.pose?.answer.postures[live.posture]?.joints_deg;
    const at = live.at;
    root.hidden = !live.asksForVibration;
    if (root.hidden) return requests.cancel();
    if (!joints_deg || at === null) return show(h("p", { class: "note" }, "Click a point of the plate or path."));
    waits = setTimeout(() => requests.submit({ at, joints_deg }), PATIENCE_MS);
  };
  live.listen(["pose", "answer"], request);
  request();
  return root;
}

function found(of: Stability): Child {
  const limit = of.stable_depth_mm;
  const probability = of.probability_stable;
  const preferred = of.preferred_speeds.slice(0, 3).map((speed) => `${fixed(speed.speed_rpm, 0)} (${speed.depth_mm === null ? "> " : ""}${fixed(speed.depth_mm ?? of.deepest_mm, 1)} mm)`);
  return [
    h("p", { class: of.is_stable ? "note" : "note warn" }, `${of.verdict[0]!.toUpperCase()}${of.verdict.slice(1)}.`),
    drawing(of),
    h(
      "dl",
      { class: "facts" },
      fact("Limit", limit === null ? `> ${fixed(of.deepest_mm, 1)}` : fixed(limit, 2), of.depth_u_percent ? `mm, u ${fixed(of.depth_u_percent, 0)} %` : "mm"),
      probability === null ? null : fact("Probability of stability", fixed(100 * probability, 1), "%"),
      of.mode_coupling_depth_mm === null ? null : fact("By mode coupling alone", fixed(of.mode_coupling_depth_mm, 2), "mm"),
      preferred.length > 0 ? fact("Preferred speeds", preferred.join(", "), "rpm") : null,
      fact("Vibration under the teeth", of.vibration.amplitude_um.map((value) => um(value)).join(", "), "µm along, across, axial"),
      of.vibration.walls.map((wall) => fact(`Wall on the ${wall.side}`, `${um(wall.least_um)} to ${um(wall.greatest_um)}`, "µm")),
    ),
  ];
}

const fact = (name: string, value: string, unit: string): Child => [h("dt", {}, name), h("dd", {}, h("b", {}, value), ` ${unit}`)];

/** The limit over the spindle speed; below it the cut is stable. */
function drawing(of: Stability): Child {
  const lowest = of.lowest_depth_mm ?? of.deepest_mm;
  const top = Math.min(of.deepest_mm, Math.max(SHOWN[0] * lowest, SHOWN[1] * of.depth_mm));
  const speeds = of.lobes.map((lobe) => lobe.speed_rpm);
  const [low, high] = [speeds[0] ?? 0, speeds.at(-1) ?? 1];
  const x = (rpm: number) => MARGIN.left + ((rpm - low) / (high - low)) * (WIDTH - MARGIN.left - MARGIN.right);
  const y = (mm: number) => HEIGHT - MARGIN.bottom - (Math.min(mm, top) / top) * (HEIGHT - MARGIN.top - MARGIN.bottom);
  const line = of.lobes.map((lobe) => `${x(lobe.speed_rpm).toFixed(1)},${y(lobe.depth_mm ?? top).toFixed(1)}`).join(" ");
  const ground = y(0);
  const ticks = steps(low, high, 4).map((rpm) => [s("line", { class: "lobes-tick", x1: x(rpm), x2: x(rpm), y1: ground, y2: ground + 4 }), s("text", { class: "lobes-text", x: x(rpm), y: ground + 15, "text-anchor": "middle" }, fixed(rpm, 0))]);
  const levels = steps(0, top, 4).map((mm) => [s("line", { class: "lobes-grid", x1: MARGIN.left, x2: WIDTH - MARGIN.right, y1: y(mm), y2: y(mm) }), s("text", { class: "lobes-text", x: MARGIN.left - 4, y: y(mm) + 3.5, "text-anchor": "end" }, fixed(mm, top < 2 ? 2 : top < 20 ? 1 : 0))]);
  const words = `Limit of the axial depth from ${fixed(low, 0)} to ${fixed(high, 0)} rpm; lowest ${fixed(lowest, 2)} mm`;
  return s(
    "svg",
    { class: "lobes", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": words },
    s("title", {}, `${words}. The cut is stable in the shaded region below the line.`),
    levels,
    s("polygon", { class: "lobes-stable", points: `${x(low)},${ground} ${line} ${x(high)},${ground}` }),
    s("polyline", { class: "lobes-line", points: line }),
    ticks,
    s("circle", { class: of.is_stable ? "lobes-cut" : "lobes-cut over", cx: x(of.spindle_rpm), cy: y(of.depth_mm), r: 4 }),
    s("text", { class: "lobes-text", x: MARGIN.left + 3, y: MARGIN.top + 9 }, "mm"),
    s("text", { class: "lobes-text", x: WIDTH - MARGIN.right, y: HEIGHT - MARGIN.bottom - 5, "text-anchor": "end" }, "rpm"),
  );
}

/** Round numbers from low to high, at most about `count`. */
function steps(low: number, high: number, count: number): number[] {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((part) => part * power).find((size) => size >= rough) ?? rough;
  const first = Math.ceil(low / step);
  const last = Math.floor(high / step);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => (first + k) * step);
}
