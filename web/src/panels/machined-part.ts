// The machined part: how far its surface is from the nominal one, its worst places with their causes, its features, and how it is drawn.

import { h, renew } from "../dom";
import { fixed, percent, plusMinus, trimmed, um } from "../format";
import type { Live } from "../live";
import type { PartState } from "../machined-part/state";
import { QUANTITIES, type Quantity } from "../machined-part/surface";
import type { MachinedPart } from "../types";
import { panel } from "./panel";

type WorstPlace = MachinedPart["worst_places"][number];

/** Features that are listed at most. */
const MOST_FEATURES = 12;
/** The deviation is drawn larger by this at most. */
const MOST = 100;

/** A deviation with its sign. */
export const signed = (value: number | null | undefined): string => `${typeof value === "number" && value > 0 ? "+" : ""}${um(value)}`;

/** `look`: looks at a place of the part. */
export function machinedPart(live: Live, part: PartState): { root: HTMLElement; look: (place: WorstPlace) => void } {
  const { root, body } = panel("machined", "Machined part");
  const own = { root, look: (_: WorstPlace) => {} };
  const numbers = h("div", { class: "machined-numbers" });
  const output = h("output", { for: "machined-magnified" });
  const slider = h("input", { id: "machined-magnified", type: "range", min: 0, max: MOST, step: 1, value: 0, "aria-label": "Deviation of the surface drawn larger by" });
  slider.addEventListener("input", () => {
    part.magnified = Number(slider.value);
    live.notify("part");
  });
  const quantity = h("select", { id: "machined-quantity", "aria-label": "Colours of the part show" });
  quantity.addEventListener("change", () => {
    part.quantity = quantity.value as Quantity;
    live.notify("part");
  });
  const ways = h("div", { class: "switch", role: "group", "aria-label": "Material" });
  const scale = h("div", { class: "field machined-scale" }, h("label", { for: "machined-magnified" }, "Surface"), output, slider);
  const status = h("p", { class: "note", role: "status" });
  body.append(status, numbers);
  const controls = h("div", { class: "machined-controls" }, ways, quantity, scale);
  const list = h("div", { class: "machined-list" });
  body.append(controls, list);

  const draw = () => {
    root.hidden = !part.there;
    if (root.hidden) return;
    const { answer } = part;
    status.textContent = part.error ?? (part.busy && (answer === null || part.stale) ? "The part is being cut …" : !part.visible ? "Not shown: choose “Machined part” under Show." : "");
    status.classList.toggle("warn", part.error !== null);
    status.hidden = status.textContent === "";
    root.setAttribute("aria-busy", String(part.busy));
    root.classList.toggle("stale", part.stale && answer !== null);
    controls.hidden = list.hidden = numbers.hidden = answer === null;
    if (!answer) return;
    const way = (in_process: boolean, text: string, about: string) => h("button", { type: "button", "data-key": text, "aria-pressed": String(part.in_process === in_process), title: about, onclick: () => part.choose(in_process) }, text);
    renew(ways, way(false, "Finished", "The finished part, in the colours of its deviation"), way(true, "At the point", "The material as it is when the tool is at the point of the robot; play and the charts choose it"));
    const known = part.finished?.quantities ?? [];
    quantity.hidden = known.length < 2;
    const options = QUANTITIES.filter(({ key }) => known.some((of) => of.key === key));
    if (quantity.options.length !== options.length) quantity.replaceChildren(...options.map(({ key, text }) => h("option", { value: key }, text)));
    quantity.value = part.quantity;
    quantity.disabled = slider.disabled = part.in_process;
    slider.value = String(part.magnified);
    output.textContent = part.magnified === 0 ? "nominal" : `deviation × ${part.magnified}`;
    slider.setAttribute("aria-valuetext", output.textContent);
    const tolerance = answerTolerance(live);
    renew(numbers, h("div", { class: "three" }, figure("Material left", signed(answer.most_left_um), "µm", over(answer.most_left_um, tolerance)), figure("Gouged", signed(answer.most_gouged_um), "µm", over(answer.most_gouged_um, tolerance)), figure("Within", percent(answer.fraction_within), "of the area", "")));
    renew(list, ...places(answer, tolerance, own, part), features(answer), about(answer));
  };
  live.listen(["part", "answer", "view"], draw);
  draw();
  return own;
}

const answerTolerance = (live: Live): number => live.setting?.tolerance_um ?? Infinity;
const over = (value: number | null, tolerance: number): string => (value === null ? "" : Math.abs(value) > tolerance ? "over" : "within");

function figure(name: string, value: string, unit: string, kind: string): HTMLElement {
  return h("div", { class: `figure ${kind}` }, h("span", { class: "figure-name" }, name), h("span", { class: "figure-value" }, value), h("span", { class: "figure-unit" }, unit));
}

function places(answer: MachinedPart, tolerance: number, own: { look: (place: WorstPlace) => void }, part: PartState): (HTMLElement | null)[] {
  if (answer.worst_places.length === 0) return [h("p", { class: "note" }, "No surface of the part is compared.")];
  const rows = answer.worst_places.map((place, i) =>
    h(
      "li",
      {},
      h(
        "button",
        {
          type: "button",
          "data-key": `place ${i}`,
          title: `Look at place ${i + 1}: ${place.xyz_mm.map((v) => trimmed(v, 1)).join(", ")} mm`,
          onclick: () => {
            part.choose(false);
            own.look(place);
          },
        },
        h("span", { class: "place-number" }, i + 1),
        h("span", { class: Math.abs(place.deviation_um) > tolerance ? "place-value over" : "place-value" }, `${signed(place.deviation_um)} ${plusMinus(place.u_um)}`),
        h("span", { class: "place-line" }, place.line === null ? "stock" : `line ${place.line}`),
        h("span", { class: "place-cause" }, place.cause),
      ),
    ),
  );
  return [h("h3", {}, "Worst places"), h("ol", { class: "worst-places" }, rows)];
}

function features({ features: all }: MachinedPart): HTMLElement | null {
  if (all.length === 0) return null;
  const row = (feature: MachinedPart["features"][number]) =>
    h("tr", {}, h("th", { scope: "row" }, feature.name), feature.missing === null ? [h("td", {}, signed(feature.mean_um)), h("td", {}, um(feature.profile_um)), h("td", {}, um(feature.position_um ?? feature.flatness_um))] : h("td", { colspan: 3 }, feature.missing));
  return h(
    "table",
    { class: "numbers machined-features" },
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Feature"), ...["Mean", "Profile", "Position or flatness"].map((text) => h("th", { scope: "col" }, text, h("small", {}, " µm"))))),
    h("tbody", {}, all.slice(0, MOST_FEATURES).map(row), all.length > MOST_FEATURES ? h("tr", {}, h("td", { colspan: 4 }, `and ${all.length - MOST_FEATURES} more in the report`)) : null),
  );
}

function about(answer: MachinedPart): HTMLElement {
  const relative = answer.nominal === "part" ? "Relative to the mesh of the part" : "Relative to the part as programmed";
  return h("p", { class: "note" }, `${relative}, normal to its surface; + material left, − gouged. Cells of ${trimmed(answer.cell_mm, 3)} mm, ${fixed(answer.area_mm2 / 100, 1)} cm² compared.`);
}
