// What is on the screen: one study text, one ask, its answer, and where the robot stands. Panels and scene listen.
//
// A change of a control is one question, /api/view, whose answer tells map and arm at once, and one picture; newest wins.
// Where the robot is sent elsewhere on the same map, /api/pose is asked alone. The text that comes back becomes the text of
// the next change, so that comments and order stay as the user wrote them.

import { api, Refused } from "./server";
import { Newest } from "./newest";
import { choosePosture, decidingCase } from "./posture";
import type { Answer, Ask, At, Change, Extremes, Follow, MapAnswer, Point, Pose, Scene, Setting, Study, Values, View } from "./types";

export type Topic = "study" | "answer" | "pose" | "moving" | "busy" | "error" | "view";

interface Job {
  ask: string | null;
  since: number;
}
interface Result {
  sent: Map<string, unknown>;
  /** Which wish the arm of the view stands for. */
  wish: number;
  view: View;
}

export class Live {
  study: Study | null = null;
  text = "";
  asks: Ask[] = [];
  ask: string | null = null;
  answer: Answer | null = null;
  values: Values | null = null;
  scene: Scene | null = null;
  /** Where the worst and best points are: of sections those of each. */
  extremes: Extremes[] = [];
  pose: Pose | null = null;
  posture = 0;
  load_case = 1;
  follow: Follow = "worst";
  at: At | null = null;
  section = 0;
  busy = false;
  /** The robot is on its way: what is told of the point is of where it was. */
  moving = false;
  error: Refused | null = null;
  /** True where a control shows what is wrong. */
  error_at_field = false;
  pose_error: string | null = null;
  /** From the last input to the picture. */
  took_ms: number | null = null;

  private pending = new Map<string, unknown>();
  private listeners: { topics: Topic[]; told: () => void }[] = [];
  private wanted_branch: string | null = null;
  private fixed_case: number | null = null;
  /** Counts how often the robot was sent elsewhere. */
  private wish = 0;
  private input_at = 0;

  private readonly answers = new Newest<Job, Result>({
    work: (job, signal) => this.ask_server(job, signal),
    done: (result, job) => this.take(result, job),
    failed: (error) => this.fail(error),
    busy: (busy) => {
      this.busy = busy;
      this.tell("busy");
    },
  });
  private readonly poses = new Newest<{ at: At; load_case: number }, Pose>({
    work: ({ at, load_case }, signal) => api.pose(this.text, this.ask, at, load_case, signal),
    done: (pose, { at, load_case }) => {
      this.takePose(pose, at, load_case);
      this.tell("pose");
    },
    failed: (error) => {
      if (error instanceof Refused && error.kind === "superseded") return;
      this.pose_error = error instanceof Error ? error.message : String(error);
      this.pose = null;
      this.tell("pose");
    },
    busy: (moving) => {
      this.moving = moving;
      this.tell("moving");
    },
  });

  listen(topics: Topic[], told: () => void): void {
    this.listeners.push({ topics, told });
  }
  /** Each listener once, whatever of it concerns it. */
  tell(...news: Topic[]): void {
    for (const { topics, told } of this.listeners) if (topics.some((topic) => news.includes(topic))) told();
  }

  // ---- What the user does ----

  open(study: Study): void {
    this.study = study;
    this.use(study.text, study.asks);
  }

  /** The text as it stands, into the file. */
  async save(): Promise<void> {
    this.study = await api.save(this.text, this.study!.version);
    this.tell("study");
  }

  /** Another text: from the file, from the editor. */
  use(text: string, asks: Ask[]): void {
    this.text = text;
    this.asks = asks;
    this.pending.clear();
    if (!asks.some((a) => a.name === this.ask)) this.ask = asks[0]?.name ?? null;
    this.tell("study");
    this.refresh();
  }

  choose(ask: string): void {
    this.ask = ask;
    this.section = 0;
    this.follow = "worst";
    this.at = null;
    this.wanted_branch = null;
    this.pending.clear();
    this.tell("study");
    this.refresh();
  }

  /** A control: value null removes the key. `whole`: a key of the study, not of the ask. */
  change(key: string, value: unknown, whole = false): void {
    this.pending.set(whole ? `\n${key}` : key, value);
    if (key === "posture.branch") this.wanted_branch = null;
    this.refresh();
  }

  refresh(): void {
    this.input_at = performance.now();
    if (this.text !== "") this.answers.submit({ ask: this.ask, since: this.input_at });
  }

  goTo(at: At): void {
    this.follow = "place";
    this.at = at;
    this.input_at = performance.now();
    this.stand();
  }

  followPoint(which: "worst" | "best"): void {
    this.follow = which;
    this.wanted_branch = null;
    this.input_at = performance.now();
    this.stand();
  }

  choosePosture(index: number): void {
    this.posture = index;
    this.wanted_branch = this.pose?.answer.postures[index]?.branch ?? null;
    this.tell("pose");
  }

  /** Null: the case that decides. */
  chooseCase(load_case: number | null): void {
    this.fixed_case = load_case;
    this.stand();
  }
  get case_is_fixed(): boolean {
    return this.fixed_case !== null;
  }

  chooseSection(index: number): void {
    this.section = index;
    if (this.at && "y_mm" in this.at) this.at = { ...this.at, section: index };
    this.tell("answer");
    this.stand();
  }

  // ---- What is shown ----

  get map(): MapAnswer | null {
    return this.answer?.maps[this.section] ?? this.answer?.maps[0] ?? null;
  }
  get setting(): Setting | null {
    return this.map?.setting ?? this.answer?.paths[0]?.setting ?? this.answer?.volumes[0]?.setting ?? this.answer?.holes[0]?.setting ?? null;
  }
  get worst(): Point | null {
    const a = this.answer;
    return this.map?.worst ?? a?.paths[0]?.worst ?? a?.volumes[0]?.worst ?? a?.holes[0]?.worst_holes[0]?.point ?? null;
  }
  get best(): Point | null {
    return this.map?.best ?? this.answer?.volumes[0]?.best ?? null;
  }

  /** The point of the answer that the robot stands at, where it shows that posture and case. */
  get told(): Point | null {
    const point = this.followed;
    const same = point?.branch === (this.pose?.answer.postures[this.posture]?.branch ?? null) && point?.deciding_case === this.load_case;
    return same ? point : null;
  }

  /** No change waits for its answer. */
  get settled(): boolean {
    return this.pending.size === 0;
  }

  // ---- Talking to the server ----

  private async ask_server(job: Job, signal: AbortSignal): Promise<Result> {
    const sent = new Map(this.pending);
    const changes: Change[] = [...sent].map(([key, value]) => ({ key: key.trimStart(), value, whole: key.startsWith("\n") }));
    const wish = this.wish;
    const there = this.follow === "place";
    const stand = { follow: this.follow, at: there ? this.at : null, section: this.section, case: this.fixed_case ?? (there ? this.load_case : null) };
    return { sent, wish, view: await api.view(this.text, job.ask, changes, stand, signal) };
  }

  private take({ sent, wish, view }: Result, job: Job): void {
    if (job.ask !== this.ask) return;
    for (const [key, value] of sent) if (this.pending.get(key) === value) this.pending.delete(key);
    this.text = view.text;
    this.asks = view.asks;
    this.answer = view.answer;
    if (this.settled) this.values = view.values;
    this.scene = view.scene;
    this.extremes = view.extremes;
    if (this.section >= Math.max(1, view.answer.maps.length)) this.section = 0;
    const begun = performance.now();
    const stands = wish === this.wish ? view.stands : null;
    if (stands) {
      this.poses.cancel();
      this.at = stands.at;
      this.takePose(stands.pose, stands.at, stands.case);
    } else if (this.standing === null) this.pose = null;
    const mended = this.error !== null;
    this.error = null;
    this.tell("answer", "pose");
    performance.measure("armill:draw", { start: begun });
    requestAnimationFrame(() => {
      // The scene asked for this frame before: its commands are with WebGL now.
      performance.measure("armill:submitted", { start: job.since });
      setTimeout(() => {
        this.took_ms = performance.now() - job.since;
        performance.measure("armill:picture", { start: job.since });
        this.tell("busy");
      });
    });
    if (mended) this.tell("error");
    if (!stands && this.standing !== null) this.stand();
  }

  private fail(error: unknown): void {
    if (error instanceof Refused && error.kind === "superseded") return;
    this.error = error instanceof Refused ? error : new Refused(0, "internal", String(error), []);
    const [first] = this.error.problems;
    if (first) this.error = new Refused(this.error.status, this.error.kind, first.message, this.error.problems, first.hint);
    this.pending.clear();
    this.error_at_field = false;
    this.tell("error");
  }

  /** Where the robot is to stand; null where what it follows is not there. */
  private get standing(): At | null {
    if (this.follow === "place") return this.at;
    return (this.extremes[this.section] ?? this.extremes[0])?.[this.follow] ?? null;
  }

  /** Sends the robot there, on what is shown already. */
  private stand(): void {
    this.wish++;
    this.at = this.standing;
    if (this.at === null) {
      this.pose = null;
      this.tell("pose");
      return;
    }
    this.poses.submit({ at: this.at, load_case: this.fixed_case ?? this.followed?.deciding_case ?? this.load_case });
  }

  /** A place on the plate that is shown. */
  onPlate(y_mm: number, z_mm: number): At {
    return this.answer!.maps.length > 1 ? { y_mm, z_mm, section: this.section } : { y_mm, z_mm };
  }

  /** The answer's point that the robot follows, where it follows one. */
  private get followed(): Point | null {
    return this.follow === "worst" ? this.worst : this.follow === "best" ? this.best : null;
  }

  private takePose(pose: Pose, at: At, load_case: number): void {
    this.pose_error = pose.answer.postures.length === 0 ? (pose.answer.unreachable?.message ?? "The robot has no posture there.") : null;
    this.posture = choosePosture(pose, this.wanted_branch ?? this.followed?.branch ?? null, this.values?.branch_meant ?? null);
    const decides = decidingCase(pose.in_plane[this.posture] ?? []);
    if (this.fixed_case === null && decides !== null && decides !== load_case) {
      this.load_case = decides;
      this.poses.submit({ at, load_case: decides });
      return;
    }
    this.load_case = load_case;
    this.pose = pose;
  }
}
