// The kinds of jobs: how the page names them, and what their results say.

import { percent, um } from "../format";
import type { Answer, Job } from "../types";

export interface JobKind {
  id: string;
  /** On the card. */
  name: string;
  /** On the button that starts it. */
  start: string;
  about: string;
  /** The table of the study with its bounds. */
  bounds: string | null;
}

export const KINDS: JobKind[] = [
  { id: "run", name: "Run", start: "Run the study", about: "All analyses, with tables, pictures and report in the folder of the study.", bounds: null },
  { id: "place", name: "Placement", start: "Find the best placement", about: "The placement of the part with the smallest deviation of a path.", bounds: "place" },
  { id: "posture", name: "Posture", start: "Find the best posture", about: "The best spin of the tool and branch along the paths; requires a path.", bounds: "posture" },
  { id: "advise", name: "Advice", start: "Advise", about: "Placement, spin, cut and compensation that bring a path within the tolerance, each with its gain.", bounds: null },
  { id: "compensate", name: "Compensation", start: "Compensate", about: "The path to command so that the tool follows the nominal path, as a table and in the program it comes from.", bounds: null },
  { id: "identify", name: "Compliance identification", start: "Identify compliances", about: "Joint compliances from load tests: a table in the folder of the study.", bounds: null },
];

export const kindName = (id: string): string => KINDS.find((kind) => kind.id === id)?.name ?? id;

export const isOver = (job: Job): boolean => job.state === "done" || job.state === "failed" || job.state === "cancelled";

/** Time until a running job ends, s, from its progress; null if that says too little. */
export function timeLeft({ state, done, of, seconds }: Pick<Job, "state" | "done" | "of" | "seconds">): number | null {
  if (state !== "running" || of === 0 || done === 0 || done >= of || seconds < 1) return null;
  return (seconds * (of - done)) / done;
}

/** A rough time, rounded up: more digits would only flicker. */
export function roughly(seconds: number): string {
  if (seconds < 60) return `${Math.max(5, 5 * Math.ceil(seconds / 5))} s`;
  if (seconds < 3600) return `${Math.ceil(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}

interface SpringResult {
  name: string;
  stiffness_n_m_per_rad: number | null;
  stiffness_n_per_um: number | null;
  fraction_known_from_tests: number;
}
interface IdentifyResult {
  robot: string;
  tests: number;
  readings: number;
  springs: SpringResult[];
  notes: string[];
}

/** Kinds of measures in the result of an advice. */
const MEASURES: Record<string, string> = { placement: "Placement", spin: "Spin", spindle: "Spindle speed", axial_depth: "Depth", radial_depth: "Width", feed: "Feed", compensation: "Compensation" };

/** The result of each analysis or spring, a line each. */
export function resultLines(job: Job): { name: string; what: string }[] {
  if (job.kind === "identify") {
    const { springs } = job.answer as IdentifyResult;
    const stiffness = (s: SpringResult) => (s.stiffness_n_m_per_rad !== null ? `${s.stiffness_n_m_per_rad.toPrecision(3)} N m/rad` : s.stiffness_n_per_um !== null ? `${s.stiffness_n_per_um.toPrecision(3)} N/µm` : "rigid");
    return springs.map((s) => ({ name: s.name, what: `${stiffness(s)}, ${percent(s.fraction_known_from_tests)} known from the tests` }));
  }
  if (job.kind === "place" || job.kind === "compensate") return [];
  if (job.kind === "advise") return job.measures.map(({ measure, sentence }) => ({ name: MEASURES[measure] ?? measure, what: sentence }));
  const answer = job.answer as Answer;
  const worst = (point: { in_plane_um: number } | null) => (point ? `, worst ${um(point.in_plane_um)} µm` : "");
  const within = (share: number) => `${percent(share)} within tolerance`;
  return [
    ...answer.maps.map((m) => ({ name: m.name, what: within(m.fraction_within) + worst(m.worst) })),
    ...answer.paths.map((p) => ({ name: p.name, what: within(p.fraction_within) + worst(p.worst) + (p.unreachable > 0 ? `, ${p.unreachable} of ${p.points} points unreachable` : "") + gain(p.search) })),
    ...answer.volumes.map((v) => ({ name: v.name, what: within(v.fraction_within) + worst(v.worst) })),
    ...answer.holes.map((o) => ({ name: o.name, what: within(o.fraction_within) + worst(o.worst_holes[0]?.point ?? null) + (o.unreachable > 0 ? `, ${o.unreachable} of ${o.holes} holes unreachable` : "") })),
  ];
}

function gain(search: { applied: boolean; gain_um: number } | null | undefined): string {
  if (!search) return "";
  return search.applied ? `; ${um(search.gain_um)} µm less by the search` : "; the search found no significant gain: the posture is kept";
}

/** One sentence above the lines; null if the lines say all. */
export function resultSentence(job: Job): string | null {
  if (job.kind === "place") return job.best ?? null;
  if (job.kind === "advise") return (job.answer as { advice: string[] }).advice[0] ?? null;
  if (job.kind === "compensate") return (job.answer as { sentences: string[] }).sentences.join(" ");
  if (job.kind === "identify") {
    const { tests, readings, springs } = job.answer as IdentifyResult;
    return `${springs.length} springs from ${tests} load tests with ${readings} readings.`;
  }
  const { answer } = job.answer as Answer;
  return resultLines(job).length > 1 ? null : answer;
}
