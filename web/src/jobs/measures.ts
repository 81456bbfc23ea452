// What a job recommends to change: the words of its buttons, and how it is applied to the study.

import type { Live } from "../live";
import type { Measure } from "../types";

const BUTTONS: Record<string, string> = {
  placement: "Apply this placement",
  spin: "Apply this search",
  axial_depth: "Set the depth",
  spindle: "Set the spindle speed",
  radial_depth: "Set the width",
  feed: "Set the feed",
  robot: "Apply these compliances",
};

export const buttonOf = (measure: Measure): string => BUTTONS[measure.measure] ?? "Apply";

export const APPLIES = "Changes the study and shows it; not saved yet, and can be undone.";

/** Changes the study, as one step. */
export function applyMeasure(measure: Measure, live: Live): void {
  const { analysis, changes } = measure;
  if (analysis !== null && live.analysis !== analysis && live.analyses.some((a) => a.name === analysis)) live.choose(analysis);
  live.changeAll(changes);
}
