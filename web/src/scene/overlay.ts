// Overlay of the scene: legend, view buttons, visibility, arrow scales, values under the pointer.

import { fill, h, renew, s } from "../dom";
import { fixed, mm, percent, plusMinus, trimmed, um } from "../format";
import { headline, lostHoles } from "../headline";
import type { Live } from "../live";
import type { BodyRole, LayerKey, MapAnswer } from "../types";
import { lastFrom } from "../timeline/bands";
import { nearest, valueAt, type Hit } from "../machined-part/boxes";
import { LAYER, scaleOf } from "../machined-part/colours";
import type { PartState } from "../machined-part/state";
import { QUANTITIES } from "../machined-part/surface";
import { along, css, ends, type Scale } from "./colour";
import { handleBar } from "./handle-bar";
import { colourOf, FIRST, LAYERS, levelText, namedColour, shownLayer, textOf, type ShownLayer } from "./layers";
import { outsideLimits } from "./plate";
import { SHOWN } from "./points";
import type { View } from "./stage";
import { ELLIPSOID, type SceneView, type Show, type Under } from "./view";

const VIEWS: [View, string, string][] = [["overview", "Overview", "1"], ["front", "Front", "2"], ["side", "Side", "3"], ["top", "Top", "4"], ["plate", "Plate", "5"]];
const SWITCHES: [keyof Show | keyof Live["wanted"], string][] = [["arm", "Arm"], ["machined", "Machined part"], ["path", "Tool path"], ["shape", "CAD meshes"], ["bodies", "Bodies of the cell"], ["link_bodies", "Bodies of the links"], ["nearest", "Nearest bodies"], ["forces", "Force arrow"], ["deviation", "Deviation arrow"], ["parts", "Components: in plane, normal"], ["ellipsoid", "Compliance ellipsoid"], ["lines", "Lines of equal deviation"], ["pinned", "Pinned arm"], ["certainty", "Robustly within (dashed)"], ["rectangle", "Largest rectangle within"], ["fix_scale", "Fix the colour scale"]];

export function overlay(view: SceneView, live: Live, part: PartState): HTMLElement {
  const legendBox = h("div", { class: "legend", role: "img" });
  const layer = h("select", { id: "layer", "aria-label": "Colours show" }, Object.entries(LAYERS).map(([key, { title }]) => h("option", { value: key }, title)));
  layer.addEventListener("change", () => live.chooseLayer(layer.value as LayerKey));
  const partLegend = h("div", { class: "part-legend", role: "img", hidden: true });
  const colours = h("div", { class: "colours card" }, partLegend, layer, legendBox);
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
  const force = h("span", {}, forceScale(view.show.mm_per_n));
  const soft = h("p", { hidden: true }, h("i", { class: "swatch soft" }), `ellipsoid, ${ELLIPSOID} mm per µm/N`);
  const parts = h("p", { hidden: true }, h("i", { class: "swatch flat" }), "in plane", h("i", { class: "swatch normal" }), "normal");
  const views = h(
    "div",
    { class: "views card", role: "group", "aria-label": "Views" },
    VIEWS.map(([name, text, key]) => h("button", { type: "button", title: `${text} view (key ${key})`, onclick: () => view.look(name) }, text)),
    h("button", { type: "button", title: "Fit all into the view (key 0)", onclick: () => view.fit() }, "Fit"),
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
        if (key === "path") view.path_by_hand = true;
        if (by_server) live.refresh();
        else redraw();
      });
      const label = h("label", {}, box, ` ${text}`);
      // There to be chosen where the robot has one.
      if (key === "shape") live.listen(["pose"], () => (label.hidden = !live.pose?.drawings.some((d) => d.meshes.length > 0)));
      if (key === "pinned") live.listen(["view"], () => (label.hidden = live.pinned === null));
      const cell = () => live.scene?.cell;
      if (key === "bodies" || key === "nearest") live.listen(["answer"], () => (label.hidden = !cell()));
      if (key === "link_bodies") live.listen(["answer"], () => (label.hidden = !cell()?.arm.some(({ role }) => role === "link")));
      if (key === "machined" || key === "path")
        live.listen(["part", "view"], () => {
          label.hidden = !part.there;
          box.checked = view.show[key];
        });
      label.hidden = key === "pinned" || key === "machined" || key === "path";
      return label;
    }),
  );
  const scales = h(
    "div",
    { class: "scales card" },
    h("p", {}, h("i", { class: "swatch moved" }), h("label", { for: "magnified" }, "deviation "), magnified),
    slider,
    parts,
    h("p", {}, h("i", { class: "swatch force" }), force),
    soft,
  );
  document.addEventListener("keydown", (e) => {
    const target = e.target as HTMLElement;
    if (e.ctrlKey || e.metaKey || e.altKey || target.matches("input, textarea, select") || view.stage.host.offsetParent === null) return;
    if (e.key === "0") view.fit();
    const hit = VIEWS.find(([, , key]) => key === e.key);
    if (hit) view.look(hit[0]);
  });
  view.onScale = () => {
    const of_part = part.visible && part.surface?.finished === true && partScale(partLegend, part);
    partLegend.hidden = !of_part;
    const of_path = !part.there || view.show.path;
    legend(legendBox, live);
    if (!of_path) legendBox.hidden = true;
    layer.hidden = legendBox.hidden;
    colours.hidden = legendBox.hidden && partLegend.hidden;
    if (layer.value !== live.layer) layer.value = live.layer;
    magnified.textContent = times(view.show.magnified);
    force.textContent = forceScale(view.show.mm_per_n);
    slider.value = String(Math.log10(view.show.magnified));
  };
  view.onHover = (under, x, y) => hover(tip, live, part, under, x, y, view.stage.host);
  const cards = [views, handleBar(view, live), shown, scales, colours];
  const keepOut = new ResizeObserver(() => {
    const host = view.stage.host.getBoundingClientRect();
    view.stage.labels.keep_out = cards.map((card) => {
      const { left, top, right, bottom } = card.getBoundingClientRect();
      return [left - host.left, top - host.top, right - host.left, bottom - host.top];
    });
    view.stage.draw();
  });
  for (const element of [view.stage.host, ...cards]) keepOut.observe(element);
  return h("div", { class: "overlay" }, cards, tip);
}

const forceScale = (mm_per_n: number): string => `force, ${trimmed(mm_per_n, 3)} mm per N`;
const times = (n: number): string => `× ${trimmed(n, 0)}`;

/** The colour bar, with ticks at the lines' levels and the tolerance marked; names with their colours. */
function legend(box: HTMLElement, live: Live): void {
  const { answer, setting } = live;
  // Where nothing is reached, nothing has a colour.
  box.hidden = answer === null || setting === null || !headline(answer, live.map).reached;
  if (box.hidden || !setting) return;
  const shown = shownLayer(live);
  const cases = setting.cases_n.length;
  const about = shown.key === FIRST && !shown.layer.diverging ? (cases > 1 ? `largest of ${cases} load cases` : "") : (shown.layer.about ?? "");
  const name = h("p", { class: "legend-name" }, h("b", {}, shown.layer.unit), about ? h("small", {}, ` ${about}`) : null);
  box.setAttribute("aria-label", legendText(shown, setting.tolerance_um));
  const bar = shown.layer.named ? namedBar(shown, live.section) : shown.scale ? scaleBar(shown, shown.scale, setting.tolerance_um) : h("p", { class: "legend-name" }, "not known for these points");
  renew(box, shown.layer.unit || about ? name : null, bar, marks(live));
}

/** The colours of the machined part; whether there are any. */
function partScale(box: HTMLElement, part: PartState): boolean {
  const scale = part.surface && scaleOf(part.surface);
  if (!scale) return false;
  const { title } = QUANTITIES.find(({ key }) => key === part.quantity)!;
  const [low, high] = ends(scale);
  box.setAttribute("aria-label", `${title}: colours from ${um(low)} to ${um(high)} micrometres`);
  renew(
    box,
    h("p", { class: "legend-name" }, h("b", {}, `${title}, ${LAYER.unit}`)),
    h("p", { class: "legend-name" }, h("small", {}, LAYER.about)),
    scaleBar({ layer: LAYER }, scale, Infinity),
    h("p", { class: "marks" }, h("span", {}, h("i", { class: "mark plain" }), part.quantity === "deviation_um" ? "not compared or not known" : "not measured")),
  );
  return true;
}

function legendText({ layer, scale, names }: ShownLayer, tolerance_um: number): string {
  if (layer.tolerance && scale) return `Colours from ${um(scale[0])} to ${um(scale.at(-1))} micrometres; tolerance ${um(tolerance_um)}`;
  if (layer.named) return `${layer.title}: ${names.join(", ")}`;
  return scale ? `${layer.title}: colours from ${textOf({ layer, names }, scale[0])} to ${textOf({ layer, names }, scale.at(-1))}` : `${layer.title}: not known`;
}

/** The names that occur in the map shown, or at the points. */
function namedBar({ names, values }: ShownLayer, index: number): HTMLElement {
  const there = new Set(values(index));
  return h("p", { class: "marks named" }, names.map((name, i) => (there.has(i) ? h("span", {}, h("i", { class: "mark", style: `background:${css(namedColour(i))}` }), name) : null)));
}

function scaleBar({ layer }: Pick<ShownLayer, "layer">, scale: Scale, tolerance: number): SVGElement {
  const W = 280;
  const [low, high] = ends(scale);
  const at = (value: number) => 14 + (W - 28) * along(scale, value);
  const stops = Array.from({ length: 21 }, (_, i) => s("stop", { offset: i / 20, "stop-color": css(colourOf({ layer, scale: [0, 1], names: [] }, i / 20)) }));
  const every = Math.ceil(scale.length / 6);
  // The zero of a difference has its tick.
  const middle = layer.diverging ? (scale.length - 1) / 2 : 0;
  const inside = tolerance >= low && tolerance <= high;
  const top = layer.tolerance ? 15 : 3;
  const height = layer.tolerance ? 46 : 34;
  return s(
    "svg",
    { width: W, height, viewBox: `0 0 ${W} ${height}`, "aria-hidden": "true" },
    s("defs", {}, s("linearGradient", { id: `bar-${layer.diverging ? "diverging" : "rising"}` }, stops)),
    s("rect", { x: 14, y: top, width: W - 28, height: 12, rx: 2, fill: `url(#bar-${layer.diverging ? "diverging" : "rising"})` }),
    scale.filter((_, i) => (i - middle) % every === 0).map((level) => [
      s("line", { x1: at(level), x2: at(level), y1: top + 12, y2: top + 16, class: "tick" }),
      s("text", { x: at(level), y: top + 28, "text-anchor": "middle" }, levelText(layer, level)),
    ]),
    !layer.tolerance
      ? null
      : inside
        ? [s("path", { d: `M${at(tolerance)} 29 V13 m-5 -7 h10 l-5 7 z`, class: "limit" }), s("text", { x: at(tolerance) > W - 90 ? at(tolerance) - 9 : at(tolerance) + 9, y: 10, class: "limit-text", "text-anchor": at(tolerance) > W - 90 ? "end" : "start" }, `tolerance ${trimmed(tolerance, 1)}`)]
        : [s("text", { x: tolerance < low ? 14 : W - 14, y: 10, class: "limit-text", "text-anchor": tolerance < low ? "start" : "end" }, tolerance < low ? `◀ tolerance ${trimmed(tolerance, 1)}, all above it` : `tolerance ${trimmed(tolerance, 1)}, all below it ▶`)],
  );
}

/** What is drawn in other ways than by a colour, where there is any. */
function marks(live: Live): HTMLElement | null {
  const { answer, map, scene } = live;
  const shown: [boolean, string, string][] = [
    [map !== null && outsideLimits(map.grid).length > 0, "hatched", "outside joint limits"],
    [map === null && answer!.paths.length > 0 && scene!.points!.any_outside, "dashed", "outside joint limits"],
    [lostHoles(answer!).length > 0, "crossed", "cannot be drilled"],
    [answer!.volumes.length > 0, "surface", "surface: tolerance"],
    [scene?.points?.any_in_collision ?? (map !== null && collisions(map) > 0), "collision", "in collision"],
    [scene?.points?.any_empty ?? (map !== null && map.grid.in_plane_um.filter((v) => v === null).length > collisions(map)), "empty", "no posture"],
  ];
  const list = shown.filter(([there]) => there);
  return list.length === 0 ? null : h("p", { class: "marks" }, list.map(([, kind, text]) => h("span", {}, h("i", { class: `mark ${kind}` }, kind === "crossed" ? "✕" : ""), text)));
}

const collisions = (map: MapAnswer): number => map.counts.in_collision;

/** What a body is, in words. */
const ROLES: Record<BodyRole, string> = { link: "Link of the robot", holder: "Tool: must not touch the part", cutter: "Cutter: may touch the part", obstacle: "Obstacle", part: "Part" };

function hover(tip: HTMLElement, live: Live, part: PartState, under: Under, x: number, y: number, host: HTMLElement): void {
  tip.hidden = under === null;
  if (under === null) return;
  if (under.kind === "body") fill(tip, h("b", {}, under.body.name), h("p", {}, ROLES[under.body.role]));
  else if (under.kind === "part") fill(tip, ...valuesOfPart(live, part, under.hit));
  else fill(tip, ...valuesAt(live, under));
  const box = host.getBoundingClientRect();
  const left = x - box.left + (x - box.left > box.width - 230 ? -225 : 16);
  const top = Math.min(y - box.top + 12, box.height - 170);
  tip.style.transform = `translate(${left}px, ${Math.max(4, top)}px)`;
}

/** The deviation of a place of the machined part, and the line that made it. */
function valuesOfPart({ path }: Live, { surface, quantity }: PartState, hit: Hit): HTMLElement[] {
  if (!surface) return [];
  const point = surface.points[nearest(surface, hit)]!;
  const rows: [string, string][] = [];
  const deviation = surface.column("deviation_um");
  if (deviation) {
    const value = valueAt(surface, deviation, hit);
    rows.push(["Deviation", Number.isNaN(value) ? "not known" : `${LAYER.text(value)} ${plusMinus(valueAt(surface, surface.column("u_um")!, hit))}`]);
    for (const { key, short } of QUANTITIES.slice(1)) {
      const values = surface.column(key);
      const value = values && key === quantity ? valueAt(surface, values, hit) : null;
      if (value !== null) rows.push([short, Number.isNaN(value) ? "between points" : `${LAYER.text(value)} µm`]);
    }
  }
  const line = path?.get("line")?.[point];
  rows.push(["Made by", point < 0 ? (surface.about.part?.nominal === "part" ? "not known" : "the stock: not cut") : line === undefined || Number.isNaN(line) ? `point ${point + 1}` : `line ${line}`]);
  const operations = path?.about.operations ?? [];
  const operation = point < 0 ? undefined : operations[lastFrom(operations, point)];
  if (operation?.name) rows.push(["Operation", operation.name]);
  return [h("b", {}, "Machined part"), h("dl", {}, rows.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])), ...(point < 0 ? [] : [h("p", {}, "Click: the robot goes there")])];
}

/** The values of a point. */
function valuesAt(live: Live, under: Exclude<NonNullable<Under>, { kind: "body" | "part" }>): HTMLElement[] {
  const rows: [string, string][] = [];
  if (under.kind === "map") {
    const grid = live.map!.grid;
    const i = under.index;
    const flags = grid.flags.filter((r) => r.points.includes(i)).map((r) => r.reason.replaceAll("_", " "));
    rows.push(["y′, z′", `${mm(under.y_mm)}, ${mm(under.z_mm)} mm`], ["In plane", `${um(grid.in_plane_um[i])} ${plusMinus(grid.in_plane_u_um[i])}`], ["Normal", `${um(grid.normal_um[i])} µm`], ["Full", `${um(grid.full_um[i])} µm`], ["Within the tolerance", grid.probability_within[i] === null ? "probability not known" : `probability ${percent(grid.probability_within[i])}`]);
    for (const flag of flags) rows.push(["", flag]);
  } else {
    const points = live.scene!.points!;
    const i = under.index;
    rows.push(["Point", String(i + 1)], ["x, y, z", `${points.at(i).map((v) => fixed(v, 1)).join(", ")} mm`]);
    if (points.in_collision[i] === 1) rows.push(["", "in collision"]);
    for (const [name, key] of SHOWN) {
      const list = points.column(key);
      if (list) rows.push([name, `${um(list[i])} µm`]);
    }
  }
  const chosen = shownLayer(live);
  // Deviations are in every tooltip.
  if (chosen.layer.diverging || !["in_plane_um", "normal_um", "full_um"].includes(chosen.key)) rows.push([chosen.layer.title, textOf(chosen, chosen.values(live.section)[under.index])]);
  return [h("dl", {}, rows.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)])), h("p", {}, "Click: the robot goes there")];
}
