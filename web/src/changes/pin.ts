// A pinned state: the present answer is compared with it in one line below the header and in the verdict; the scene shows its
// arm, and the difference to its values.

import { h, renew, s, type Child } from "../dom";
import { percent, um } from "../format";
import type { Live } from "../live";
import { Newest } from "../newest";
import { placesOf, whyNot, type PinnedScene } from "../scene/difference";
import { FIRST, presentLayer, valuesOf } from "../scene/layers";
import type { Values } from "../scene/points";
import { api } from "../server";
import type { Analysis, LayerKey, View } from "../types";

/** The compared quantity of an answer: its worst in-plane deviation, with its standard uncertainty. */
export interface Compared {
  worst_um: number | null;
  worst_u_um: number | null;
}

/** What is compared of an answer. */
export interface Pinned extends Compared {
  text: string;
  analyses: Analysis[];
  analysis: string | null;
  within: number | null;
  scene: PinnedScene;
}

const SAME = "the same as pinned";

/** "41 % less than pinned"; null if there is nothing to compare. */
export function difference(now_um: number | null, pinned_um: number | null): string | null {
  if (now_um === null || pinned_um === null || pinned_um <= 0) return null;
  const share = now_um / pinned_um - 1;
  if (Math.abs(share) < 0.005) return SAME;
  return `${percent(Math.abs(share))} ${share < 0 ? "less" : "more"} than pinned`;
}

/** Whether two values are as far apart as their uncertainties allow them to be by chance; false if one is not known. */
export function isWithinUncertainty(now: Compared, pinned: Compared): boolean {
  if (now.worst_um === null || pinned.worst_um === null || now.worst_u_um === null || pinned.worst_u_um === null) return false;
  return Math.abs(now.worst_um - pinned.worst_um) <= Math.hypot(now.worst_u_um, pinned.worst_u_um);
}

/** As `difference`; null also where it is within the uncertainty of the two. */
export const significant = (now: Compared, pinned: Compared): string | null => (isWithinUncertainty(now, pinned) ? null : difference(now.worst_um, pinned.worst_um));

export class Pin {
  readonly root = h("div", { class: "pin", role: "status", "aria-label": "Comparison with the pinned state", hidden: true });
  readonly button = h("button", { type: "button", class: "icon", "aria-label": "Pin this state for comparison", title: "Pin this state for comparison", "aria-pressed": "false", disabled: true, onclick: () => this.toggle() }, s("svg", { viewBox: "0 0 16 16", width: 16, height: 16, "aria-hidden": "true" }, s("path", { d: "M5.5 2.5h5M6.5 2.5v4l-2 3h7l-2-3v-4M8 9.5v4.5", fill: "none", stroke: "currentColor", "stroke-width": 1.5, "stroke-linecap": "round", "stroke-linejoin": "round" })));
  private pinned: Pinned | null = null;
  /** Values of the pinned state for a layer that was not shown then. */
  private readonly layers = new Newest<{ pinned: Pinned; key: LayerKey }, View>({
    work: ({ pinned, key }, signal) => api.view(pinned.text, pinned.analysis, [], { arm: null, lines: false, levels_um: null, layer: { key, levels: null } }, signal),
    done: (view, { pinned, key }) => {
      if (view.layer) pinned.scene.values.set(key, view.layer.values);
      this.live.notify("view");
    },
    failed: () => undefined,
  });

  constructor(private readonly live: Live) {
    live.listen(["answer"], () => (this.button.disabled = live.answer === null));
    live.listen(["answer", "view"], () => this.draw());
  }

  private toggle(): void {
    this.use(this.pinned ? null : this.state());
  }

  /** Compares with this state from now on. */
  private use(pinned: Pinned | null): void {
    this.pinned = pinned;
    this.live.pinned = pinned?.scene ?? null;
    this.live.compared = pinned;
    if (!pinned) this.live.differs = false;
    this.live.notify("view");
  }

  private toggleDifference(): void {
    this.live.differs = !this.live.differs;
    this.live.notify("view");
  }

  private state(): Pinned {
    const { text, analyses, analysis, answer, map, worst } = this.live;
    const one = map ?? answer?.paths[0] ?? answer?.volumes[0] ?? answer?.holes[0];
    return { text, analyses, analysis, worst_um: worst?.in_plane_um ?? null, worst_u_um: worst?.in_plane_u_um ?? null, within: one?.fraction_within ?? null, scene: this.sceneNow() };
  }

  private sceneNow(): PinnedScene {
    const { answer, scene, pose, posture, values, layer_answer } = this.live;
    const first = answer && answer.maps.length > 0 ? answer.maps.map(({ grid }) => grid.in_plane_um) : [scene?.points?.column("in_plane_um") ?? []];
    const known = new Map<LayerKey, Values[]>([[FIRST, first]]);
    if (layer_answer) known.set(layer_answer.key, valuesOf(this.live, layer_answer));
    return { drawing: pose?.drawings[posture] ?? null, kind: values?.kind ?? "", places: placesOf(this.live), values: known };
  }

  /** Why the scene shows no difference, where one is wanted. */
  private why(pinned: Pinned): Child {
    const { live } = this;
    if (!live.differs) return null;
    const shown = presentLayer(live);
    if (!pinned.scene.values.has(shown.key) && this.layers.idle) this.layers.submit({ pinned, key: shown.key });
    const why = whyNot(live, shown);
    return why ? h("span", { class: "pin-why" }, why) : null;
  }

  private draw(): void {
    const { pinned, live } = this;
    this.button.setAttribute("aria-pressed", String(pinned !== null));
    this.root.hidden = pinned === null;
    if (!pinned) return;
    const now = this.state();
    const values = ({ worst_um, within }: Pinned): Child => `worst ${um(worst_um)} µm, ${percent(within)} within tolerance`;
    const name = ({ analysis }: Pinned): Child => `${analysis ?? ""}: `;
    const change = difference(now.worst_um, pinned.worst_um);
    const swap = () => {
      live.use(pinned.text, pinned.analyses);
      if (pinned.analysis !== null && pinned.analysis !== live.analysis) live.choose(pinned.analysis);
      this.use(now);
    };
    renew(
      this.root,
      h("span", {}, h("b", {}, "Pinned "), name(pinned), values(pinned)),
      h("span", {}, h("b", {}, "Now "), now.analysis === pinned.analysis ? null : name(now), values(now), change ? [": ", h("b", { class: "pin-change" }, change), change !== SAME && isWithinUncertainty(now, pinned) ? h("span", { class: "pin-why" }, " (within the uncertainty)") : null] : null),
      this.why(pinned),
      h(
        "span",
        { class: "pin-actions" },
        h("button", { type: "button", class: "quiet small", "data-key": "differs", "aria-pressed": String(live.differs), title: "Colours show the value minus the pinned one, at the same points of the part", onclick: () => this.toggleDifference() }, "Difference to pinned"),
        h("button", { type: "button", class: "quiet small", "data-key": "swap", title: "Shows the pinned state and pins the present one", onclick: swap }, "Swap"),
        h("button", { type: "button", class: "quiet small", "data-key": "unpin", onclick: () => this.toggle() }, "Unpin"),
      ),
    );
  }
}
