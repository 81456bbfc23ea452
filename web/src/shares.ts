// What each joint does to the in-plane deviation that is shown, in micrometres; negative works against it.

import { Vector3 } from "three";
import type { Pose, Vec3 } from "./types";

/**
 * As the server tells it; else each joint's own deviation, seen along the in-plane deviation of all of them (they add up
 * to its length). Null where the arm has no compliance.
 */
export function sharesOf(pose: Pose | null, posture: number, load_case: number, normal_axis: Vec3 | undefined): number[] | null {
  const values = pose?.in_plane[posture]?.[load_case - 1];
  if (values?.share_um) return values.share_um;
  const answer = pose?.answer.postures[posture];
  if (!answer?.joint_share_um || !answer.deviation_um || !normal_axis) return null;
  const way = new Vector3(...answer.deviation_um).projectOnPlane(new Vector3(...normal_axis)).normalize();
  return answer.joint_share_um.map((joint) => way.dot(new Vector3(...joint)));
}
