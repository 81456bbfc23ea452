// All tables of a study as fields next to its text: a value changed here is changed in the text, and comments are kept;
// a problem is shown at its field. Entries of lists of tables can be added and removed.

import { fill, h, type Child } from "../dom";
import { problemWords } from "../problem-words";
import type { Problem, Tables } from "../types";
import { input, type Input } from "./inputs";
import { beginning, fieldsOf, named, type Field, type Schema } from "./schema";

/** Usual order of tables; others follow. */
const FIRST = ["place", "posture", "tool", "load", "cut", "plane", "analysis"];

export class Fields {
  readonly root = h("form", { class: "fields", "aria-label": "Tables of the study", onsubmit: (e: Event) => e.preventDefault() });
  private fields: Field[] = [];
  private readonly open = new Set<string>();
  private inputs = new Map<string, Input>();
  private tables: Tables | null = null;
  /** What gets the focus once the text has changed: the begin of its data-key. */
  private focus: string | null = null;

  /** `changed`: whether the text could be changed. */
  constructor(private readonly changed: (path: string, value: unknown) => Promise<boolean>) {}

  learn(schema: Schema): void {
    const place = (f: Field) => (FIRST.indexOf(f.key) + FIRST.length + 1) % (FIRST.length + 1);
    this.fields = fieldsOf(schema, schema).sort((a, b) => place(a) - place(b));
    this.draw();
  }

  show(tables: Tables): void {
    this.tables = tables;
    this.draw();
    if (this.focus === null) return;
    const target = this.root.querySelector<HTMLElement>(`[data-key^="${CSS.escape(this.focus)}"]`);
    this.focus = null;
    target?.scrollIntoView({ block: "nearest" });
    target?.focus({ preventScroll: true });
  }

  /** Unfolds a table and shows it. */
  reveal(path: string): void {
    this.open.add(path);
    this.draw();
    this.root.querySelector(`[data-table="${CSS.escape(path)}"]`)?.scrollIntoView({ block: "start" });
  }

  private draw(): void {
    const values = this.tables?.values as Record<string, unknown> | null | undefined;
    this.inputs = new Map();
    if (!values) return fill(this.root, h("p", { class: "note" }, this.tables ? "The text is not valid TOML: fields are shown when this is corrected." : ""));
    const top = this.fields.filter((f) => f.kind.of !== "table" && f.kind.of !== "tables");
    const rest = this.fields.filter((f) => !top.includes(f));
    fill(this.root, this.fold("", "study", "Settings of the whole study.", () => this.rows(top, "", values), Object.keys(values).length > 0), ...rest.map((f) => this.child(f, f.key, values[f.key])));
    this.mark();
  }

  private rows(fields: Field[], path: string, values: Record<string, unknown>): Child[] {
    return fields.map((f) => {
      const at = path === "" ? f.key : `${path}.${f.key}`;
      if (f.kind.of === "table" || f.kind.of === "tables") return this.child(f, at, values[f.key]);
      const made = input(at, f, values[f.key], (value) => void this.changed(at, value));
      this.inputs.set(at, made);
      return made.root;
    });
  }

  private child(field: Field, path: string, value: unknown): Child {
    const fields = field.kind.of === "table" || field.kind.of === "tables" ? field.kind.fields : [];
    const table = (at: string, title: string, of: unknown, ...more: Child[]) => {
      const values = typeof of === "object" && of !== null && !Array.isArray(of) ? (of as Record<string, unknown>) : {};
      return this.fold(at, title, field.about, () => [...this.rows(fields, at, values), ...more], of !== undefined);
    };
    const { name } = named(field.key);
    if (field.kind.of === "table") return table(path, name, value);
    const entries = Array.isArray(value) ? value : [];
    const tables = entries.map((entry: unknown, i) => {
      const own = typeof entry === "object" && entry !== null && "name" in entry && entry.name !== "" ? String(entry.name) : String(i + 1);
      return table(`${path}[${i}]`, `${name}: ${own}`, entry, this.button(`remove ${path}[${i}]`, `Remove ${name}: ${own}`, () => this.remove(path, i)));
    });
    return [...tables, this.button(`add ${path}`, `Add ${name}`, () => this.add(path, entries.length, fields))];
  }

  private button(key: string, text: string, pressed: () => Promise<boolean>): Child {
    const button = h("button", { type: "button", class: "quiet small entry-button", "data-key": key }, text);
    // Once only: afterwards the index belongs to another entry.
    button.addEventListener("click", () => {
      button.disabled = true;
      void pressed().then((made) => {
        button.disabled = made;
        if (!made) this.focus = null;
      });
    });
    return button;
  }

  private async add(path: string, count: number, fields: Field[]): Promise<boolean> {
    const at = `${path}[${count}]`;
    this.open.add(at);
    this.focus = `${at}.`;
    return this.changed(at, beginning(fields));
  }

  private async remove(path: string, index: number): Promise<boolean> {
    this.focus = `add ${path}`;
    const made = await this.changed(`${path}[${index}]`, null);
    if (made) this.openAfter(path, index);
    return made;
  }

  /** Entries behind one that went have moved up, and are as open as they were. */
  private openAfter(path: string, index: number): void {
    const open = [...this.open].flatMap((at) => {
      const inside = at.startsWith(`${path}[`) ? /^\[(\d+)\](.*)$/.exec(at.slice(path.length)) : null;
      if (!inside || Number(inside[1]) < index) return [at];
      return Number(inside[1]) === index ? [] : [`${path}[${Number(inside[1]) - 1}]${inside[2]}`];
    });
    this.open.clear();
    open.forEach((at) => this.open.add(at));
  }

  /** A table that unfolds; what is inside is made when it does. `there`: the text has it. */
  private fold(path: string, title: string, about: string, rows: () => Child[], there: boolean): Child {
    const body = h("div", { class: "fold-body" });
    const make = () => fill(body, h("p", { class: "note" }, about), ...rows());
    const root = h("details", { class: there ? "fold there" : "fold", open: this.open.has(path), "data-table": path }, h("summary", { "data-key": `fold ${path}` }, title, there ? null : h("small", {}, " not in the study")), body);
    if (this.open.has(path)) make();
    root.addEventListener("toggle", () => {
      if (root.open === this.open.has(path)) return;
      if (root.open) {
        this.open.add(path);
        make();
        this.mark();
      } else this.open.delete(path);
    });
    return root;
  }

  /** Each problem at the field of its value or path; collapsed tables that contain one are marked. */
  private mark(): void {
    this.root.querySelectorAll(".fold.wrong").forEach((e) => e.classList.remove("wrong"));
    for (const problem of this.tables?.problems ?? []) {
      const path = this.pathOf(problem);
      if (path === null) continue;
      this.inputs.get(path)?.refuse(problemWords(problem.message).what, problem.hint);
      this.root.querySelectorAll<HTMLElement>(".fold").forEach((fold) => {
        const table = fold.dataset.table!;
        if (table === "" ? !/[.[]/.test(path) : path === table || path.startsWith(`${table}.`) || path.startsWith(`${table}[`)) fold.classList.add("wrong");
      });
    }
  }

  private pathOf(problem: Problem): string | null {
    const { start } = problem.span;
    const on = this.tables!.places.filter((p) => p.bytes[0] <= start && start < p.bytes[1]).sort((a, b) => a.bytes[1] - a.bytes[0] - (b.bytes[1] - b.bytes[0]))[0];
    if (on) return on.path;
    return [...this.inputs.keys()].filter((path) => problem.message.includes(`\`${path}\``)).sort((a, b) => b.length - a.length)[0] ?? null;
  }
}
