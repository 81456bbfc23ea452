// The load cases at the position of the robot. The worst is shown, unless another is chosen.

import { h } from "../dom";
import { newton, um } from "../format";
import type { Live } from "../live";
import { worstCase } from "../posture";
import { panel } from "./panel";

export function cases(live: Live): HTMLElement {
  const { root, show } = panel("cases", "Load cases");
  const draw = () => {
    const values = live.pose?.in_plane[live.posture];
    if (!values) return show(h("p", { class: "note" }, "The load cases at the position of the robot are listed here."));
    const decides = worstCase(values);
    show(
      h(
        "table",
        { class: "numbers choose" },
        h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Force x, y, z / N"), ...["In plane", "Normal", "Full"].map((t) => h("th", { scope: "col" }, t, h("small", {}, " µm"))))),
        h(
          "tbody",
          {},
          values.map((v, i) =>
            h(
              "tr",
              { class: live.load_case === i + 1 ? "chosen" : "" },
              h(
                "th",
                { scope: "row" },
                h(
                  "button",
                  { type: "button", class: "row-button", "data-key": `case ${i}`, "aria-pressed": String(live.load_case === i + 1), title: "Show this load case", onclick: () => live.chooseCase(i + 1) },
                  v ? v.force_n.map(newton).join(", ") : `Case ${i + 1}`,
                ),
              ),
              h("td", { class: decides === i + 1 ? "strong" : "" }, um(v?.in_plane_um)),
              h("td", {}, um(v?.normal_um)),
              h("td", {}, um(v?.full_um)),
            ),
          ),
        ),
      ),
      h("p", { class: "note" }, `Case ${decides ?? 1} is the worst here. `, live.case_is_fixed ? h("button", { type: "button", class: "link", onclick: () => live.chooseCase(null) }, "Show the worst case") : null),
    );
  };
  live.listen(["pose"], draw);
  draw();
  return root;
}
