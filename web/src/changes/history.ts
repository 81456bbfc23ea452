// Undo and redo: the states of text and controls, one step for each change. Values that follow each other quickly under one
// key, as while a slider is dragged or a word is typed, are one step.

import type { Analysis } from "../types";

export interface Step {
  text: string;
  analyses: Analysis[];
  analysis: string | null;
  section: number;
}

/** Steps that are kept, and their characters together. */
const MOST_STEPS = 300;
const MOST_CHARACTERS = 20_000_000;
/** Time between two values of one step. */
const TOGETHER_MS = 900;

export class History {
  private past: Step[] = [];
  private present: Step | null = null;
  private future: Step[] = [];
  private key: string | null = null;
  private at_ms = 0;

  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }

  /** The present state; `key`: what was changed, null for a change that is always a step of its own. */
  record(step: Step, key: string | null, now_ms: number): void {
    const before = this.present;
    if (before && before.text === step.text && before.analysis === step.analysis && before.section === step.section) {
      this.present = step;
      return;
    }
    const continues = key !== null && key === this.key && now_ms - this.at_ms < TOGETHER_MS && this.past.length > 0;
    if (before && !continues) this.past.push(before);
    this.present = step;
    this.future = [];
    this.key = key;
    this.at_ms = now_ms;
    this.limit();
  }

  /** The state before the last change; null if there is none. */
  undo(): Step | null {
    return this.move(this.past, this.future);
  }

  /** The state that was undone last. */
  redo(): Step | null {
    return this.move(this.future, this.past);
  }

  private move(from: Step[], to: Step[]): Step | null {
    const step = from.pop();
    if (!step || !this.present) return null;
    to.push(this.present);
    this.present = step;
    this.key = null;
    return step;
  }

  private limit(): void {
    let characters = this.past.reduce((sum, step) => sum + step.text.length, 0);
    while (this.past.length > MOST_STEPS || (characters > MOST_CHARACTERS && this.past.length > 1)) characters -= this.past.shift()!.text.length;
  }
}
