// The deviation at the position of the robot: magnitude, in the plane, along the normal; as values and as a vector.

import { h, type Child } from "../dom";
import { DASH, fixed, mm, newton, plusMinus, um } from "../format";
import { lostHoles } from "../headline";
import type { Live } from "../live";
import { tooNear } from "../posture";
import { panel } from "./panel";

export function point(live: Live): HTMLElement {
  const { root, show } = panel("point", "At the tool");
  const draw = () => {
    const posture = live.pose?.answer.postures[live.posture];
    const values = live.pose?.in_plane[live.posture]?.[live.load_case - 1];
    if (!posture || !values) return show(h("p", { class: live.pose_error ? "note warn" : "note" }, live.pose_error ?? "Click a point of the plate or path."));
    const answered = live.answeredPoint;
    const u = values.in_plane_u_um;
    const along = values.permissible_along_load_n ?? answered?.permissible_along_load_n;
    const any = values.permissible_any_direction_n ?? answered?.permissible_any_direction_n;
    const tolerance = live.setting?.tolerance_um ?? Infinity;
    const hole = typeof live.at?.point === "number" ? live.at.point + 1 : null;
    const lost = live.answer ? lostHoles(live.answer).find((row) => row.hole === hole) : undefined;
    const near = tooNear(live.pose!, live.posture);
    const over = values.in_plane_um > tolerance;
    show(
      h(
        "div",
        { class: "three" },
        figure("In the plane", values.in_plane_um, over ? "over" : posture.within_limits && !lost ? "within" : "", u),
        figure("Along the normal", values.normal_um),
        figure("Full", values.full_um),
      ),
      h(
        "dl",
        { class: "facts" },
        fact("Position", posture.tool.xyz_mm.map(mm).join(", "), "mm"),
        fact("Moves by", values.deviation_um.map((v) => um(v)).join(", "), "µm"),
        fact("Turns by", posture.rotation_urad?.map((v) => fixed(v, 0)).join(", ") ?? DASH, "µrad"),
        along ? fact("Largest force within tolerance", newton(along), "N along this load") : null,
        any ? fact("", newton(any), "N in any direction") : null,
        posture.clearance_mm !== null && posture.nearest ? fact("Clearance", fixed(posture.clearance_mm, 1), `mm, ${posture.nearest.join(" – ")}`) : null,
      ),
      lost ? h("p", { class: "note warn" }, `Hole ${lost.hole} cannot be drilled: ${lost.why}.`) : null,
      posture.within_limits ? null : h("p", { class: "note warn" }, `${posture.limit_joint ?? "A joint"} is outside its limits: the robot cannot take this posture.`),
      near ? h("p", { class: "note warn" }, `${near[0]!.toUpperCase()}${near.slice(1)}.`) : null,
      posture.singularity ? h("p", { class: "note warn" }, `Near a singularity: ${posture.singularity.replaceAll("_", " ")}.`) : null,
    );
  };
  live.listen(["pose"], draw);
  draw();
  return root;
}

/** `u` is null where it is not known, and left out of a value without one. */
function figure(name: string, value: number, state = "", u?: number | null): Child {
  return h(
    "div",
    { class: `figure ${state}` },
    h("span", { class: "figure-name" }, name),
    h("span", { class: "figure-value" }, um(value)),
    h("span", { class: "figure-unit" }, u === undefined ? "µm" : plusMinus(u)),
  );
}

const fact = (name: string, value: string, unit: string): Child => [h("dt", {}, name), h("dd", {}, h("b", {}, value), ` ${unit}`)];
