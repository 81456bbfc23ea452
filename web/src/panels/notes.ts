// Limitations of the answer: the result in a sentence, warnings, the model, the sources of values.

import { h } from "../dom";
import { percent } from "../format";
import type { Live } from "../live";
import { panel } from "./panel";
import { warningsOf } from "./warnings";

export function notes(live: Live): HTMLElement {
  const trust = panel("trust", "Limitations");
  const sources = panel("sources", "Sources", false);
  const draw = () => {
    const { answer, setting, map } = live;
    if (!answer || !setting) return;
    const warnings = warningsOf(answer);
    trust.show(
      h("p", {}, answer.answer),
      map?.certainty ? h("p", { class: "note" }, `At 2 standard uncertainties: ${percent(map.certainty.fraction_robustly_within)} of the plate is robustly within tolerance, ${percent(map.certainty.fraction_possibly_within)} possibly.`) : null,
      warnings.length > 0 ? h("ul", { class: "warnings" }, warnings.map((w) => h("li", {}, w))) : null,
      h("p", { class: "note" }, `Model: ${setting.model.join(", ")}. Positions relative to ${setting.base}, tool ${setting.tool_length_mm} mm from the flange.${setting.load_source ? ` Load: ${setting.load_source}.` : ""}`),
    );
    sources.show(h("ul", { class: "sources" }, answer.sources.map((s) => h("li", {}, h("b", {}, s.key), ` ${s.what}. `, h("span", { class: "where" }, s.where)))));
  };
  live.listen(["answer"], draw);
  draw();
  return h("div", {}, trust.root, sources.root);
}
