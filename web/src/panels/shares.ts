// Share of each joint in the in-plane deviation of the load case shown.

import { h } from "../dom";
import { percent, um } from "../format";
import type { Live } from "../live";
import { sharesOf } from "../shares";
import { panel } from "./panel";

export function shares(live: Live): HTMLElement {
  const { root, show } = panel("shares", "Share of each joint");
  const draw = () => {
    const values = live.pose?.in_plane[live.posture]?.[live.load_case - 1];
    const names = live.pose?.answer.contributors ?? [];
    const parts = sharesOf(live);
    if (!values || !parts) return show(h("p", { class: "note" }, values ? "The shares of this posture are not known." : "The shares of the joints are listed here."));
    const largest = Math.max(...parts.map(Math.abs), 1e-9);
    const order = parts.map((_, i) => i);
    const loudest = parts.indexOf(Math.max(...parts));
    show(
      h(
        "ul",
        { class: "bars", "aria-label": "Share of each joint in the in-plane deviation" },
        order.map((i) => {
          const part = parts[i]!;
          const wide = (50 * Math.abs(part)) / largest;
          const signed = parts.some((p) => p < -0.02 * largest);
          const left = signed ? (part < 0 ? 50 - wide : 50) : 0;
          return h(
            "li",
            {},
            h("span", { class: "bar-name" }, names[i] ?? String(i + 1)),
            h("span", { class: "bar-track" }, signed ? h("i", { class: "bar-zero" }) : null, h("i", { class: `bar ${i === loudest ? "loud" : ""}`, style: `left:${left}%;width:${Math.max(0.4, signed ? wide : 2 * wide)}%` })),
            h("span", { class: "bar-value" }, um(part)),
            h("span", { class: "bar-share" }, percent(part / values.in_plane_um)),
          );
        }),
      ),
      h("p", { class: "note" }, "µm and share of the in-plane deviation; negative shares reduce it."),
    );
  };
  live.listen(["pose"], draw);
  draw();
  return root;
}
