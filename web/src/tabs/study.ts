// The study as text and as fields: checked while it is typed, saved with its comments.

import { api, Refused } from "../server";
import { fill, h } from "../dom";
import type { Live } from "../live";
import { Newest } from "../newest";
import { Fields } from "../tables/fields";
import type { Checked, Problem, Tables } from "../types";
import type { Tab } from "./tab";

export function studyTab(live: Live): Tab & { reveal: (table: string) => void } {
  const lines = h("div", { class: "lines", "aria-hidden": "true" });
  const text = h("textarea", { id: "study-text", spellcheck: "false", wrap: "off", "aria-label": "Study file, TOML", "aria-describedby": "study-problems" });
  const problems = h("div", { class: "problems", id: "study-problems", role: "status" });
  const save = h("button", { type: "button", class: "primary" }, "Save");
  const undo = h("button", { type: "button", class: "quiet" }, "Discard changes");
  const name = h("h1", {});
  const message = h("p", { class: "note", role: "status" });
  let checked: Checked | null = null;

  const number = (marked: Problem[]) => {
    const count = text.value.split("\n").length;
    const at = new Map(marked.filter((p) => p.line !== null).map((p) => [p.line!, p.message]));
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
            h("ul", {}, list.map((p) => h("li", {}, h("button", { type: "button", class: "link", onclick: () => jump(p) }, p.line === null ? "study" : `line ${p.line}${p.column === null ? "" : `, column ${p.column}`}`), " ", p.message, p.hint ? h("span", { class: "hint" }, p.hint) : null))),
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
        text.value = made.text;
        edited();
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
  const edited = () => {
    checked = null;
    buttons();
    number([]);
    checks.submit(text.value);
  };
  const buttons = () => {
    const study = live.study;
    name.textContent = study ? study.file.split("/").at(-1)! : "Study";
    const same = text.value === study?.text;
    save.disabled = !study?.writable || same;
    undo.disabled = same;
    message.textContent = study && !study.writable ? "An example study: changes cannot be saved. Start `armill serve` in your own folder to save." : same ? "" : "Unsaved changes.";
  };
  const store = async () => {
    try {
      const study = await api.save(text.value, live.study!.version);
      live.study = study;
      live.use(study.text, study.analyses);
      buttons();
      message.textContent = "Saved.";
    } catch (error) {
      if (error instanceof Refused && error.kind === "conflict") return conflict(error.message);
      if (error instanceof Refused && error.problems.length > 0) showProblems(error.problems);
      message.textContent = error instanceof Error ? error.message : String(error);
    }
  };
  const conflict = (why: string) => {
    const theirs = h("button", { type: "button", class: "link", onclick: () => void reload() }, "Load the file");
    const mine = h("button", { type: "button", class: "link", onclick: () => void overwrite() }, "Overwrite the file");
    fill(message, `${why} `, theirs, " or ", mine);
  };
  const reload = async () => {
    live.open(await api.study());
    text.value = live.text;
    edited();
  };
  const overwrite = async () => {
    live.study = { ...live.study!, version: (await api.study()).version };
    await store();
  };

  text.addEventListener("input", edited);
  text.addEventListener("scroll", () => void (lines.scrollTop = text.scrollTop));
  text.addEventListener("keydown", (e) => {
    if (e.key === "s" && (e.ctrlKey || e.metaKey)) {
      e.preventDefault();
      if (!save.disabled) void store();
    }
  });
  save.addEventListener("click", () => void store());
  undo.addEventListener("click", () => {
    text.value = live.study?.text ?? "";
    edited();
  });
  const root = h("div", { class: "page study-page" }, h("header", { class: "page-head" }, name, message, undo, save), h("div", { class: "both" }, h("div", { class: "editor" }, lines, text), fields.root), problems);
  return {
    id: "study",
    reveal: (table) => fields.reveal(table),
    title: "Study",
    root,
    shown: () => {
      if (text.value !== live.text) text.value = live.text;
      edited();
    },
    // A text without problems is used by the live view.
    left: () => {
      if (text.value !== live.text && checked && checked.problems.length === 0) live.use(text.value, checked.analyses);
    },
  };
}
