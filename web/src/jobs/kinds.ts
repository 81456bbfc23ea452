// The kinds of jobs: how the page names them, what their results say, and how they are applied to the study.

import { percent, um } from "../format";
import type { Live } from "../live";
import type { Answer, Job, Vec3 } from "../types";

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

interface PlaceResult {
  analysis: string;
  place: { centre_mm?: Vec3; tilt_deg?: number | null };
  home_deg?: number[] | null;
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

/** The result of each analysis or spring, a line each. */
export function resultLines(job: Job): { name: string; what: string }[] {
  if (job.kind === "identify") {
    const { springs } = job.answer as IdentifyResult;
    const stiffness = (s: SpringResult) => (s.stiffness_n_m_per_rad !== null ? `${s.stiffness_n_m_per_rad.toPrecision(3)} N m/rad` : s.stiffness_n_per_um !== null ? `${s.stiffness_n_per_um.toPrecision(3)} N/µm` : "rigid");
    return springs.map((s) => ({ name: s.name, what: `${stiffness(s)}, ${percent(s.fraction_known_from_tests)} known from the tests` }));
  }
  if (job.kind === "place") return [];
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
  if (job.kind === "identify") {
    const { tests, readings, springs } = job.answer as IdentifyResult;
    return `${springs.length} springs from ${tests} load tests with ${readings} readings.`;
  }
  const { answer } = job.answer as Answer;
  return resultLines(job).length > 1 ? null : answer;
}

/** How the result is applied to the study; null if there is nothing to apply. */
export function application(job: Job, live: Live): { text: string; about: string; apply: () => void } | null {
  if (!job.answer) return null;
  if (job.kind === "place") {
    const { analysis, place, home_deg } = job.answer as PlaceResult;
    const centre = place.centre_mm;
    if (!centre) return null;
    const apply = () => {
      if (live.analysis !== analysis && live.analyses.some((a) => a.name === analysis)) live.choose(analysis);
      live.changeTogether({
        "plane.centre_mm": centre,
        ...(typeof place.tilt_deg === "number" ? { "plane.tilt_deg": place.tilt_deg } : {}),
        ...(home_deg ? { "posture.home_deg": home_deg } : {}),
      });
    };
    return { text: "Apply this placement", about: "Changes the plane in the study and shows it; not saved yet, and can be undone.", apply };
  }
  if (job.kind === "posture") {
    const { paths } = job.answer as Answer;
    const first = paths.find((p) => p.search?.applied);
    if (!first) return null;
    const apply = () => {
      if (live.analyses.some((a) => a.name === first.name)) live.choose(first.name);
      if (!/^\s*(\[posture\.search\]|search\s*=|posture\.search\s*=)|[{,]\s*search\s*=/m.test(live.text)) live.change("posture.search", {}, true);
    };
    return { text: "Apply this search", about: "The study then searches the posture on every run; not saved yet, and can be undone.", apply };
  }
  const robot = job.files.find((name) => name.endsWith("robot.toml"));
  if (job.kind !== "identify" || !robot) return null;
  return { text: "Apply these compliances", about: `The study then uses ${robot}; not saved yet, and can be undone.`, apply: () => live.change("robot", robot, true) };
}
