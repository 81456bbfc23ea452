// What each joint does to the in-plane deviation that is shown, in micrometres; negative works against it.

import type { Live } from "./live";

/** As the server tells it of the case; of the worst and best point as the answer tells it. */
export function sharesOf(live: Live): number[] | null {
  return live.pose?.in_plane[live.posture]?.[live.load_case - 1]?.share_um ?? live.told?.joint_share_um ?? null;
}
