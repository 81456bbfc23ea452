// All branches: the deviation of each posture at this point, possible ones first. A click shows one; "use" selects it for
// the analysis.

import { h } from "../dom";
import { um } from "../format";
import type { Live } from "../live";
import { envelope, tooNear } from "../posture";
import { panel } from "./panel";

export function branches(live: Live): HTMLElement {
  const { root, show } = panel("branches", "Branches here");
  const draw = () => {
    const pose = live.pose;
    if (!pose || pose.answer.postures.length === 0) return show(h("p", { class: "note" }, live.pose_error ?? "All postures at the point are listed here."));
    const tolerance = live.setting?.tolerance_um ?? 0;
    const worst = pose.in_plane.map((c) => envelope(c)?.in_plane_um ?? null);
    const top = Math.max(tolerance * 1.15, ...worst.map((w) => w ?? 0));
    // Possible postures first, the one with the smallest deviation first.
    const key = (i: number) => (pose.answer.postures[i]!.within_limits ? 0 : 1e9) + (tooNear(pose, i) ? 1e9 : 0) + (worst[i] ?? 1e8);
    const order = pose.answer.postures.map((_, i) => i).sort((a, b) => key(a) - key(b));
    show(
      h(
        "ul",
        { class: "branches" },
        order.map((i) => {
          const posture = pose.answer.postures[i]!;
          const name = posture.branch ?? `posture ${i + 1}`;
          const value = worst[i] ?? 0;
          const why = [posture.within_limits ? null : `${posture.limit_joint ?? "a joint"} outside its limits`, tooNear(pose, i)].filter((each) => each !== null);
          const possible = why.length === 0;
          const within = possible && value <= tolerance;
          return h(
            "li",
            { class: `${i === live.posture ? "chosen" : ""} ${possible ? "" : "impossible"}` },
            h(
              "button",
              { type: "button", class: "branch", "data-key": `show ${name}`, "aria-pressed": String(i === live.posture), title: "Show this posture", onclick: () => live.choosePosture(i) },
              h("span", { class: "branch-name" }, name, why.map((each) => h("em", {}, ` · ${each}`))),
              h("span", { class: "branch-track", "aria-hidden": "true" }, h("i", { class: `bar ${within ? "good" : possible ? "above" : "out"}`, style: `width:${(100 * value) / top}%` }), h("i", { class: "limit-mark", style: `left:${(100 * tolerance) / top}%` })),
              h("span", { class: "branch-value" }, um(worst[i]), h("small", {}, " µm")),
            ),
            i === pose.answered
              ? h("span", { class: possible ? "used" : "used out", title: "The analysis uses this posture here" }, "in use")
              : h("button", { type: "button", class: "use", "data-key": `use ${name}`, "aria-label": `Use ${name} for the analysis`, disabled: posture.branch === null, onclick: () => live.change("posture.branch", posture.branch) }, "use"),
          );
        }),
      ),
      h("p", { class: "note branch-key" }, h("i", { class: "key good" }), "within the tolerance", h("i", { class: "key above" }), "above it", h("i", { class: "key out" }), pose.drawings.some((drawing) => drawing.cell) ? "outside joint limits or too near" : "outside joint limits"),
      h("p", { class: "note" }, "In-plane deviation, largest of all load cases; the mark is the tolerance."),
      pose.answered !== null && pose.answered !== live.posture
        ? h("p", { class: "note warn" }, "This is not the posture of the answer. ", h("button", { type: "button", class: "link", "data-key": "answered", onclick: () => live.choosePosture(pose.answered!) }, "Show the posture of the answer"))
        : null,
    );
  };
  live.listen(["answer", "pose"], draw);
  draw();
  return root;
}
