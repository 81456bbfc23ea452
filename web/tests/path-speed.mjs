// Work of the page on a long path: hovering in the scene and over the charts, scrubbing, turning the camera. Env ARMILL_BIN: a release
// build of armill with the page in it, or ARMILL_PAGE as in the other tests. Env ARMILL_SAMPLES: the folder with boss.apt, which
// becomes 244 804 points; its first argument is a step in mm (0.25: about a million points), its second a number of changes
// after which the memory is compared.
//
// | row | processor time of the main thread of the page, sum of all tasks between two frames |
// |---|---|
// | hover | the pointer moves over the path in the scene |
// | charts | the pointer moves over the charts |
// | scrub | the pointer is dragged over the charts: marker, robot and panels follow |
// | turn | the camera turns: the line is chosen anew for every frame |

import { cpSync } from "node:fs";
import { loadavg } from "node:os";
import { join } from "node:path";
import { client, launch, open, serve, settled } from "./e2e/setup.mjs";
import { heapAfterGc } from "./e2e/memory.mjs";

const [step, changes] = [Number(process.argv[2] ?? 0), Number(process.argv[3] ?? 0)];
const MOVES = 120;
const STUDY = `format = 1
title = "Boss of 244 804 points"
robot = "kuka/kr120r2500pro"
tolerance_um = 15
compliance = { class = "heavy" }
tool = { flange_from_tool_mm_deg = [0, 0, 200, 0, 0, 0] }
plane = { centre_mm = [1400, 0, 900], tilt_deg = 90, half_size_mm = 100, step_mm = 20 }
cut = { material = "aluminium-6082-t6", cutter = { diameter_mm = 6, flutes = 2 }, axial_depth_mm = 1, radial_depth_mm = 1.5, side = "down" }
[[analysis]]
kind = "path"
name = "boss"
program = { file = "boss.apt"${step > 0 ? `, step_mm = ${step}` : ""} }
`;

const at = (list, share) => [...list].sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(share * list.length))];
const row = (name, list) => console.log(`${name.padEnd(30)} ${at(list, 0.5).toFixed(1).padStart(7)} ${at(list, 0.95).toFixed(1).padStart(7)} ${Math.max(...list).toFixed(1).padStart(7)} ms, ${list.length} frames`);

/** Work of the page's main thread between frames while `act` runs: its processor time, without waiting for WebGL, ms. */
async function frames(browser, page, act) {
  await browser.startTracing(page, { categories: ["toplevel", "disabled-by-default-devtools.timeline.frame"] });
  await act();
  const { traceEvents } = JSON.parse(await browser.stopTracing());
  const begins = traceEvents.filter((e) => e.name === "BeginMainThreadFrame");
  const count = new Map();
  for (const { pid, tid } of begins) count.set(`${pid} ${tid}`, (count.get(`${pid} ${tid}`) ?? 0) + 1);
  const [thread] = [...count].sort((a, b) => b[1] - a[1])[0];
  const starts = begins.filter((e) => `${e.pid} ${e.tid}` === thread).map((e) => e.ts).sort((a, b) => a - b);
  const tasks = traceEvents.filter((e) => `${e.pid} ${e.tid}` === thread && e.ph === "X" && /RunTask$/.test(e.name));
  return starts.slice(0, -1).map((start, i) => tasks.filter((e) => e.ts >= start && e.ts < starts[i + 1]).reduce((sum, e) => sum + (e.tdur ?? e.dur), 0) / 1e3);
}
const next = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(done)));
const measures = (page, name) => page.evaluate((name) => performance.getEntriesByName(name).map((e) => e.duration), `armill:${name}`);

const server = await serve(() => STUDY);
cpSync(join(process.env.ARMILL_SAMPLES, "toolpaths/apt/parts-tools/boss.apt"), join(server.folder, "boss.apt"));
const browser = await launch();
try {
  const request = client(server.url);
  const { path } = await request("POST", "/api/view", { text: STUDY, analysis: "boss", columns: true });
  const page = await open(browser, server.url);
  await page.waitForFunction(() => document.querySelectorAll(".charts .strip").length > 2 && document.querySelectorAll(".charts .strip.waits").length === 0, null, { timeout: 120_000 });
  const renderer = await page.evaluate(() => {
    const gl = document.querySelector(".stage canvas").getContext("webgl2");
    return gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
  });
  console.log(`${path.points} points; WebGL by ${renderer}; load of the machine ${loadavg()[0].toFixed(1)}`);
  const transfers = await page.evaluate(() => performance.getEntriesByType("resource").filter((e) => /path-columns|view/.test(e.name)).map((e) => `${e.name.split("/").pop()} ${(e.decodedBodySize / 1e6).toFixed(2)} MB in ${e.duration.toFixed(0)} ms`));
  console.log(transfers.join("; "));
  console.log(`${"work of a frame".padEnd(30)}  median     p95     max`);
  const stage = await page.locator(".stage").boundingBox();
  const charts = await page.locator(".charts canvas").first().boundingBox();
  await page.click(".views button:nth-child(5)");
  await page.waitForTimeout(1000);
  const moves = (box, rows) => async () => {
    for (let i = 0; i < MOVES; i++) {
      const t = i / MOVES;
      await page.mouse.move(box.x + box.width * (0.3 + 0.4 * t), box.y + box.height * (0.5 + rows * Math.sin(9 * t)));
      await next(page);
    }
  };
  row("hover", await frames(browser, page, moves(stage, 0.2)));
  row("charts", await frames(browser, page, moves(charts, 0.1)));
  row("scrub", await frames(browser, page, async () => {
    await page.mouse.move(charts.x + 0.3 * charts.width, charts.y + 20);
    await page.mouse.down();
    await moves(charts, 0.1)();
    await page.mouse.up();
  }));
  await settled(page);
  row("turn", await frames(browser, page, async () => {
    await page.mouse.move(stage.x + 0.5 * stage.width, stage.y + 0.4 * stage.height);
    await page.mouse.down();
    for (let i = 0; i < 40; i++) {
      await page.mouse.move(stage.x + stage.width * (0.5 + 0.004 * i), stage.y + 0.4 * stage.height);
      await next(page);
    }
    await page.mouse.up();
  }));
  for (const name of ["hover", "strip-hover", "scrub", "strips", "path"]) {
    const found = await measures(page, name);
    if (found.length > 0) row(`  of it, armill:${name}`, found);
  }
  if (changes > 0) {
    const heap = [];
    const every = Math.max(1, Math.floor(changes / 10));
    for (let i = 0; i < changes; i++) {
      await page.evaluate(async () => {
        const drawn = new Promise((done) => new PerformanceObserver((list, observer) => list.getEntriesByName("armill:picture").length > 0 && (observer.disconnect(), done())).observe({ entryTypes: ["measure"] }));
        document.querySelector("#field-x").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowUp", bubbles: true, cancelable: true }));
        await drawn;
        performance.clearMeasures();
        performance.clearResourceTimings();
      });
      if ((i + 1) % every === 0) {
        heap.push(await heapAfterGc(page));
        console.log(`after ${i + 1} changes: heap ${heap.at(-1).toFixed(1)} MB`);
      }
    }
  }
} finally {
  await browser.close();
  await server.stop();
}
