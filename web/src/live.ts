// State of the page: one study text, one analysis, its answer, and the pose of the robot. Panels and scene listen to it.
//
// A change of a control is one request, /api/view, whose answer has map and arm, and one frame; the newest wins. If only the
// robot is sent to another point of the same map, /api/pose is requested. The returned text is the text of the next
// change, so that comments and order are kept.

import type { Draft } from "./changes/drafts";
import { History, type Step } from "./changes/history";
import type { Compared } from "./changes/pin";
import type { PinnedScene } from "./scene/difference";
import { FIRST } from "./scene/layers";
import { DRAWN, Points } from "./scene/points";
import { api, Refused } from "./server";
import { Newest } from "./newest";
import { choosePosture, worstCase } from "./posture";
import { PathColumns } from "./timeline/columns";
import type { Answer, Analysis, At, Change, Extremes, Follow, LayerAnswer, LayerKey, MapAnswer, MapLines, Point, Pose, Scene, Setting, Study, Values, View } from "./types";

export type Topic = "study" | "text" | "answer" | "pose" | "at" | "moving" | "busy" | "error" | "view" | "part";

interface Job {
  analysis: string | null;
  since: number;
}
interface Result {
  sent: Map<string, unknown>;
  /** The text that the changes were made in. */
  base: string;
  /** Number of the target that the arm of the view belongs to. */
  wish: number;
  view: View;
  scene: Scene;
  path: PathColumns | null;
}

export class Live {
  study: Study | null = null;
  text = "";
  analyses: Analysis[] = [];
  analysis: string | null = null;
  answer: Answer | null = null;
  values: Values | null = null;
  scene: Scene | null = null;
  /** The points of a path; null of another analysis. */
  path: PathColumns | null = null;
  /** The worst and best points; for sections those of each. */
  extremes: Extremes[] = [];
  /** Levels of the colour scale, µm: the last ones if no point has a deviation. */
  levels_um: number[] | null = null;
  /** Lines of equal deviation; for sections those of each. */
  lines: MapLines[] = [];
  /** Whether lines at the levels are requested, and whether the levels stay as they are; the next answer follows it. */
  readonly wanted = { lines: true, fix_scale: false };
  /** What colours show, and its values where the answer does not have them. */
  layer: LayerKey = FIRST;
  layer_answer: LayerAnswer | null = null;
  /** What scene and verdict keep of a pinned state, and whether colours show the difference to it. */
  pinned: PinnedScene | null = null;
  compared: Compared | null = null;
  differs = false;
  pose: Pose | null = null;
  posture = 0;
  load_case = 1;
  follow: Follow = "worst";
  at: At | null = null;
  section = 0;
  busy = false;
  /** A pose is requested: the values shown are those of the previous point. */
  moving = false;
  error: Refused | null = null;
  /** Whether a control shows the error. */
  error_at_field = false;
  pose_error: string | null = null;
  /** Time from the last input to the frame. */
  took_ms: number | null = null;
  readonly history = new History();

  private pending = new Map<string, unknown>();
  private listeners: { topics: Topic[]; listener: () => void }[] = [];
  private chosen_branch: string | null = null;
  private fixed_case: number | null = null;
  /** Counts the targets of the robot. */
  private wish = 0;
  private input_at = 0;
  /** Whether the text itself is invalid, as far as known. */
  private invalid = false;
  /** Whether the text was edited since the view was requested. */
  private edited = false;

  private readonly answers = new Newest<Job, Result>({
    work: (job, signal) => this.requestView(job, signal),
    done: (result, job) => this.take(result, job),
    failed: (error) => void this.fail(error),
    busy: (busy) => {
      this.busy = busy;
      this.notify("busy");
    },
  });
  private readonly poses = new Newest<{ at: At; load_case: number }, Pose>({
    work: ({ at, load_case }, signal) => api.pose(this.text, this.analysis, at, load_case, signal),
    done: (pose, { at, load_case }) => {
      this.takePose(pose, at, load_case);
      this.notify("pose");
    },
    failed: (error) => {
      if (error instanceof Refused && error.kind === "superseded") return;
      this.pose_error = error instanceof Error ? error.message : String(error);
      this.pose = null;
      this.notify("pose");
    },
    busy: (moving) => {
      this.moving = moving;
      this.notify("moving");
    },
  });

  listen(topics: Topic[], listener: () => void): void {
    this.listeners.push({ topics, listener });
  }
  /** Calls each listener of these topics once. */
  notify(...news: Topic[]): void {
    for (const { topics, listener } of this.listeners) if (topics.some((topic) => news.includes(topic))) listener();
  }

  // ---- Input of the user ----

  open(study: Study): void {
    this.study = study;
    this.use(study.text, study.analyses);
  }

  /** The text stays, and is based on this state of the file from now on. */
  rebase(disk: Study): void {
    this.study = disk;
    this.notify("study");
  }

  /** Whether there are changes that the file does not have. */
  get unsaved(): boolean {
    return this.study !== null && (this.text !== this.study.text || !this.settled);
  }

  /** Changes of controls that are not in the text yet. */
  get waiting(): Change[] {
    return changesOf(this.pending);
  }

  /** Saves the current text to the file. */
  async save(): Promise<void> {
    await this.applyWaiting();
    this.study = await api.save(this.text, this.study!.version);
    this.notify("study");
  }

  discard(): void {
    if (this.study) this.use(this.study.text, this.study.analyses);
  }

  /** Another text, from the file or the editor. */
  use(text: string, analyses: Analysis[]): void {
    this.text = text;
    this.analyses = analyses;
    this.pending.clear();
    this.invalid = this.edited = false;
    if (!analyses.some((a) => a.name === this.analysis)) this.analysis = analyses[0]?.name ?? null;
    this.record(null);
    this.notify("study", "text");
    this.refresh();
  }

  restoreDraft(draft: Draft): void {
    if (draft.analysis !== null && this.analyses.some((a) => a.name === draft.analysis)) this.analysis = draft.analysis;
    this.use(draft.text, this.analyses);
    for (const { key, value, whole } of draft.changes) this.pending.set(whole ? `\n${key}` : key, value);
    this.refresh();
  }

  /** Text as it is typed, also an invalid one. The view follows with `showEdited`. */
  edit(text: string, key: string | null = "text"): void {
    if (text === this.text) return;
    this.text = text;
    this.edited = true;
    this.record(key);
    this.notify("text");
  }

  /** Requests the view of the edited text. */
  showEdited(analyses: Analysis[]): void {
    if (!this.edited) return;
    this.edited = this.invalid = false;
    if (analyses.length > 0) this.analyses = analyses;
    if (!this.analyses.some((a) => a.name === this.analysis)) this.analysis = this.analyses[0]?.name ?? null;
    this.notify("study");
    this.refresh();
  }

  undo(): void {
    if (this.settled) return this.go(this.history.undo());
    // A change that is not answered yet.
    this.answers.cancel();
    this.pending.clear();
    this.notify("text");
    this.refresh();
  }

  redo(): void {
    this.go(this.history.redo());
  }

  private go(step: Step | null): void {
    if (!step) return;
    this.answers.cancel();
    this.pending.clear();
    this.invalid = this.edited = false;
    if (step.analysis !== this.analysis) this.leaveAnalysis();
    this.text = step.text;
    this.analyses = step.analyses;
    this.analysis = step.analysis;
    this.section = step.section;
    this.notify("study", "text");
    this.refresh();
  }

  private record(key: string | null): void {
    const { text, analyses, analysis, section } = this;
    this.history.record({ text, analyses, analysis, section }, key, performance.now());
  }

  private leaveAnalysis(): void {
    this.section = 0;
    this.follow = "worst";
    this.at = null;
    this.chosen_branch = null;
  }

  choose(analysis: string): void {
    this.leaveAnalysis();
    this.analysis = analysis;
    this.pending.clear();
    this.record("analysis");
    this.notify("study", "text");
    this.refresh();
  }

  /** Change by a control: the value null removes the key. `whole`: a key of the study, not of the analysis. */
  change(key: string, value: unknown, whole = false): void {
    this.pending.set(whole ? `\n${key}` : key, value);
    if (key === "posture.branch") this.chosen_branch = null;
    this.refresh();
  }

  /** Changes of several keys that are one step; `whole`: keys of the study, not of the analysis. */
  changeTogether(values: Record<string, unknown>, whole = false): void {
    this.changeAll(Object.entries(values).map(([key, value]) => ({ key, value, whole })));
  }

  /** Changes of several keys, of the analysis or of the study, that are one step. */
  changeAll(changes: Change[]): void {
    for (const { key, value, whole } of changes) this.pending.set(whole ? `\n${key}` : key, value);
    this.refresh();
  }

  refresh(): void {
    this.input_at = performance.now();
    if (this.text !== "") this.answers.submit({ analysis: this.analysis, since: this.input_at });
  }

  goTo(at: At): void {
    this.follow = "place";
    // Along a path and at holes each point has its own posture; a chosen one is kept on a plate.
    if (typeof at.point === "number") this.chosen_branch = null;
    this.at = at;
    this.input_at = performance.now();
    this.sendRobot();
  }

  followPoint(which: "worst" | "best"): void {
    this.follow = which;
    this.chosen_branch = null;
    this.input_at = performance.now();
    this.sendRobot();
  }

  choosePosture(index: number): void {
    this.posture = index;
    this.chosen_branch = index === this.pose?.answered ? null : (this.pose?.answer.postures[index]?.branch ?? null);
    this.notify("pose");
  }

  /** Null: the worst load case. */
  chooseCase(load_case: number | null): void {
    this.fixed_case = load_case;
    this.sendRobot();
  }
  get case_is_fixed(): boolean {
    return this.fixed_case !== null;
  }

  /** What colours show. */
  chooseLayer(key: LayerKey): void {
    this.layer = key;
    if (key === FIRST) this.notify("view");
    else this.refresh();
  }

  chooseSection(index: number): void {
    this.section = index;
    if (this.at && "y_mm" in this.at) this.at = { ...this.at, section: index };
    this.record("section");
    this.notify("answer");
    this.sendRobot();
  }

  // ---- Values shown ----

  get map(): MapAnswer | null {
    return this.answer?.maps[this.section] ?? this.answer?.maps[0] ?? null;
  }
  get setting(): Setting | null {
    return this.map?.setting ?? this.answer?.paths[0]?.setting ?? this.answer?.volumes[0]?.setting ?? this.answer?.holes[0]?.setting ?? null;
  }
  /** Whether the analysis has the vibration evaluated. */
  get asksForVibration(): boolean {
    const { answer } = this;
    if (!answer) return false;
    const subjects = [...answer.maps, ...answer.volumes, ...answer.paths];
    return subjects.some((subject) => Boolean(subject.vibration));
  }

  get worst(): Point | null {
    const a = this.answer;
    return this.map?.worst ?? a?.paths[0]?.worst ?? a?.volumes[0]?.worst ?? a?.holes[0]?.worst_holes[0]?.point ?? null;
  }
  get best(): Point | null {
    return this.map?.best ?? this.answer?.volumes[0]?.best ?? null;
  }

  /** The point of the answer at which the robot is, if posture and load case are those shown. */
  get answeredPoint(): Point | null {
    const point = this.followed;
    const same = point?.branch === (this.pose?.answer.postures[this.posture]?.branch ?? null) && point?.worst_case === this.load_case;
    return same ? point : null;
  }

  /** Whether no change waits for its answer. */
  get settled(): boolean {
    return this.pending.size === 0;
  }

  // ---- Requests to the server ----

  private async requestView(job: Job, signal: AbortSignal): Promise<Result> {
    const sent = new Map(this.pending);
    const base = this.text;
    const wish = this.wish;
    const there = this.follow === "place";
    const request = { follow: this.follow, at: there ? this.at : null, section: this.section, case: this.fixed_case ?? (there ? this.load_case : null) };
    const { lines, fix_scale } = this.wanted;
    const levels = fix_scale && this.layer_answer?.key === this.layer ? this.layer_answer.levels : null;
    const layer = this.layer === FIRST ? null : { key: this.layer, levels };
    const shown = { arm: request, lines, levels_um: fix_scale ? this.levels_um : null, layer };
    const view = await api.view(base, job.analysis, changesOf(sent), shown, signal);
    const path = view.path && new PathColumns(view.path, (keys) => api.pathColumns(view.text, job.analysis, keys));
    await path?.load(layer ? [...DRAWN, layer.key] : DRAWN);
    const points = path ? Points.ofPath(path) : view.scene.points && Points.ofAnswer(view.scene.points);
    return { sent, base, wish, view, scene: { ...view.scene, points }, path };
  }

  private take({ sent, base, wish, view, scene, path }: Result, job: Job): void {
    if (job.analysis !== this.analysis) return;
    if (base !== this.text) {
      // The text was edited meanwhile: the changes are made in the newer one.
      if (!this.edited) this.refresh();
      return;
    }
    this.invalid = false;
    for (const [key, value] of sent) if (this.pending.get(key) === value) this.pending.delete(key);
    this.text = view.text;
    this.analyses = view.analyses;
    this.answer = view.answer;
    if (this.settled) this.values = view.values;
    this.scene = scene;
    this.path = path;
    this.extremes = view.extremes;
    this.levels_um = view.levels_um ?? this.levels_um;
    this.lines = view.lines;
    this.layer_answer = view.layer;
    if (this.section >= Math.max(1, view.answer.maps.length)) this.section = 0;
    this.record(sent.size > 0 ? [...sent.keys()].sort().join() : null);
    const begun = performance.now();
    const arm = wish === this.wish ? view.arm : null;
    if (arm) {
      this.poses.cancel();
      this.at = arm.at;
      this.takePose(arm.pose, arm.at, arm.case);
    } else if (this.target === null) this.pose = null;
    const mended = this.error !== null;
    this.error = null;
    this.notify("answer", "pose");
    performance.measure("armill:draw", { start: begun });
    requestAnimationFrame(() => {
      // The scene requested this frame before: its commands have been sent to WebGL.
      performance.measure("armill:submitted", { start: job.since });
      setTimeout(() => {
        this.took_ms = performance.now() - job.since;
        performance.measure("armill:picture", { start: job.since });
        this.notify("busy");
      });
    });
    if (mended) this.notify("error");
    if (!arm && this.target !== null) this.sendRobot();
  }

  private async fail(error: unknown): Promise<void> {
    if (error instanceof Refused && error.kind === "superseded") return;
    const refused = error instanceof Refused ? error : new Refused(0, "internal", String(error), []);
    const [first] = refused.problems;
    this.error = first ? new Refused(refused.status, refused.kind, first.message, refused.problems, first.hint) : refused;
    this.error_at_field = false;
    const lost = error instanceof Refused && (error.status === 0 || error.status === 401);
    if (!lost && this.pending.size === 0) this.invalid = refused.problems.length > 0;
    // In a text that was invalid before, the change is made all the same; without a server it waits.
    if (!lost && this.invalid) await this.applyWaiting().catch(() => this.pending.clear());
    else if (!lost) this.pending.clear();
    this.notify("error", "text");
  }

  /** Changes of controls become text without a view. */
  async applyWaiting(): Promise<void> {
    if (this.settled) return;
    const sent = new Map(this.pending);
    const changed = await api.change(this.text, this.analysis, changesOf(sent));
    for (const [key, value] of sent) if (this.pending.get(key) === value) this.pending.delete(key);
    this.text = changed.text;
    if (changed.analyses.length > 0) this.analyses = changed.analyses;
    this.record([...sent.keys()].sort().join());
    this.notify("text");
  }

  /** Target of the robot; null if the followed point does not exist. */
  private get target(): At | null {
    if (this.follow === "place") return this.at;
    return (this.extremes[this.section] ?? this.extremes[0])?.[this.follow] ?? null;
  }

  /** Sends the robot to the target, with the current answer. */
  private sendRobot(): void {
    this.wish++;
    this.at = this.target;
    if (this.at === null) {
      this.pose = null;
      this.notify("pose");
      return;
    }
    this.notify("at");
    this.poses.submit({ at: this.at, load_case: this.fixed_case ?? this.followed?.worst_case ?? this.load_case });
  }

  /** A point on the plate shown. */
  onPlate(y_mm: number, z_mm: number): At {
    return this.answer!.maps.length > 1 ? { y_mm, z_mm, section: this.section } : { y_mm, z_mm };
  }

  /** The point of the answer that the robot follows, if it follows one. */
  private get followed(): Point | null {
    return this.follow === "worst" ? this.worst : this.follow === "best" ? this.best : null;
  }

  private takePose(pose: Pose, at: At, load_case: number): void {
    this.pose_error = pose.answer.postures.length === 0 ? (pose.answer.unreachable?.message ?? "The robot has no posture there.") : null;
    this.posture = choosePosture(pose, this.chosen_branch, this.followed?.branch ?? this.values?.branch_meant ?? null);
    const decides = worstCase(pose.in_plane[this.posture] ?? []);
    if (this.fixed_case === null && decides !== null && decides !== load_case) {
      this.load_case = decides;
      this.poses.submit({ at, load_case: decides });
      return;
    }
    this.load_case = load_case;
    this.pose = pose;
  }
}

/** As the server takes them: keys of the study begin with a line break here. */
const changesOf = (pending: Map<string, unknown>): Change[] => [...pending].map(([key, value]) => ({ key: key.trimStart(), value, whole: key.startsWith("\n") }));
