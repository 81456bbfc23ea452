// The machined part of the path shown: its surface, requested after each answer, finished or as it is at the point of the robot.

import { Newest } from "../newest";
import { api, Refused } from "../server";
import type { Live } from "../live";
import type { MachinedPart } from "../types";
import { PartSurface, type Quantity } from "./surface";

/** The part of an answer is cut when no newer answer has come for so long: it takes longer than a view. */
const SETTLE_MS = 250;

interface Job {
  text: string;
  analysis: string | null;
  frame: number;
  frames: number;
}

export class PartState {
  /** What is shown; null before, and of an analysis without a part. */
  surface: PartSurface | null = null;
  /** The finished part; its numbers are in the panel also while a part in process is shown. */
  finished: PartSurface | null = null;
  busy = false;
  error: string | null = null;
  quantity: Quantity = "deviation_um";
  /** Times by which the deviation of the surface is drawn larger than it is; 0: the nominal surface. */
  magnified = 0;
  /** Whether the part is in the scene. */
  visible = true;
  /** Whether the material is that at the point of the robot. */
  in_process = false;
  private kept: Pick<Job, "text" | "analysis"> | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;

  private readonly surfaces = new Newest<Job, PartSurface>({
    work: async ({ text, analysis, frame, frames }, signal) => {
      const surface = PartSurface.read(await api.partSurface(text, analysis, frame, frames, signal));
      // For what is under the pointer.
      if (this.live.path?.has("line")) await this.live.path.load(["line"]);
      return surface;
    },
    done: (surface, job) => this.take(surface, job),
    failed: (error) => {
      if (error instanceof Refused && error.kind === "superseded") return;
      this.error = error instanceof Error ? error.message : String(error);
      this.surface = this.finished = null;
      this.live.notify("part");
    },
    busy: (busy) => {
      this.busy = busy;
      this.live.notify("part");
    },
  });

  constructor(private readonly live: Live) {
    live.listen(["answer"], () => this.answered());
    live.listen(["at"], () => {
      if (this.in_process) this.request();
    });
  }

  /** Whether the analysis shown has a part. */
  get there(): boolean {
    return this.live.path?.about.has_part ?? false;
  }

  /** Whether the surface is that of an earlier state of the study. */
  get stale(): boolean {
    return this.kept === null || this.kept.text !== this.live.text || this.kept.analysis !== this.live.analysis;
  }

  get answer(): MachinedPart | null {
    return this.finished?.about.part ?? null;
  }

  /** Without the part nothing is requested. */
  show(visible: boolean): void {
    this.visible = visible;
    if (visible) this.request();
    else this.surfaces.cancel();
    this.live.notify("part");
  }

  /** The finished part, or the one at the point of the robot. */
  choose(in_process: boolean): void {
    this.in_process = in_process;
    this.request();
    this.live.notify("part");
  }

  /** The robot goes to a point of the timeline: the material follows it, until the end. */
  along(point: number): void {
    if (!this.there) return;
    const before = point + 1 < this.live.path!.count;
    if (before === this.in_process) return;
    // A part in process is requested when the robot is sent there.
    if (before) this.in_process = true;
    else this.choose(false);
  }

  private answered(): void {
    clearTimeout(this.timer);
    if (!this.there) {
      this.surfaces.cancel();
      this.surface = this.finished = this.kept = null;
      this.in_process = false;
      this.error = null;
      this.live.notify("part");
      return;
    }
    if (!this.stale) return;
    this.surfaces.cancel();
    this.live.notify("part");
    this.timer = setTimeout(() => this.request(), SETTLE_MS);
  }

  private request(): void {
    const { text, analysis, path, at } = this.live;
    if (!this.there || !path || !this.visible) return;
    const point = typeof at?.point === "number" ? at.point : path.count - 1;
    const frame = this.in_process ? point + 1 : path.count;
    if (frame === path.count && this.finished && !this.stale) {
      this.surfaces.cancel();
      this.surface = this.finished;
      this.live.notify("part");
    } else this.surfaces.submit({ text, analysis, frame, frames: path.count });
  }

  private take(surface: PartSurface, job: Job): void {
    if (job.text !== this.live.text || job.analysis !== this.live.analysis) return;
    if (this.stale) this.finished = null;
    this.kept = { text: job.text, analysis: job.analysis };
    this.error = null;
    this.surface = surface;
    if (surface.finished) this.finished = surface;
    if (!surface.quantities.some(({ key }) => key === this.quantity) && surface.finished) this.quantity = "deviation_um";
    this.live.notify("part");
  }
}
