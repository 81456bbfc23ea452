// The number of warnings at the verdict; a click shows them in place.

import { h, renew } from "../dom";
import type { Live } from "../live";
import type { Answer } from "../types";

/** All warnings of an answer, the most important first. */
export function warningsOf(answer: Answer): string[] {
  const assumed = answer.robot.compliance_assumed ? ["The joint compliances of this robot are assumed, not measured."] : [];
  return [...assumed, ...answer.warnings];
}

export function warningsBadge(live: Live): HTMLElement {
  const list = h("div", { class: "warning-list card", popover: "auto", id: "warning-list", role: "region", "aria-label": "Warnings" });
  const button = h("button", { type: "button", class: "badge", hidden: true, popovertarget: "warning-list" });
  // Below the button, as far as there is room.
  list.addEventListener("toggle", () => {
    const { left, bottom } = button.getBoundingClientRect();
    list.style.left = `${Math.max(8, Math.min(left, innerWidth - list.offsetWidth - 8))}px`;
    list.style.top = `${Math.max(8, Math.min(bottom + 5, innerHeight - list.offsetHeight - 8))}px`;
  });
  live.listen(["answer"], () => {
    const warnings = live.answer ? warningsOf(live.answer) : [];
    button.hidden = warnings.length === 0;
    const text = `⚠ ${warnings.length === 1 ? "1 warning" : `${warnings.length} warnings`}`;
    if (button.textContent !== text) button.textContent = text;
    renew(list, h("ul", { class: "warnings" }, warnings.map((w) => h("li", {}, w))));
  });
  return h("span", { class: "badge-place" }, button, list);
}
