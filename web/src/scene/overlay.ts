// Overlay of the scene: legend, view buttons, visibility, arrow scales, values under the pointer.

import { fill, h, renew, s } from "../dom";
import { fixed, mm, percent, plusMinus, trimmed, um } from "../format";
import type { Live } from "../live";
import { along, css, ends, viridis } from "./colour";
import type { View } from "./stage";
import { ELLIPSOID, type SceneView, type Show, type Under } from "./view";

const VIEWS: [View, string, string][] = [["overview", "Overview", "1"], ["front", "Front", "2"], ["side", "Side", "3"], ["top", "Top", "4"], ["plate", "Plate", "5"]];
const SWITCHES: [keyof Show | keyof Live["wanted"], string][] = [["arm", "Arm"], ["shape", "CAD meshes"], ["forces", "Force arrow"], ["deviation", "Deviation arrow"], ["parts", "Components: in plane, normal"], ["ellipsoid", "Compliance ellipsoid"], ["lines", "Lines of equal deviation"], ["certainty", "Robustly within (dashed)"], ["rectangle", "Largest rectangle within"], ["fix_scale", "Fix the colour scale"]];

export function overlay(view: SceneView, live: Live): HTMLElement {
  const legendBox = h("div", { class: "legend card", role: "img" });
  const tip = h("div", { class: "tip card", hidden: true });
  const magnified = h("output", {}, times(view.show.magnified));
  const slider = h("input", { id: "magnified", type: "range", min: 2, max: 5, step: 0.05, value: Math.log10(view.show.magnified), "aria-label": "Deviation drawn larger by" });
  const redraw = () => live.notify("view");
  slider.addEventListener("input", () => {
    view.show.magnified_by_hand = true;
    view.show.magnified = Number((10 ** Number(slider.value)).toPrecision(2));
    magnified.textContent = times(view.show.magnified);
    redraw();
  });
  const soft = h("p", { hidden: true }, h("i", { class: "swatch soft" }), `ellipsoid, ${ELLIPSOID} mm per µm/N`);
  const parts = h("p", { hidden: true }, h("i", { class: "swatch flat" }), "in plane", h("i", { class: "swatch normal" }), "normal");
  const views = h(
    "div",
    { class: "views card", role: "group", "aria-label": "Views" },
    VIEWS.map(([name, text, key]) => h("button", { type: "button", title: `${text} view (key ${key})`, onclick: () => view.look(name) }, text)),
  );
  const shown = h(
    "details",
    { class: "shown card" },
    h("summary", {}, "Show"),
    SWITCHES.map(([key, text]) => {
      const by_server = key in live.wanted;
      const flags = (by_server ? live.wanted : view.show) as Record<typeof key, boolean>;
      const box = h("input", { type: "checkbox", checked: flags[key] });
      box.addEventListener("change", () => {
        if (key === "ellipsoid") soft.hidden = !box.checked;
        if (key === "parts") parts.hidden = !box.checked;
        flags[key] = box.checked;
        if (by_server) live.refresh();
        else redraw();
      });
      const label = h("label", {}, box, ` ${text}`);
      // There to be chosen where the robot has one.
      if (key === "shape") live.listen(["pose"], () => (label.hidden = !live.pose?.drawings.some((d) => d.meshes.length > 0)));
      return label;
    }),
  );
  const scales = h(
    "div",
    { class: "scales card" },
    h("p", {}, h("i", { class: "swatch moved" }), h("label", { for: "magnified" }, "deviation "), magnified),
    slider,
    parts,
    h("p", {}, h("i", { class: "swatch force" }), `force, ${view.show.mm_per_n} mm per N`),
    soft,
  );
  document.addEventListener("keydown", (e) => {
    const target = e.target as HTMLElement;
    if (e.ctrlKey || e.metaKey || e.altKey || target.matches("input, textarea, select") || view.stage.host.offsetParent === null) return;
    const hit = VIEWS.find(([, , key]) => key === e.key);
    if (hit) view.look(hit[0]);
  });
  view.onScale = () => {
    legend(legendBox, live);
    magnified.textContent = times(view.show.magnified);
    slider.value = String(Math.log10(view.show.magnified));
  };
  view.onHover = (under, x, y) => hover(tip, live, under, x, y, view.stage.host);
  const cards = [views, shown, scales, legendBox];
  const keepOut = new ResizeObserver(() => {
    const host = view.stage.host.getBoundingClientRect();
    view.stage.labels.keep_out = cards.map((card) => {
      const { left, top, right, bottom } = card.getBoundingClientRect();
      return [left - host.left, top - host.top, right - host.left, bottom - host.top];
    });
    view.stage.draw();
  });
  for (const element of [view.stage.host, ...cards]) keepOut.observe(element);
  return h("div", { class: "overlay" }, views, shown, scales, legendBox, tip);
}

const times = (n: number): string => `× ${trimmed(n, 0)}`;

/** The colour bar, with ticks at the lines' levels and the tolerance marked. */
function legend(box: HTMLElement, live: Live): void {
  const scale = live.levels_um;
  const tolerance = live.setting?.tolerance_um;
  if (!scale || tolerance === undefined) return;
  const W = 280;
  const [low, high] = ends(scale);
  const at = (value: number) => 14 + (W - 28) * along(scale, value);
  const stops = Array.from({ length: 21 }, (_, i) => s("stop", { offset: i / 20, "stop-color": css(viridis(i / 20)) }));
  const every = Math.ceil(scale.length / 6);
  const inside = tolerance >= low && tolerance <= high;
  const cases = live.setting!.cases_n.length;
  box.setAttribute("aria-label", `Colours from ${um(low)} to ${um(high)} micrometres; tolerance ${um(tolerance)}`);
  renew(
    box,
    h("p", { class: "legend-name" }, "In-plane deviation ", h("b", {}, "µm"), cases > 1 ? h("small", {}, ` largest of ${cases} load cases`) : null),
    s(
      "svg",
      { width: W, height: 46, viewBox: `0 0 ${W} 46`, "aria-hidden": "true" },
      s("defs", {}, s("linearGradient", { id: "bar" }, stops)),
      s("rect", { x: 14, y: 15, width: W - 28, height: 12, rx: 2, fill: "url(#bar)" }),
      scale.filter((_, i) => i % every === 0).map((level) => [
        s("line", { x1: at(level), x2: at(level), y1: 27, y2: 31, class: "tick" }),
        s("text", { x: at(level), y: 43, "text-anchor": "middle" }, trimmed(level, 1)),
      ]),
      inside
        ? [s("path", { d: `M${at(tolerance)} 29 V13 m-5 -7 h10 l-5 7 z`, class: "limit" }), s("text", { x: at(tolerance) > W - 90 ? at(tolerance) - 9 : at(tolerance) + 9, y: 10, class: "limit-text", "text-anchor": at(tolerance) > W - 90 ? "end" : "start" }, `tolerance ${trimmed(tolerance, 1)}`)]
        : [s("text", { x: tolerance < low ? 14 : W - 14, y: 10, class: "limit-text", "text-anchor": tolerance < low ? "start" : "end" }, tolerance < low ? `◀ tolerance ${trimmed(tolerance, 1)}, all above it` : `tolerance ${trimmed(tolerance, 1)}, all below it ▶`)],
    ),
  );
}

function hover(tip: HTMLElement, live: Live, under: Under, x: number, y: number, host: HTMLElement): void {
  tip.hidden = under === null;
  if (under === null) return;
  const rows: [string, string][] = [];
  if (under.kind === "map") {
    const grid = live.map!.grid;
    const i = under.index;
    const flags = grid.flags.filter((r) => r.points.includes(i)).map((r) => r.reason.replaceAll("_", " "));
    rows.push(["y′, z′", `${mm(under.y_mm)}, ${mm(under.z_mm)} mm`], ["In plane", `${um(grid.in_plane_um[i])} ${plusMinus(grid.in_plane_u_um[i])}`], ["Normal", `${um(grid.normal_um[i])} µm`], ["Full", `${um(grid.full_um[i])} µm`], ["Within the tolerance", grid.probability_within[i] === null ? "probability not known" : `probability ${percent(grid.probability_within[i])}`]);
    for (const flag of flags) rows.push(["", flag]);
  } else {
    const points = live.scene!.points!;
    const columns = points.columns;
    const i = under.index;
    rows.push(["Point", String(i + 1)], ["x, y, z", `${points.xyz_mm[i]!.map((v) => fixed(v, 1)).join(", ")} mm`]);
    for (const [name, list] of [["In plane", columns.in_plane_um], ["Along", columns.along_um], ["Across", columns.cross_um], ["Normal", columns.normal_um], ["Full", columns.full_um]] as const) if (list) rows.push([name, `${um(list[i])} µm`]);
  }
  fill(tip, h("dl", {}, rows.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])), h("p", {}, "Click: the robot goes there"));
  const box = host.getBoundingClientRect();
  const left = x - box.left + (x - box.left > box.width - 230 ? -225 : 16);
  const top = Math.min(y - box.top + 12, box.height - 170);
  tip.style.transform = `translate(${left}px, ${Math.max(4, top)}px)`;
}
