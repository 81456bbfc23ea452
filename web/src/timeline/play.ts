// Play along the path: by the time of the program where every cut has a feed, else by the distance. The robot follows as fast as it is
// answered; the marker is at the time of the clock.

import { h } from "../dom";
import type { Axis } from "./axis";
import { firstFrom } from "./axis";

/** How fast: a multiple of the time of the program, or the whole path in some seconds. */
interface Speed {
  text: string;
  times?: number;
  whole_s?: number;
}

const BY_TIME: Speed[] = [
  { text: "as programmed", times: 1 },
  { text: "10 times as fast", times: 10 },
  { text: "100 times as fast", times: 100 },
];
const BY_LENGTH: Speed[] = [
  { text: "whole path in 60 s", whole_s: 60 },
  { text: "whole path in 20 s", whole_s: 20 },
  { text: "whole path in 5 s", whole_s: 5 },
];
/** A frame that comes later than this was not shown in time: the picture does not leap. */
const LONGEST_STEP_S = 0.25;

export class Player {
  readonly button = h("button", { type: "button", class: "quiet small play", title: "Play along the path (Space)", onclick: () => this.toggle() }, "▶ Play");
  readonly speed = h("select", { id: "play-speed", "aria-label": "Speed" });
  private speeds: Speed[] = [];
  /** Rises from point to point: time or distance. */
  private way: Float32Array = new Float32Array(0);
  private at = 0;
  private before = 0;
  private frame = 0;

  /** `go` sends the robot to a point; `now` is where it is. */
  constructor(private readonly go: (index: number) => void, private readonly now: () => number) {}

  /** `time`: null where it is not known. */
  show(axis: Axis, time: Float32Array | null): void {
    const chosen = this.speeds[this.speed.selectedIndex]?.text;
    this.way = time ?? axis.distance;
    this.speeds = time === null ? BY_LENGTH : [...BY_TIME, ...BY_LENGTH];
    this.speed.replaceChildren(...this.speeds.map(({ text }) => h("option", {}, text)));
    const same = this.speeds.findIndex(({ text }) => text === chosen);
    this.speed.selectedIndex = same >= 0 ? same : this.speeds.indexOf(BY_LENGTH[1]!);
    if (this.playing) this.at = this.way[this.now()] ?? 0;
  }

  get playing(): boolean {
    return this.frame !== 0;
  }

  toggle(): void {
    if (this.playing) this.stop();
    else this.start();
  }

  stop(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.button.textContent = "▶ Play";
  }

  private start(): void {
    const last = this.way.length - 1;
    if (last < 1) return;
    // From the end it begins again.
    this.at = this.now() >= last ? 0 : this.way[this.now()]!;
    this.before = performance.now();
    this.button.textContent = "❚❚ Pause";
    this.frame = requestAnimationFrame((now) => this.step(now));
  }

  private step(now: number): void {
    const passed = Math.min(LONGEST_STEP_S, Math.max(0, (now - this.before) / 1000));
    this.before = now;
    const end = this.way.at(-1)!;
    const { times, whole_s } = this.speeds[this.speed.selectedIndex] ?? BY_LENGTH[1]!;
    this.at += times === undefined ? (passed * end) / whole_s! : passed * times;
    if (this.at >= end) {
      this.go(this.way.length - 1);
      return this.stop();
    }
    const index = firstFrom(this.way, this.at);
    if (index !== this.now()) this.go(index);
    this.frame = requestAnimationFrame((next) => this.step(next));
  }
}
