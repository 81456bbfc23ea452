// The live view: settings on the left, the verdict and the scene in the middle, values at the point on the right.

import { controls } from "../controls/controls";
import { h } from "../dom";
import type { JobStore } from "../jobs/store";
import type { Live } from "../live";
import { PartState } from "../machined-part/state";
import { advice } from "../panels/advice";
import { branches } from "../panels/branches";
import { cases } from "../panels/cases";
import { joints } from "../panels/joints";
import { lobes } from "../panels/lobes";
import { machinedPart } from "../panels/machined-part";
import { matrix } from "../panels/matrix";
import { notes } from "../panels/notes";
import { point } from "../panels/point";
import { target } from "../panels/target";
import { shares } from "../panels/shares";
import { verdict } from "../panels/verdict";
import { overlay } from "../scene/overlay";
import { SceneView } from "../scene/view";
import { spinMap } from "../spin-map/panel";
import { Timeline } from "../timeline/timeline";
import type { Vec3 } from "../types";
import type { Tab } from "./tab";

export function liveTab(live: Live, jobs: JobStore): Tab & { view: SceneView } {
  const part = new PartState(live);
  const host = h("div", { class: "stage", tabindex: "0", role: "group", "aria-label": "The robot, the plate with its deviations, and the tool. Keys 1 to 5: views. All numbers are in the panels." });
  const machined = machinedPart(live, part);
  const right = h("aside", { class: "right", "aria-label": "At the tool" }, point(live), target(live), machined.root, shares(live), branches(live), cases(live), joints(live), lobes(live), matrix(live), notes(live));
  let waits: ReturnType<typeof setTimeout> | undefined;
  live.listen(["moving"], () => {
    right.setAttribute("aria-busy", String(live.moving));
    // Only long waits are shown: each change of style costs a frame.
    clearTimeout(waits);
    if (live.moving) waits = setTimeout(() => right.classList.add("waits"), 250);
    else right.classList.remove("waits");
  });
  const view = new SceneView(host, live, part);
  machined.look = (place) => view.lookAtPart(...view.ofPart(place.xyz_mm as Vec3, place.normal_axis as Vec3));
  const root = h(
    "div",
    { class: "live" },
    h("aside", { class: "left", "aria-label": "Settings" }, controls(live)),
    h("div", { class: "middle" }, verdict(live, () => view.fit()), advice(live, jobs), host, h("div", { class: "under" }, new Timeline(live, (point) => part.along(point)).root, spinMap(live))),
    right,
  );
  host.append(overlay(view, live, part));
  return { id: "live", title: "Live", root, view, shown: () => view.redraw() };
}
