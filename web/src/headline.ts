// The headline of an answer: how much of it is within the tolerance inside the joint limits. What is evaluated outside
// them, or in a rejected posture, is never reported as within.

import { percent, trimmed, um } from "./format";
import type { Answer, HoleRow, MapAnswer } from "./types";

export interface Headline {
  /** Part of all points within the tolerance, inside joint limits. */
  share: number;
  /** `good`: all of it; `part`: some; `none`. */
  state: "good" | "part" | "none";
  line: string;
  /** Further facts, in the order of their weight. */
  extra: string[];
  /** Whether the robot reaches any point, in collision or not. */
  reached: boolean;
}

/** A hole that cannot be drilled: its number, from 1, and why. */
export interface LostHole {
  hole: number;
  why: string;
}

/** `map`: the one that is shown, of sections. */
export function headline(answer: Answer, map: MapAnswer | null): Headline {
  if (map) {
    const { certainty, counts, grid } = map;
    const unreached = grid.points - counts.within - counts.above_tolerance - counts.in_collision;
    return of("plate", map.fraction_within_and_inside_joint_limits, map.setting.tolerance_um, map.worst !== null, [
      outside(map.outside_joint_limits, grid.points, "hatched"),
      inCollision(counts.in_collision),
      unreached > 0 ? `${unreached} without posture` : null,
      certainty ? `robustly ${percent(certainty.fraction_robustly_within)}, possibly ${percent(certainty.fraction_possibly_within)}` : null,
    ], map.outside_joint_limits, counts.in_collision);
  }
  const path = answer.paths[0];
  if (path)
    return of("path", path.fraction_within_and_inside_joint_limits, path.setting.tolerance_um, path.worst !== null, [
      outside(path.outside_joint_limits, path.points, "dashed"),
      inCollision(path.in_collision),
      path.unreachable > path.in_collision ? `${path.unreachable - path.in_collision} unreachable` : null,
      `${path.points} points`,
      path.roundness_um !== null ? `roundness ${um(path.roundness_um)} µm` : null,
    ], path.outside_joint_limits, path.in_collision);
  const volume = answer.volumes[0];
  if (volume)
    return of("box", volume.fraction_within_and_inside_joint_limits, volume.setting.tolerance_um, volume.worst !== null, [
      inCollision(volume.counts.in_collision),
      volume.outside_joint_limits > 0 ? `${volume.outside_joint_limits} points outside joint limits` : null,
      `${(volume.volume_within_mm3 / 1e6).toFixed(1)} litres (dm³) within the tolerance${volume.outside_joint_limits > 0 ? ", limits neglected" : ""}`,
    ], volume.outside_joint_limits, volume.counts.in_collision);
  return ofHoles(answer);
}

function of(what: string, share: number, tolerance_um: number, evaluated: boolean, extra: (string | null)[], outside_limits: number, in_collision: number): Headline {
  const reached = evaluated || in_collision > 0;
  const tolerance = `${trimmed(tolerance_um, 1)}\u00a0µm`;
  const inside = outside_limits > 0 ? " and inside joint limits" : "";
  const line = !reached
    ? `The robot does not reach the ${what}`
    : !evaluated
      ? `No point of the ${what} is reached without collision`
      : share <= 0
        ? `No point of the ${what} is within ${tolerance}${inside}`
        : share >= 1
          ? `The whole ${what} is within ${tolerance}`
          : `${percent(share)} of the ${what} is within ${tolerance}${inside}`;
  return { share, state: stateOf(share), line, extra: extra.filter((e) => e !== null), reached };
}

const stateOf = (share: number): Headline["state"] => (share >= 1 ? "good" : share > 0 ? "part" : "none");
const outside = (count: number, points: number, how: string): string | null => (count > 0 ? `${count} of ${points} points outside joint limits (${how})` : null);

const inCollision = (count: number): string | null => (count > 0 ? `${count} in collision` : null);

function ofHoles(answer: Answer): Headline {
  const set = answer.holes[0];
  if (!set) return { share: 0, state: "none", line: "…", extra: [], reached: true };
  const tolerance = `${trimmed(set.setting.tolerance_um, 1)}\u00a0µm`;
  const within = Math.round(set.fraction_within * set.holes);
  const lost = lostHoles(answer);
  const drilled = set.holes - lost.length;
  const state = stateOf(set.fraction_within);
  const reached = set.unreachable < set.holes || set.each.some((row) => row.state === "in_collision");
  if (lost.length === 0) {
    const line = within === set.holes ? `All ${set.holes} holes are within ${tolerance}` : within === 0 ? `No hole is within ${tolerance}` : `${within} of ${set.holes} holes ${within === 1 ? "is" : "are"} within ${tolerance}`;
    return { share: set.fraction_within, state, line, extra: [`${set.holes} holes, all can be drilled`], reached };
  }
  const line = drilled === 0 ? `None of the ${set.holes} holes can be drilled` : `${drilled} of ${set.holes} holes can be drilled; ${reasons(lost)}`;
  const extra = drilled === 0 ? [reasons(lost)] : [`${within === drilled ? `all ${within}` : `${within} of these`} within ${tolerance}`, "crossed: cannot be drilled"];
  return { share: set.fraction_within, state, line, extra, reached };
}

/** Of these holes, in their order. */
export function lostHoles(answer: Answer): LostHole[] {
  const rows = answer.holes[0]?.each ?? [];
  const lost = rows.filter((row) => row.blocked_by !== null || row.branch === null);
  return lost.map((row) => ({ hole: row.hole, why: whyLost(row) })).sort((a, b) => a.hole - b.hole);
}

function whyLost(row: HoleRow): string {
  // Without another singularity the angle between axes 4 and 6 is below its limit.
  if (row.blocked_by === "singular") return `${row.singularity?.replaceAll("_", " ") ?? "wrist"} singular`;
  if (row.blocked_by !== null) return row.limit_joint ? `${row.limit_joint} outside its limits` : row.blocked_by.replaceAll("_", " ");
  return row.state.replaceAll("_", " ");
}

/** "17 and 18: wrist singular; 3: out of reach". */
function reasons(lost: LostHole[]): string {
  const by_reason = new Map<string, number[]>();
  for (const { hole, why } of lost) by_reason.set(why, [...(by_reason.get(why) ?? []), hole]);
  return [...by_reason].map(([why, holes]) => `${listed(holes)}: ${why}`).join("; ");
}

/** "1, 2 and 5"; many are counted. */
function listed(numbers: number[]): string {
  if (numbers.length > 6) return `${numbers.length} holes`;
  const last = numbers.at(-1)!;
  return numbers.length === 1 ? String(last) : `${numbers.slice(0, -1).join(", ")} and ${last}`;
}
