// The verdict: fraction within tolerance inside joint limits, extreme deviations, joint with the largest share, number of
// warnings; where nothing is reached, the nearest placement that is.

import { significant } from "../changes/pin";
import { h, renew, type Child } from "../dom";
import { DASH, mm, percent, plusMinus, um } from "../format";
import { headline } from "../headline";
import type { Live } from "../live";
import { Newest } from "../newest";
import { api } from "../server";
import type { Point, Reachable } from "../types";
import { warningsBadge } from "./warnings";

/** `fit`: moves the camera so that all is seen. */
export function verdict(live: Live, fit: () => void): HTMLElement {
  const line = h("p", { class: "verdict-line" }, "…");
  const meter = h("div", { class: "meter", role: "img" }, h("span"));
  const points = h("div", { class: "verdict-points" });
  const extra = h("p", { class: "verdict-extra" });
  const main = h("div", { class: "verdict-main" }, meter, warningsBadge(live));
  const root = h("section", { class: "verdict", "aria-label": "Verdict", "aria-live": "polite" }, line, main, points, extra);
  const reach = new NearestPlace(live, fit, () => draw());
  const draw = () => {
    const { answer, setting, map } = live;
    if (!answer || !setting) return;
    const { share, state, line: text, extra: facts, reached } = headline(answer, map);
    line.className = `verdict-line ${state}`;
    renew(line, h("span", { class: "verdict-mark", "aria-hidden": "true" }, state === "good" ? "✓" : state === "part" ? "◐" : "✕"), text, changed(live));
    meter.setAttribute("aria-label", `${percent(share)} within tolerance`);
    renew(meter, h("span", { style: `width:${(100 * share).toFixed(2)}%` }));
    if (reached) renew(points, extreme(live, "worst", live.worst), extreme(live, "best", live.best), blame(live));
    else renew(points, reach.shown());
    const more = facts.join(" · ");
    if (extra.textContent !== more) extra.textContent = extra.title = more;
  };
  live.listen(["answer"], () => reach.ask());
  live.listen(["answer", "pose", "view"], draw);
  draw();
  return root;
}

/** The worst deviation compared with that of the pinned state. */
function changed({ compared, worst }: Live): Child {
  const change = compared && significant({ worst_um: worst?.in_plane_um ?? null, worst_u_um: worst?.in_plane_u_um ?? null }, compared);
  if (!change) return null;
  const known = worst?.in_plane_u_um != null && compared.worst_u_um !== null;
  const about = `Worst in-plane deviation${known ? "" : "; its uncertainty is not known"}`;
  return [" ", h("span", { class: "verdict-change", title: about }, `· ${change}`)];
}

/** Where nothing is reached: the nearest placement that is, from the server, and a button that moves the part there. */
class NearestPlace {
  private found: Reachable | null = null;
  private searching = false;
  private moved = false;
  private readonly search = new Newest<string, Reachable>({
    work: (text, signal) => api.reachable(text, this.live.analysis, signal),
    done: (found) => {
      this.found = found;
      this.changed();
    },
    failed: () => {
      this.found = null;
      this.changed();
    },
    busy: (busy) => {
      this.searching = busy;
    },
  });

  constructor(private readonly live: Live, private readonly fit: () => void, private readonly changed: () => void) {}

  ask(): void {
    const { answer, map } = this.live;
    this.found = null;
    this.search.cancel();
    if (!answer) return;
    if (!headline(answer, map).reached) this.search.submit(this.live.text);
    else if (this.moved) this.fit();
    this.moved = false;
  }

  shown(): Child {
    const { found, live } = this;
    const centre = found?.centre_mm;
    const fit = h("button", { type: "button", class: "quiet small", "data-key": "fit", onclick: () => this.fit() }, "Fit view");
    if (!found) return h("div", { class: "nearest" }, h("p", {}, this.searching ? "Searching the nearest reachable position …" : "No reachable position is known."), fit);
    if (!centre) return h("div", { class: "nearest" }, h("p", {}, "No reachable position was found with this tilt and posture."), fit);
    const go = () => {
      this.moved = true;
      live.change(found.key, centre);
    };
    return h(
      "div",
      { class: "nearest" },
      h("p", {}, "Nearest reachable position: ", h("b", {}, `x ${mm(centre[0])}, y ${mm(centre[1])}, z ${mm(centre[2])} mm`), h("small", {}, ` ${mm(found.distance_mm)} mm away`)),
      h("button", { type: "button", class: "primary small", "data-key": "go", onclick: go }, "Move the part there"),
      fit,
    );
  }
}

function extreme(live: Live, which: "worst" | "best", point: Point | null): Child {
  if (!point) return null;
  return h(
    "button",
    { type: "button", class: "extreme", "data-follow": which, "data-key": which, "aria-pressed": String(live.follow === which), title: `Send the robot to the ${which} point`, onclick: () => live.followPoint(which) },
    h("span", { class: "extreme-name" }, which === "worst" ? "Worst" : "Best"),
    h("span", { class: "extreme-value" }, um(point.in_plane_um), h("small", {}, ` ${plusMinus(point.in_plane_u_um)}`)),
  );
}

function blame(live: Live): Child {
  const point = live.worst;
  const names = live.setting?.contributors ?? [];
  if (!point || point.in_plane_um <= 0) return null;
  const most = point.joint_share_um.reduce((best, v, i, all) => (v > all[best]! ? i : best), 0);
  return h(
    "div",
    { class: "extreme still" },
    h("span", { class: "extreme-name" }, "Largest share (worst point)"),
    h("span", { class: "extreme-value" }, names[most] ?? DASH, h("small", {}, ` ${percent(point.joint_share_um[most]! / point.in_plane_um)}`)),
  );
}
