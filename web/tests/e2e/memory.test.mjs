// Memory stays flat while values change: a path of 6000 points, whose columns are replaced with every answer. `npm run path-speed`
// does the same with boss.apt and any number of changes.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { test } from "node:test";
import { heapAfterGc } from "./memory.mjs";
import { client, launch, open, serve } from "./setup.mjs";

/** Env CHANGES: more of them. */
const CHANGES = Number(process.env.CHANGES ?? 200);
/** They fill what is kept: steps of undo, compiled functions. */
const FIRST = 60;
/** The columns, the tree, the charts and the buffers of one answer have about 1 MB. */
const MOST_GROWTH_MB = 8;
const STUDY = `format = 1
robot = "yaskawa/mh12"
tolerance_um = 50
load = { cases_n = [[3, 5, 5]] }
plane = { centre_mm = [1000, 50, 800], half_size_mm = 100, step_mm = 20 }
[[analysis]]
kind = "path"
name = "slot"
program = { file = "slot.csv", step_mm = 0.01 }
`;

test(`memory after ${CHANGES} changes of a path of 6000 points is that after ${FIRST}`, async () => {
  const server = await serve(() => STUDY);
  writeFileSync(`${server.folder}/slot.csv`, "x_mm,y_mm,z_mm\n0,0,0\n60,0,0\n");
  const { path } = await client(server.url)("POST", "/api/view", { text: STUDY, analysis: "slot", columns: true });
  assert.ok(path.points > 6000);
  const browser = await launch();
  const page = await open(browser, server.url);
  const change = (key) =>
    page.evaluate(async (key) => {
      const drawn = new Promise((done) => new PerformanceObserver((list, observer) => list.getEntriesByName("armill:picture").length > 0 && (observer.disconnect(), done())).observe({ entryTypes: ["measure"] }));
      document.querySelector("#field-x").dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
      await drawn;
      performance.clearMeasures();
      performance.clearResourceTimings();
    }, key);
  let before = 0;
  for (let i = 0; i < CHANGES; i++) {
    if (i === FIRST) before = await heapAfterGc(page);
    await change(i % 2 === 0 ? "ArrowUp" : "ArrowDown");
  }
  const after = await heapAfterGc(page);
  console.log(`${before.toFixed(1)} MB after ${FIRST} changes, ${after.toFixed(1)} MB after ${CHANGES}`);
  assert.ok(after - before < MOST_GROWTH_MB, `${before.toFixed(1)} MB, then ${after.toFixed(1)} MB`);
  assert.deepEqual(page.complaints, []);
  await browser.close();
  await server.stop();
});
