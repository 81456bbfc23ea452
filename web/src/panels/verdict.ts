// The verdict: fraction within tolerance, extreme deviations, joint with the largest share.

import { h, renew, type Child } from "../dom";
import { DASH, percent, plusMinus, trimmed, um } from "../format";
import type { Live } from "../live";
import type { Point } from "../types";

export function verdict(live: Live): HTMLElement {
  const root = h("section", { class: "verdict", "aria-label": "Verdict", "aria-live": "polite" });
  const draw = () => {
    const { answer, setting } = live;
    if (!answer || !setting) return renew(root, h("div", { class: "verdict-main" }, h("p", { class: "verdict-line" }, "…")));
    const tolerance = `${trimmed(setting.tolerance_um, 1)}\u00a0µm`;
    const { share, what, extra } = fractionWithin(live);
    const state = share >= 1 ? "good" : share > 0 ? "part" : "none";
    renew(
      root,
      h(
        "div",
        { class: "verdict-main" },
        h("p", { class: `verdict-line ${state}` }, h("span", { class: "verdict-mark", "aria-hidden": "true" }, state === "good" ? "✓" : state === "part" ? "◐" : "✕"), sentence(share, what, tolerance)),
        h("div", { class: "meter", role: "img", "aria-label": `${percent(share)} within tolerance` }, h("span", { style: `width:${(100 * share).toFixed(2)}%` })),
      ),
      h("div", { class: "verdict-points" }, extreme(live, "worst", live.worst), extreme(live, "best", live.best), blame(live)),
      h("p", { class: "verdict-extra" }, extra || "\u00a0"),
    );
  };
  live.listen(["answer", "pose"], draw);
  draw();
  return root;
}

function fractionWithin(live: Live): { share: number; what: string; extra: Child } {
  const map = live.map;
  if (map) {
    const robust = map.certainty ? `robustly ${percent(map.certainty.fraction_robustly_within)}, possibly ${percent(map.certainty.fraction_possibly_within)}` : null;
    const unreachable = map.grid.points - (map.counts.within ?? 0) - (map.counts.above_tolerance ?? 0);
    const parts = [
      robust,
      map.outside_joint_limits > 0 ? `${map.outside_joint_limits} of ${map.grid.points} points outside joint limits` : null,
      unreachable > 0 ? `${unreachable} points without posture` : null,
    ].filter(Boolean);
    return { share: map.fraction_within, what: "plate", extra: parts.join(" · ") };
  }
  const path = live.answer!.paths[0];
  if (path) {
    const parts = [`${path.points} points`, path.unreachable > 0 ? `${path.unreachable} unreachable` : null, path.outside_joint_limits > 0 ? `${path.outside_joint_limits} outside joint limits` : null, path.roundness_um !== null ? `roundness ${um(path.roundness_um)} µm` : null];
    return { share: path.fraction_within, what: "path", extra: parts.filter(Boolean).join(" · ") };
  }
  const volume = live.answer!.volumes[0];
  if (volume) return { share: volume.fraction_within, what: "box", extra: `${(volume.volume_within_mm3 / 1e6).toFixed(1)} litres (dm³) of it` };
  const holes = live.answer!.holes[0];
  return { share: holes?.fraction_within ?? 0, what: "holes", extra: holes ? `${holes.holes} holes, ${holes.unreachable} unreachable` : null };
}

function sentence(share: number, what: string, tolerance: string): string {
  if (share <= 0) return what === "holes" ? `No hole is within ${tolerance}` : `No point of the ${what} is within ${tolerance}`;
  if (share >= 1) return what === "holes" ? `All holes are within ${tolerance}` : `The whole ${what} is within ${tolerance}`;
  return `${percent(share)} of the ${what} ${what === "holes" ? "are" : "is"} within ${tolerance}`;
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
