// Robots without known joint compliances: those of a class can be assumed by one click, and results are marked then.

import { h } from "../dom";
import type { Live } from "../live";
import type { RobotRow } from "../types";

/** The robot that a problem says has no compliances; null if it says something else. */
export const robotWithout = (message: string): string | null => /^no joint compliance is known for robot `(.+)`$/.exec(message)?.[1] ?? null;

/** Sets the robot, and the class of compliances that this robot requires or no longer requires. */
export function chooseRobot(live: Live, name: string, row: RobotRow | undefined): void {
  const assumed = live.answer?.robot.compliance_assumed && row;
  // Compliances of a class belong to the robot before: known ones replace them, other robots have their own class.
  const compliance = assumed && row.compliance ? { compliance: null } : assumed && row.compliance_class ? { "compliance.class": row.compliance_class } : {};
  live.changeTogether({ robot: name, ...compliance }, true);
}

/** Buttons that assume the compliances of the class of this robot, or of any class where it is the user's own; null if the problem is another one. */
export function offerClass(message: string, live: Live, rows: RobotRow[]): HTMLElement | null {
  const name = robotWithout(message);
  if (name === null) return null;
  const row = rows.find((one) => one.name === name);
  const classes = new Set(row ? [row.compliance_class] : rows.map((one) => one.compliance_class));
  const known = [...classes].filter((one) => one !== null);
  if (known.length === 0) return null;
  const offer = (one: string) => h("button", { type: "button", class: "quiet small", "data-key": row ? "assume" : `assume ${one}`, onclick: () => live.changeTogether({ robot: name, "compliance.class": one }, true) }, `Assume class ${one}`);
  return h("span", { class: "offer" }, known.map(offer), " Every result is then marked: compliances assumed, not measured.");
}
