// Undo, merging and drafts: nothing typed is lost.

import { describe, expect, test } from "vitest";
import { Drafts, type Draft } from "../../src/changes/drafts";
import { History, type Step } from "../../src/changes/history";
import { merge } from "../../src/changes/merge";

const step = (text: string, analysis = "map", section = 0): Step => ({ text, analyses: [], analysis, section });

describe("undo", () => {
  test("every change is a step, back and forth", () => {
    const history = new History();
    for (const text of ["a", "b", "c"]) history.record(step(text), null, 0);
    expect(history.undo()?.text).toBe("b");
    expect(history.undo()?.text).toBe("a");
    expect(history.undo()).toBeNull();
    expect([history.canUndo, history.canRedo]).toEqual([false, true]);
    expect(history.redo()?.text).toBe("b");
    // A new change: what was undone is gone.
    history.record(step("d"), null, 0);
    expect(history.redo()).toBeNull();
    expect(history.undo()?.text).toBe("b");
  });

  test("quick values of one control are one step; pauses and other controls begin another", () => {
    const history = new History();
    history.record(step("0"), null, 0);
    for (let k = 1; k <= 9; k++) history.record(step(`x${k}`), "x", 100 * k);
    history.record(step("x10"), "x", 5000);
    history.record(step("y1"), "y", 5050);
    expect(history.undo()?.text).toBe("x10");
    expect(history.undo()?.text).toBe("x9");
    expect(history.undo()?.text).toBe("0");
    // After an undo the same control begins a step.
    history.record(step("x1"), "x", 5100);
    expect(history.undo()?.text).toBe("0");
  });

  test("the analysis and the section are undone, an answer without a change is no step", () => {
    const history = new History();
    history.record(step("t"), null, 0);
    history.record(step("t"), null, 1);
    expect(history.canUndo).toBe(false);
    history.record(step("t", "path"), "analysis", 2);
    history.record(step("t", "path", 1), "section", 3);
    expect(history.undo()).toMatchObject({ analysis: "path", section: 0 });
    expect(history.undo()).toMatchObject({ analysis: "map" });
  });

  test("memory is bounded, the newest steps stay", () => {
    const history = new History();
    for (let k = 0; k < 1000; k++) history.record(step(String(k)), null, 0);
    let back = 0;
    while (history.undo()) back++;
    expect(back).toBe(300);
    for (let k = 0; k < 9; k++) history.record(step(String(k) + "x".repeat(3_999_000)), null, 0);
    for (back = 0; history.undo(); ) back++;
    expect(back).toBe(5);
  });
});

describe("merge", () => {
  const base = ["one", "two", "three", "four", "five", "six"].join("\n");
  const changed = (at: number, ...lines: string[]) => base.split("\n").toSpliced(at, 1, ...lines).join("\n");

  test("changes of different lines are both made", () => {
    expect(merge(base, changed(0, "ONE"), changed(5, "SIX"))).toBe(["ONE", "two", "three", "four", "five", "SIX"].join("\n"));
    expect(merge(base, changed(1), changed(3, "4", "4b"))).toBe(["one", "three", "4", "4b", "five", "six"].join("\n"));
    expect(merge(base, `${base}\nseven`, `zero\n${base}`)).toBe(`zero\n${base}\nseven`);
  });

  test("one changed side, and the same change of both", () => {
    expect(merge(base, base, changed(2, "x"))).toBe(changed(2, "x"));
    expect(merge(base, changed(2, "x"), base)).toBe(changed(2, "x"));
    expect(merge(base, changed(2, "x"), changed(2, "x"))).toBe(changed(2, "x"));
    const both = changed(0, "ONE").replace("four", "FOUR");
    expect(merge(base, both.replace("six", "SIX"), both)).toBe(both.replace("six", "SIX"));
  });

  test("the same line changed differently is not merged, nor are adjacent ones", () => {
    expect(merge(base, changed(2, "mine"), changed(2, "theirs"))).toBeNull();
    expect(merge(base, changed(2, "mine"), changed(3, "theirs"))).toBeNull();
    expect(merge(base, changed(2), changed(2, "theirs"))).toBeNull();
    expect(merge(base, `${base}\nmine`, `${base}\ntheirs`)).toBeNull();
  });

  test("any merge contains every change once", () => {
    const lines = Array.from({ length: 40 }, (_, k) => `line ${k % 7}`);
    for (let a = 0; a < 40; a += 3)
      for (let b = 0; b < 40; b += 3) {
        if (Math.abs(a - b) < 2) continue;
        const mine = lines.toSpliced(a, 1, "mine").join("\n");
        const theirs = lines.toSpliced(b, 1, "theirs").join("\n");
        const expected = [...lines];
        [expected[a], expected[b]] = ["mine", "theirs"];
        expect(merge(lines.join("\n"), mine, theirs)).toBe(expected.join("\n"));
      }
  });
});

describe("drafts", () => {
  class Store {
    readonly map = new Map<string, string>();
    room = Infinity;
    get length() {
      return this.map.size;
    }
    key = (i: number) => [...this.map.keys()][i] ?? null;
    getItem = (name: string) => this.map.get(name) ?? null;
    removeItem = (name: string) => void this.map.delete(name);
    setItem = (name: string, value: string) => {
      if (value.length > this.room) throw new Error("full");
      this.map.set(name, value);
    };
  }
  const draft = (text: string, at_ms = 0): Draft => ({ text, changes: [], analysis: null, base: "", version: "1", at_ms });

  test("each tab and each study has its own; a new tab finds the newest that is left", () => {
    const store = new Store();
    const of = (tab: string, study = "/cell/study.toml") => new Drafts(store, study, tab);
    of("a").keep(draft("from a", 1));
    of("b").keep(draft("from b", 2));
    of("b", "/other/study.toml").keep(draft("other", 9));
    expect(of("a").of("a")?.text).toBe("from a");
    expect(of("c").newest(new Set())).toMatchObject({ tab: "b", draft: { text: "from b" } });
    expect(of("c").newest(new Set(["b"]))).toMatchObject({ tab: "a" });
    of("c").forget("a");
    expect(of("c").newest(new Set(["b"]))).toBeNull();
  });

  test("a full or damaged store is no error", () => {
    const store = new Store();
    const drafts = new Drafts(store, "study", "a");
    store.room = 10;
    expect(drafts.keep(draft("long"))).toBe(false);
    store.room = Infinity;
    expect(drafts.keep(draft("long"))).toBe(true);
    store.map.set([...store.map.keys()][0]!, "{");
    expect(drafts.of("a")).toBeNull();
    store.map.set([...store.map.keys()][0]!, '{"text": 3}');
    expect(drafts.of("a")).toBeNull();
  });
});
