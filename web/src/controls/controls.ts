// Controls: part position, tool and load, tolerance and grid, posture, robot. Every change is sent to the server.

import { robotRows, type Refused } from "../server";
import { h } from "../dom";
import type { Live } from "../live";
import { pathOf, problemSentence, problemWords } from "../problem-words";
import type { RobotRow, Vec3 } from "../types";
import { chooseRobot, offerClass } from "./assume";
import { Choice } from "./choice";
import { NumberField } from "./field";
import { Forces } from "./forces";
import { ProcessControls } from "./process";

interface Control {
  readonly id: string;
  readonly root: HTMLElement;
  /** What is wrong, and what to do: in words, or as an element with an action. */
  refuse(message: string, hint: string | HTMLElement | null): void;
  clear(): void;
}

export function controls(live: Live): HTMLElement {
  let robots: RobotRow[] = [];
  let last: Control | null = null;
  const touch = (control: () => Control, key: string, value: unknown, whole = false) => {
    last = control();
    live.change(key, value, whole);
  };

  const ofProgram = () => live.analyses.find((a) => a.name === live.analysis)?.keys?.some((key) => key.startsWith("program")) ?? false;

  const analysis = new Choice("field-analysis", "Analysis", (name) => live.choose(name));
  const section = new Choice("field-section", "Plane shown", (index) => live.chooseSection(Number(index)));
  const centre = (axis: number, value: number): Vec3 => live.values!.centre_mm!.map((v, i) => (i === axis ? value : v)) as Vec3;
  const place = (axis: number) => (value: number) => {
    const now = centre(axis, value);
    live.values!.centre_mm = now;
    touch(() => [x, y, z][axis]!, live.values!.centre_key, now);
  };
  const x = new NumberField({ id: "field-x", label: "Distance x", unit: "mm", range: [300, 1600], step: 10, input: place(0), hint: "From the first axis of the robot to the centre of the plate" });
  const y = new NumberField({ id: "field-y", label: "Sideways y", unit: "mm", range: [-800, 800], step: 10, input: place(1) });
  const z = new NumberField({ id: "field-z", label: "Height z", unit: "mm", range: [-200, 1800], step: 10, input: place(2) });
  const tilt = new NumberField({ id: "field-tilt", label: "Tilt", unit: "°", range: [-90, 90], step: 5, input: (v) => touch(() => tilt, "plane.tilt_deg", v), hint: "0 faces the robot, 90 faces up" });
  const tool = new NumberField({
    id: "field-tool",
    label: "Tool length",
    unit: "mm",
    range: [0, 400],
    step: 5,
    input: (v) => {
      const now: [number, number, number, number, number, number] = [...live.values!.flange_from_tool_mm_deg];
      now[2] = v;
      live.values!.flange_from_tool_mm_deg = now;
      touch(() => tool, "tool.flange_from_tool_mm_deg", now);
    },
    hint: "From the flange to the tip, along the flange's z axis",
  });
  const forces = new Forces((cases) => touch(() => forces, "load.cases_n", cases));
  const limit = new NumberField({ id: "field-limit", label: "Tolerance", unit: "µm", range: [5, 300], step: 5, input: (v) => touch(() => limit, "tolerance_um", v), hint: "Largest permitted in-plane deviation" });
  const half = new NumberField({ id: "field-half", label: "Plate half-width", unit: "mm", range: [50, 800], step: 50, input: (v) => touch(() => half, "plane.half_size_mm", v), hint: "Half the width and height of the plate" });
  const step = new NumberField({ id: "field-step", label: "Grid step", unit: "mm", range: [5, 100], step: 5, input: (v) => touch(() => step, "plane.step_mm", v) });
  const branch = new Choice("field-branch", "Branch", (v) => touch(() => branch, "posture.branch", v));
  const spin = new NumberField({ id: "field-spin", label: "Tool spin", unit: "°", range: [-180, 180], step: 5, input: (v) => touch(() => spin, ofProgram() ? "program.spin_deg" : "spin_deg", v), hint: "Rotation of the tool about its axis" });
  const robot = new Choice("field-robot", "Robot", (v) => {
    last = robot;
    chooseRobot(live, v, robots.find((r) => r.name === v));
  });
  const process = new ProcessControls(live, (control) => (last = control));
  const all: Control[] = [...process.all, analysis, section, x, y, z, tilt, tool, forces, limit, half, step, branch, spin, robot];

  const group = (title: string, ...children: Node[]) => h("fieldset", {}, h("legend", {}, title), children);
  const root = h(
    "form",
    { class: "controls", "aria-label": "Settings", onsubmit: (e: Event) => e.preventDefault() },
    group("Analysis", analysis.root, section.root),
    group("Part position", x.root, y.root, z.root, tilt.root),
    group("Tool and load", tool.root, forces.root),
    process.root,
    group("Tolerance and grid", limit.root, half.root, step.root),
    group("Robot posture", branch.root, spin.root, robot.root),
  );

  const fill = () => {
    analysis.set(live.analysis, live.analyses.map((a) => ({ value: a.name, text: a.name })));
    const maps = live.answer?.maps ?? [];
    section.set(maps.length > 1 ? String(live.section) : null, maps.map((m, i) => ({ value: String(i), text: m.name.replace(`${live.analysis}: `, "") })));
    const v = live.values;
    // While newer values are requested, the input of the user is kept.
    if (!v || !live.settled) return;
    const plane = v.kind === "map" || v.kind === "path" || v.kind === "sections";
    // Sections have many distances or tilts: the plane's own one would change nothing.
    [x, y, z].forEach((field, i) => field.set(i === 0 && v.distances_mm ? null : v.centre_mm[i]!));
    tilt.set(v.tilts_deg ? null : v.tilt_deg);
    tool.set(v.flange_from_tool_mm_deg?.[2] ?? v.tool_length_mm);
    forces.set(v.cases_n && v.cases_n.length > 0 ? v.cases_n : null);
    limit.set(v.tolerance_um);
    half.set(plane && v.kind !== "path" ? (Array.isArray(v.half_size_mm) ? v.half_size_mm[0] : v.half_size_mm) : null);
    step.set(plane && v.kind !== "path" ? v.step_mm : null);
    branch.set(v.branch, ["nominal", "best", ...v.branches].map((b) => ({ value: b, text: b === "nominal" && v.branch === "nominal" ? `nominal: ${v.branch_meant}` : b })));
    spin.set(v.kind === "path" ? v.spin_deg : null);
    process.fill(v.process);
    fillRobot();
  };
  const fillRobot = () => {
    if (live.values && live.settled) robot.set(live.values.robot, robots.map((r) => ({ value: r.name, text: `${r.title}${r.compliance ? "" : " – no compliance known"}` })));
  };
  const showError = () => {
    for (const control of all) control.clear();
    if (live.error && last && live.error.status >= 400 && live.error.status < 500) {
      showErrors(live, robots, live.error, all, last);
      live.error_at_field = true;
    }
  };
  live.listen(["answer", "study"], fill);
  live.listen(["error"], showError);
  // The list may come after a value that was refused: that stays, with its error.
  void robotRows().then((rows) => {
    robots = rows;
    fillRobot();
    showError();
  }, () => undefined);
  return root;
}

// The keys of the study that each control sets, to find the one that a message is about.
const KEYS: Record<string, string[]> = {
  "field-x": ["centre_mm"],
  "field-tilt": ["tilt_deg"],
  "field-tool": ["flange_from_tool_mm_deg", "[tool]"],
  "field-forces": ["cases_n", "[load]"],
  "field-limit": ["tolerance_um"],
  "field-half": ["half_size_mm"],
  "field-step": ["step_mm"],
  "field-branch": ["branch"],
  "field-spin": ["spin_deg"],
  "field-robot": ["robot", "compliance"],
  "field-material": ["material"],
  "field-diameter": ["diameter_mm", "cutter"],
  "field-flutes": ["flutes"],
  "field-corner": ["corner_radius_mm"],
  "field-axial": ["axial_depth_mm", "axial depth"],
  "field-radial": ["radial_depth_mm", "radial depth"],
  "field-side": ["side"],
  "field-feed": ["feed_mm_per_min", "feed"],
  "field-spindle": ["spindle_rpm", "spindle"],
};

/** Each problem at the control whose key it names; at the one touched last where it names none. */
function showErrors(live: Live, robots: RobotRow[], { problems, message, hint }: Refused, all: Control[], last: Control): void {
  const list = problems.length > 0 ? problems : [{ message, hint }];
  for (const problem of list.slice(0, 3)) {
    const names = (control: Control) => KEYS[control.id]?.some((key) => problem.message.includes(key)) ?? false;
    const path = pathOf(problem.message);
    const axis = /centre_mm\[([0-2])\]$/.exec(path ?? "")?.[1];
    const coordinate = axis === undefined ? null : all.find((c) => c.id === `field-${"xyz"[Number(axis)]}`);
    const control = coordinate ?? (names(last) ? last : (all.find(names) ?? last));
    // The field itself is next to its name.
    const { field, what } = problemWords(problem.message);
    const offer = offerClass(problem.message, live, robots);
    control.refuse(field !== null && names(control) ? what : problemSentence(problem.message), offer ?? problem.hint);
  }
}
