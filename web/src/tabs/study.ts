// The study as text and as fields: checked while it is typed, saved with its comments.

import { offerClass } from "../controls/assume";
import { api, robotRows } from "../server";
import { fill, h } from "../dom";
import type { Live } from "../live";
import { Newest } from "../newest";
import { problemSentence } from "../problem-words";
import { Fields } from "../tables/fields";
import type { Checked, Problem, RobotRow, Tables } from "../types";
import type { Tab } from "./tab";

export function studyTab(live: Live, store: () => Promise<void>): Tab & { reveal: (table: string) => void } {
  const lines = h("div", { class: "lines", "aria-hidden": "true" });
  const text = h("textarea", { id: "study-text", spellcheck: "false", wrap: "off", "aria-label": "Study file, TOML", "aria-describedby": "study-problems" });
  const problems = h("div", { class: "problems", id: "study-problems", role: "status" });
  const save = h("button", { type: "button", class: "primary" }, "Save");
  const undo = h("button", { type: "button", class: "quiet" }, "Discard changes");
  const name = h("h1", {});
  const message = h("p", { class: "note", role: "status" });
  let checked: Checked | null = null;
  let robots: RobotRow[] = [];
  void robotRows().then((rows) => (robots = rows), () => undefined);
  let shown = false;
  /** The text that was checked last. */
  let followed: string | null = null;

  const number = (marked: Problem[]) => {
    const count = text.value.split("\n").length;
    const at = new Map(marked.filter((p) => p.line !== null).map((p) => [p.line!, problemSentence(p.message)]));
    fill(lines, ...Array.from({ length: count }, (_, i) => (at.has(i + 1) ? h("b", { title: at.get(i + 1)! }, i + 1) : h("span", {}, i + 1))));
    lines.scrollTop = text.scrollTop;
  };
  const showProblems = (list: Problem[]) => {
    number(list);
    fill(
      problems,
      list.length === 0
        ? h("p", { class: "fine" }, "✓ No problems")
        : [
            h("p", { class: "wrong" }, list.length === 1 ? "1 problem" : `${list.length} problems`),
            h("ul", {}, list.map((p) => h("li", {}, h("button", { type: "button", class: "link", onclick: () => jump(p) }, p.line === null ? "study" : `line ${p.line}${p.column === null ? "" : `, column ${p.column}`}`), " ", h("span", { title: p.message }, problemSentence(p.message)), " ", offerClass(p.message, live, robots) ?? (p.hint ? h("span", { class: "hint" }, p.hint) : null)))),
          ],
    );
  };
  const jump = (p: Problem) => {
    if (p.line === null) return;
    const rows = text.value.split("\n");
    const from = rows.slice(0, p.line - 1).reduce((sum, row) => sum + row.length + 1, 0);
    text.focus();
    text.setSelectionRange(from + (p.column ?? 1) - 1, from + rows[p.line - 1]!.length);
    text.scrollTop = Math.max(0, (p.line - 8) * 20);
  };
  // Fields change the text one after the other.
  let turn: Promise<void> = Promise.resolve();
  const fields = new Fields((path, value) => {
    const made = turn.then(async () => {
      try {
        const made = await api.change(text.value, null, [{ key: path, value, whole: true }]);
        live.edit(made.text, null);
        return true;
      } catch (error) {
        message.textContent = error instanceof Error ? error.message : String(error);
        return false;
      }
    });
    turn = made.then(() => undefined);
    return made;
  });
  void api.schema().then((schema) => fields.learn(schema), () => undefined);
  const checks = new Newest<string, [Checked, Tables]>({
    work: (value, signal) => Promise.all([api.check(value, signal), api.tables(value, signal)]),
    done: ([answer, tables], _, settled) => {
      if (!settled) return;
      checked = answer;
      showProblems(answer.problems);
      fields.show(tables);
    },
    failed: (error) => void (message.textContent = error instanceof Error ? error.message : String(error)),
  });
  /** Shows the text of the state, and checks it. */
  const follow = () => {
    const begin = firstDifference(text.value, live.text);
    if (begin !== null) {
      text.value = live.text;
      // Where it was changed, not at its end.
      text.setSelectionRange(begin, begin);
    }
    followed = live.text;
    checked = null;
    buttons();
    number([]);
    checks.submit(live.text);
  };
  const buttons = () => {
    const study = live.study;
    name.textContent = study ? study.file.split("/").at(-1)! : "Study";
    const same = text.value === study?.text;
    save.disabled = !study?.writable || same;
    undo.disabled = same;
    message.textContent = study && !study.writable ? "An example study: changes cannot be saved. Start `armill serve` in your own folder to save." : same ? "" : "Unsaved changes.";
  };
  text.addEventListener("input", () => live.edit(text.value));
  text.addEventListener("scroll", () => void (lines.scrollTop = text.scrollTop));
  save.addEventListener("click", () => void saved());
  const saved = async () => {
    const before = live.study;
    await store();
    if (live.study !== before && !live.unsaved) message.textContent = "Saved.";
  };
  undo.addEventListener("click", () => live.discard());
  live.listen(["text", "answer"], () => {
    if (shown && followed !== live.text) follow();
  });
  live.listen(["study"], () => shown && buttons());
  const root = h("div", { class: "page study-page" }, h("header", { class: "page-head" }, name, message, undo, save), h("div", { class: "both" }, h("div", { class: "editor" }, lines, text), fields.root), problems);
  return {
    id: "study",
    reveal: (table) => fields.reveal(table),
    title: "Study",
    root,
    shown: () => {
      shown = true;
      follow();
    },
    left: () => {
      shown = false;
      // Its analyses are known when it has been checked.
      if (checked) live.showEdited(checked.analyses);
      else void api.check(live.text).then((answer) => live.showEdited(answer.analyses), () => live.showEdited([]));
    },
  };
}

/** Where two texts begin to differ; null if they are equal. */
function firstDifference(a: string, b: string): number | null {
  if (a === b) return null;
  let at = 0;
  while (at < a.length && a[at] === b[at]) at++;
  return at;
}
