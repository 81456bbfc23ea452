// Joint positions with their limits, of the controller (robot file) or of the kinematic chain.

import { h } from "../dom";
import { fixed } from "../format";
import type { Live } from "../live";
import { panel } from "./panel";

export function joints(live: Live): HTMLElement {
  const { root, show } = panel("joints", "Joint positions");
  let by_chain = false;
  const draw = () => {
    const pose = live.pose;
    const posture = pose?.answer.postures[live.posture];
    if (!pose || !posture) return show(h("p", { class: "note" }, "Joint angles and limits appear here."));
    const chain = pose.chain[live.posture] ?? [];
    const positions = posture.joints_deg.map((q, i) => (by_chain ? { at: chain[i]!.at_deg, low: chain[i]!.lower_deg, high: chain[i]!.upper_deg } : { at: q, low: pose.limits[i]?.lower_deg ?? null, high: pose.limits[i]?.upper_deg ?? null }));
    const way = (chosen: boolean, name: string, about: string) =>
      h("button", { type: "button", "aria-pressed": String(by_chain === chosen), "data-key": name, title: about, onclick: () => ((by_chain = chosen), draw()) }, name);
    show(
      h("div", { class: "switch", role: "group", "aria-label": "Joint convention" }, way(false, "Controller", "Signs and zeros of the robot controller, as in the robot file"), way(true, "Chain", "Right-hand rule about the axes of the chain, zero where it is straight")),
      h(
        "ul",
        { class: "bars joints", "aria-label": "Joint positions within their limits" },
        positions.map(({ at: q, low, high }, i) => {
          const at = low !== null && high !== null && high > low ? (100 * (q - low)) / (high - low) : null;
          const out = at !== null && (at < 0 || at > 100);
          const near = at !== null && !out && Math.min(q - low!, high! - q) < 10;
          return h(
            "li",
            { class: out ? "out" : near ? "near" : "" },
            h("span", { class: "bar-name" }, pose.answer.joint_names[i] ?? String(i + 1)),
            h(
              "span",
              { class: "limit-track", title: low === null ? "no limits given" : `${fixed(low, 0)} to ${fixed(high, 0)} ${unit(pose.answer.joint_units[i])}` },
              h("small", {}, low === null ? "" : fixed(low, 0)),
              h("span", { class: "track" }, at === null ? null : h("i", { class: "dot", style: `left:${Math.min(100, Math.max(0, at))}%` })),
              h("small", {}, high === null ? "" : fixed(high, 0)),
            ),
            h("span", { class: "bar-value wide" }, fixed(q, 1), unit(pose.answer.joint_units[i])),
          );
        }),
      ),
      posture.within_limits
        ? posture.limit_margin_deg !== null
          ? h("p", { class: "note" }, `Nearest to a limit: ${posture.limit_joint ?? "a joint"}, ${fixed(posture.limit_margin_deg, 1)}° away.`)
          : null
        : h("p", { class: "note warn" }, `${posture.limit_joint ?? "A joint"} is outside its limits${posture.limit_margin_deg === null ? "" : ` by ${fixed(Math.abs(posture.limit_margin_deg), 1)}°`}.`),
    );
  };
  live.listen(["pose"], draw);
  draw();
  return root;
}

const unit = (name: string | undefined): string => (name === "deg" || name === undefined ? "°" : ` ${name}`);
