// The worst points of the answer, each from another part of the path: a click goes there.

import { h, renew } from "../dom";
import { um } from "../format";
import type { Live } from "../live";
import type { OperationInView } from "../types";
import { lastFrom } from "./bands";

export class WorstList {
  readonly root = h("ol", { class: "worst-points", "aria-label": "Worst points, each from another part of the path" });

  constructor(private readonly live: Live, private readonly go: (index: number) => void) {}

  show(operations: OperationInView[]): void {
    const path = this.live.answer?.paths[0];
    const found = path?.worst_points ?? [];
    const indices = this.live.path?.about.worst ?? [];
    const tolerance = this.live.setting?.tolerance_um ?? Infinity;
    this.root.hidden = indices.length === 0;
    renew(
      this.root,
      ...found.slice(0, indices.length).map(({ line, cause, point }, i) => {
        const index = indices[i]!;
        const operation = operations[lastFrom(operations, index)];
        const about = [`${um(point.in_plane_um)} µm, point ${index + 1}`, operation?.name, `line ${line}`, cause].filter((part) => part).join(", ");
        return h("li", {}, h("button", { type: "button", class: point.in_plane_um > tolerance ? "over" : "", title: about, "data-key": `worst-${i}`, onclick: () => this.go(index) }, h("b", {}, `${um(point.in_plane_um)} µm`), h("small", {}, path?.program ? ` line ${line}` : ` point ${index + 1}`)));
      }),
    );
  }
}
