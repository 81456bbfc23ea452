// Short messages below the header that stay until they are answered or no longer true, each with its actions.

import { h } from "../dom";

export interface Action {
  text: string;
  run: () => void | Promise<void>;
}

export class Notices {
  readonly root = h("div", { class: "notices", role: "status", "aria-label": "Messages" });
  private readonly shown = new Map<string, { words: string; root: HTMLElement }>();

  /** Shows a message; one of the same `id` is replaced. `closes`: whether it can be closed without an action. */
  show(id: string, words: string, actions: Action[] = [], closes = false): void {
    const there = this.shown.get(id);
    if (there?.words === words) return;
    const close = closes ? h("button", { type: "button", class: "icon", "aria-label": "Close this message", onclick: () => this.hide(id) }, "×") : null;
    const buttons = actions.map(({ text, run }) =>
      h("button", { type: "button", class: "quiet small", onclick: () => void Promise.resolve(run()).catch((error: unknown) => this.show(`${id}-failed`, error instanceof Error ? error.message : String(error), [], true)) }, text),
    );
    const root = h("div", { class: "notice", "data-notice": id }, h("span", {}, words), buttons, close);
    if (there) there.root.replaceWith(root);
    else this.root.append(root);
    this.shown.set(id, { words, root });
  }

  hide(...ids: string[]): void {
    for (const id of ids) {
      this.shown.get(id)?.root.remove();
      this.shown.delete(id);
    }
  }
}
