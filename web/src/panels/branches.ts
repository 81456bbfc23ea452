// All branches: the deviation of each posture at this point. A click shows one; "use" selects it for the map.

import { h } from "../dom";
import { um } from "../format";
import type { Live } from "../live";
import { envelope, fits } from "../posture";
import { panel } from "./panel";

export function branches(live: Live): HTMLElement {
  const { root, show } = panel("branches", "Branches here");
  const draw = () => {
    const pose = live.pose;
    if (!pose || pose.answer.postures.length === 0) return show(h("p", { class: "note" }, live.pose_error ?? "All postures at the point are listed here."));
    const tolerance = live.setting?.tolerance_um ?? 0;
    const worst = pose.in_plane.map((c) => envelope(c)?.in_plane_um ?? null);
    const top = Math.max(tolerance * 1.15, ...worst.map((w) => w ?? 0));
    const order = pose.answer.postures.map((_, i) => i).sort((a, b) => (worst[a] ?? 1e9) - (worst[b] ?? 1e9));
    show(
      h(
        "ul",
        { class: "branches" },
        order.map((i) => {
          const posture = pose.answer.postures[i]!;
          const name = posture.branch ?? `posture ${i + 1}`;
          const value = worst[i] ?? 0;
          const used = live.values?.branch_meant !== "best" && fits(posture.branch, live.values?.branch_meant ?? "?");
          return h(
            "li",
            { class: i === live.posture ? "chosen" : "" },
            h(
              "button",
              { type: "button", class: "branch", "data-key": `show ${name}`, "aria-pressed": String(i === live.posture), title: "Show this posture", onclick: () => live.choosePosture(i) },
              h("span", { class: "branch-name" }, name, posture.within_limits ? null : h("em", { title: "outside its joint limits" }, ` · ${posture.limit_joint ?? "a joint"} beyond tolerance`)),
              h("span", { class: "branch-track", "aria-hidden": "true" }, h("i", { class: value <= tolerance ? "bar good" : "bar", style: `width:${(100 * value) / top}%` }), h("i", { class: "limit-mark", style: `left:${(100 * tolerance) / top}%` })),
              h("span", { class: "branch-value" }, um(worst[i]), h("small", {}, " µm")),
            ),
            used
              ? h("span", { class: "used", title: "The map uses this branch" }, "in use")
              : h("button", { type: "button", class: "use", "data-key": `use ${name}`, "aria-label": `Use ${name} for the map`, disabled: posture.branch === null, onclick: () => live.change("posture.branch", posture.branch) }, "use"),
          );
        }),
      ),
      h("p", { class: "note" }, "In-plane deviation, largest of all load cases; the mark is the tolerance."),
    );
  };
  live.listen(["answer", "pose"], draw);
  draw();
  return root;
}
