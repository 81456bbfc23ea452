// Which of the postures of a pose is shown, and which load case of it. Choosing among numbers that came, no more.

import type { CaseValues, Pose } from "./types";

/** Largest in-plane deviation of all cases: what a map shows at a point. */
export function envelope(cases: (CaseValues | null)[]): CaseValues | null {
  return cases.reduce<CaseValues | null>((most, c) => (c !== null && (most === null || c.in_plane_um > most.in_plane_um) ? c : most), null);
}

/** The load case, from 1, that gives the envelope. */
export function decidingCase(cases: (CaseValues | null)[]): number | null {
  const most = envelope(cases);
  return most === null ? null : cases.indexOf(most) + 1;
}

const words = (branch: string): string[] => branch.split(" ").filter(Boolean);

/** True where every word of the wish is a word of the branch: "front elbow-up" wishes both flips. */
export const fits = (branch: string | null, wish: string): boolean => branch !== null && words(wish).every((word) => words(branch).includes(word));

/**
 * The branch that was wanted by name; else the best of those that the study asks for, inside joint limits before
 * outside. With "best" or a name that no posture has, the best of all.
 */
export function choosePosture(pose: Pose, wanted: string | null, asked: string | null): number {
  const postures = pose.answer.postures;
  if (wanted !== null) {
    const exact = postures.findIndex((p) => p.branch === wanted);
    if (exact >= 0) return exact;
  }
  const open = postures.map((_, i) => i).filter((i) => asked !== null && fits(postures[i]!.branch, asked));
  const from = open.length > 0 ? open : postures.map((_, i) => i);
  const cost = (i: number) => (postures[i]!.within_limits ? 0 : 1e12) + (envelope(pose.in_plane[i] ?? [])?.in_plane_um ?? 1e11);
  return from.reduce((best, i) => (cost(i) < cost(best) ? i : best), from[0] ?? 0);
}
