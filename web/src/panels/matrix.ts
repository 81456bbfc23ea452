// The compliance matrix at the tool, with its units: displacement and turn for force and moment, in base axes.

import { h, type Child } from "../dom";
import { fixed, trimmed } from "../format";
import type { Live } from "../live";
import { panel } from "./panel";

const LOADS = ["Fx", "Fy", "Fz", "Mx", "My", "Mz"];
const MOVES = ["δx", "δy", "δz", "εx", "εy", "εz"];

export function matrix(live: Live): HTMLElement {
  const { root, show } = panel("matrix", "Compliance matrix");
  const draw = () => {
    const posture = live.pose?.answer.postures[live.posture];
    if (!posture?.compliance) return show(h("p", { class: "note" }, "The matrix at the tool appears here."));
    const c = posture.compliance;
    const most = (rows: number, columns: number) => Math.max(...c.slice(rows, rows + 3).flatMap((row) => row.slice(columns, columns + 3).map(Math.abs)));
    const scale = [[most(0, 0), most(0, 3)], [most(3, 0), most(3, 3)]];
    const soft = posture.stiffness?.principal_um_per_n;
    show(
      h(
        "table",
        { class: "matrix" },
        h("thead", {}, h("tr", {}, h("td", {}), LOADS.map((l) => h("th", { scope: "col" }, l)))),
        h(
          "tbody",
          {},
          c.map((row, i) => h("tr", {}, h("th", { scope: "row" }, MOVES[i]!), row.map((value, j) => cell(value, scale[i < 3 ? 0 : 1]![j < 3 ? 0 : 1]!, j === 3)))),
        ),
      ),
      h("p", { class: "note units" }, "Upper left ", h("b", {}, "µm/N"), ", upper right ", h("b", {}, "µm/(N m)"), ", lower left ", h("b", {}, "µrad/N"), ", lower right ", h("b", {}, "µrad/(N m)")),
      soft ? h("p", { class: "note" }, `Softest direction ${fixed(soft[0], 1)} µm/N, stiffest ${trimmed(soft.at(-1), 2)} µm/N.`) : null,
    );
  };
  live.listen(["pose"], draw);
  draw();
  return root;
}

/** Values are SI, shown as millionths; noise relative to the block is shown as zero. */
function cell(value: number, scale: number, border: boolean): Child {
  const shown = value * 1e6;
  const none = Math.abs(value) < scale * 1e-9;
  const size = Math.abs(shown);
  const strength = scale > 0 ? Math.round((28 * Math.abs(value)) / scale) : 0;
  return h("td", { class: border ? "block" : "", style: none ? "" : `background:color-mix(in srgb, var(--accent) ${strength}%, transparent)` }, none ? "0" : fixed(shown, size < 9.995 ? 2 : size < 99.95 ? 1 : 0));
}
