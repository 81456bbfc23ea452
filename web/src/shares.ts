// What each joint does to the in-plane deviation that is shown, in micrometres; negative works against it.

import type { Live } from "./live";

/** From the server for the load case; from the answer for the worst and best point. */
export function sharesOf(live: Live): number[] | null {
  return live.pose?.in_plane[live.posture]?.[live.load_case - 1]?.share_um ?? live.answeredPoint?.joint_share_um ?? null;
}
