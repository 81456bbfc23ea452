// A pinned state: the present answer is compared with it in one line below the header.

import { h, renew, s, type Child } from "../dom";
import { percent, um } from "../format";
import type { Live } from "../live";
import type { Analysis } from "../types";

/** What is compared of an answer. */
export interface Pinned {
  text: string;
  analyses: Analysis[];
  analysis: string | null;
  worst_um: number | null;
  within: number | null;
}

/** "41 % less than pinned"; null if there is nothing to compare. */
export function difference(now_um: number | null, pinned_um: number | null): string | null {
  if (now_um === null || pinned_um === null || pinned_um <= 0) return null;
  const share = now_um / pinned_um - 1;
  if (Math.abs(share) < 0.005) return "the same as pinned";
  return `${percent(Math.abs(share))} ${share < 0 ? "less" : "more"} than pinned`;
}

export class Pin {
  readonly root = h("div", { class: "pin", role: "status", "aria-label": "Comparison with the pinned state", hidden: true });
  readonly button = h("button", { type: "button", class: "icon", "aria-label": "Pin this state for comparison", title: "Pin this state for comparison", "aria-pressed": "false", disabled: true, onclick: () => this.toggle() }, s("svg", { viewBox: "0 0 16 16", width: 16, height: 16, "aria-hidden": "true" }, s("path", { d: "M5.5 2.5h5M6.5 2.5v4l-2 3h7l-2-3v-4M8 9.5v4.5", fill: "none", stroke: "currentColor", "stroke-width": 1.5, "stroke-linecap": "round", "stroke-linejoin": "round" })));
  private pinned: Pinned | null = null;

  constructor(private readonly live: Live) {
    live.listen(["answer"], () => {
      this.button.disabled = live.answer === null;
      this.draw();
    });
  }

  private toggle(): void {
    this.pinned = this.pinned ? null : this.state();
    this.draw();
  }

  private state(): Pinned {
    const { text, analyses, analysis, answer, map, worst } = this.live;
    const one = map ?? answer?.paths[0] ?? answer?.volumes[0] ?? answer?.holes[0];
    return { text, analyses, analysis, worst_um: worst?.in_plane_um ?? null, within: one?.fraction_within ?? null };
  }

  private draw(): void {
    const { pinned, live } = this;
    this.button.setAttribute("aria-pressed", String(pinned !== null));
    this.root.hidden = pinned === null;
    if (!pinned) return;
    const now = this.state();
    const values = ({ worst_um, within, analysis }: Pinned): Child => [`${analysis ?? ""}: worst ${um(worst_um)} µm, ${percent(within)} within tolerance`];
    const change = difference(now.worst_um, pinned.worst_um);
    const swap = () => {
      live.use(pinned.text, pinned.analyses);
      if (pinned.analysis !== null && pinned.analysis !== live.analysis) live.choose(pinned.analysis);
      this.pinned = now;
      this.draw();
    };
    renew(
      this.root,
      h("span", {}, h("b", {}, "Pinned "), values(pinned)),
      h("span", {}, h("b", {}, "Now "), values(now), change ? [": ", h("b", { class: "pin-change" }, change)] : null),
      h("button", { type: "button", class: "quiet small", "data-key": "swap", title: "Shows the pinned state and pins the present one", onclick: swap }, "Swap"),
      h("button", { type: "button", class: "quiet small", "data-key": "unpin", onclick: () => this.toggle() }, "Unpin"),
    );
  }
}
