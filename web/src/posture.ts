// Selects the posture of a pose and the load case to show, among the values of the server.

import type { CaseValues, Pose } from "./types";

/** Largest in-plane deviation of all cases: what a map shows at a point. */
export function envelope(cases: (CaseValues | null)[]): CaseValues | null {
  return cases.reduce<CaseValues | null>((most, c) => (c !== null && (most === null || c.in_plane_um > most.in_plane_um) ? c : most), null);
}

/** The load case, from 1, that gives the envelope. */
export function worstCase(cases: (CaseValues | null)[]): number | null {
  const most = envelope(cases);
  return most === null ? null : cases.indexOf(most) + 1;
}

const words = (branch: string): string[] => branch.split(" ").filter(Boolean);

/** Whether every word of the pattern is a word of the branch: "front elbow-up" matches both flips. */
export const fits = (branch: string | null, pattern: string): boolean => branch !== null && words(pattern).every((word) => words(branch).includes(word));

/** In words, which bodies are nearer than demanded; null where none are. */
export function tooNear(pose: Pose, index: number): string | null {
  const { nearest, clearance_mm } = pose.answer.postures[index]!;
  if (!nearest || pose.drawings[index]?.cell?.keeps_clearance !== false) return null;
  return `${clearance_mm === 0 ? "in contact" : "too near"}: ${nearest.join(" and ")}`;
}

/**
 * The branch chosen by the user; else the posture of the answer. Where the answer has none: the best of those that the
 * study specifies, inside joint limits and with the demanded clearance before others; with "best" or a name that no posture has, the best of all.
 */
export function choosePosture(pose: Pose, chosen: string | null, specified: string | null): number {
  const postures = pose.answer.postures;
  if (chosen !== null) {
    const exact = postures.findIndex((p) => p.branch === chosen);
    if (exact >= 0) return exact;
  }
  if (pose.answered !== null && pose.answered < postures.length) return pose.answered;
  const open = postures.map((_, i) => i).filter((i) => specified !== null && fits(postures[i]!.branch, specified));
  const from = open.length > 0 ? open : postures.map((_, i) => i);
  const cost = (i: number) => (postures[i]!.within_limits ? 0 : 1e12) + (tooNear(pose, i) ? 1e12 : 0) + (envelope(pose.in_plane[i] ?? [])?.in_plane_um ?? 1e11);
  return from.reduce((best, i) => (cost(i) < cost(best) ? i : best), from[0] ?? 0);
}
