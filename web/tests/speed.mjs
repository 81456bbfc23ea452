// How long from an input to its picture: 101 x 101 points, 4 load cases, the branch that the study names. Env ARMILL_BIN:
// a release build of armill, with the page in it. Changes follow one another as soon as the last is on the screen. Chromium is as it comes: without a graphics card the processor draws WebGL (SwiftShader) and
// all else, and then `shown` is mostly that.
//
// | row | from - to |
// |---|---|
// | answered | from the request of the page to its text; server alone (Server-Timing) |
// | parse, draw | JSON to values; values to colours, lines, arm, panels |
// | submitted | the input, to the end of the page's work: all commands are with WebGL |
// | shown | the input, to the picture on the screen (Display::FrameDisplayed in Chromium's own trace) |
// | CPU | what each process computed for one change, whatever else the machine does |

import { readFileSync } from "node:fs";
import { loadavg } from "node:os";
import { client, launch, open, serve } from "./e2e/setup.mjs";

const CHANGES = 120;
/** They warm the page up. */
const FIRST = 10;
const STUDY = `format = 1
robot = "yaskawa/mh12"
tolerance_um = 50
plane = { centre_mm = [800, 0, 1000], half_size_mm = 500, step_mm = 10 }
load = { cases_n = [[3, 5, 5], [3, -5, 5], [3, 5, -5], [3, -5, -5]] }
posture = { branch = "front elbow-up no-flip" }
`;

const at = (list, share) => [...list].sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(share * list.length))];
const row = (name, list) => console.log(`${name.padEnd(28)} ${at(list, 0.5).toFixed(1).padStart(7)} ${at(list, 0.95).toFixed(1).padStart(7)} ms`);
/** CPU time of a process, ms; Linux counts in hundredths of a second. */
const spent = (pid) => {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return 10 * (Number(fields[11]) + Number(fields[12]));
};

const server = await serve(() => STUDY);
const browser = await launch();
try {
  // The server alone, as a program requests it.
  const request = client(server.url);
  const alone = [];
  let size = 0;
  for (let i = 0; i < CHANGES; i++) {
    const begun = performance.now();
    const view = await request("POST", "/api/view", { text: STUDY, analysis: null, changes: [{ key: "plane.centre_mm", value: [800 + i, 0, 1000] }], arm: { follow: "worst" }, lines: true });
    alone.push(performance.now() - begun);
    size = JSON.stringify(view).length;
    if (view.answer.maps[0].grid.points !== 101 * 101) throw new Error(`${view.answer.maps[0].grid.points} points`);
  }
  const page = await open(browser, server.url);
  const renderer = await page.evaluate(() => {
    const gl = document.querySelector(".stage canvas").getContext("webgl2");
    return gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
  });
  // The page turns its own control, so that no message of the test is between input and answer.
  const change = () =>
    page.evaluate(async () => {
      performance.clearMeasures();
      performance.clearResourceTimings();
      const drawn = new Promise((done) => new PerformanceObserver((list, observer) => list.getEntriesByName("armill:picture").length > 0 && (observer.disconnect(), done())).observe({ entryTypes: ["measure"] }));
      document.querySelector("#field-x").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowUp", bubbles: true, cancelable: true }));
      await drawn;
      const of = (name) => performance.getEntriesByName(`armill:${name}`)[0].duration;
      const requests = performance.getEntriesByType("resource").filter((e) => e.name.endsWith("/api/view"));
      const times = { answered: of("answer"), server: requests[0].serverTiming[0].duration, parse: of("parse"), draw: of("draw"), submitted: of("submitted"), questions: requests.length };
      // Until it is on the screen.
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      return times;
    });
  for (let i = 0; i < FIRST; i++) await change();

  const found = { answered: [], server: [], parse: [], draw: [], submitted: [] };
  const system = await browser.newBrowserCDPSession();
  const cpu = async () => {
    const { processInfo } = await system.send("SystemInfo.getProcessInfo");
    const of = (type) => 1e3 * processInfo.filter((p) => p.type === type).reduce((sum, p) => sum + p.cpuTime, 0);
    return { server: spent(server.pid), page: of("renderer"), "WebGL and screen": of("GPU"), browser: of("browser") };
  };
  const before = await cpu();
  for (let i = 0; i < CHANGES / 2; i++) await change();
  const after = await cpu();

  await browser.startTracing(page, { categories: ["blink.user_timing", "benchmark"] });
  for (let i = 0; i < CHANGES; i++) {
    const { questions, ...times } = await change();
    if (questions !== 1) throw new Error(`${questions} questions for one change`);
    for (const [name, value] of Object.entries(times)) found[name].push(value);
  }
  const { traceEvents } = JSON.parse(await browser.stopTracing());
  const events = (name, kind) => traceEvents.filter((e) => e.name === name && e.ph === kind).map((e) => e.ts).sort((a, b) => a - b);
  const [inputs, ends, screens] = [events("armill:picture", "b"), events("armill:picture", "e"), events("Display::FrameDisplayed", "I")];
  const shown = inputs.map((input, i) => (screens.find((ts) => ts >= ends[i]) - input) / 1e3);

  console.log(`101 x 101 points, 4 cases, ${CHANGES} changes, one question each; answer ${(size / 1e3).toFixed(0)} kB; WebGL by ${renderer}; load of the machine ${loadavg()[0].toFixed(1)}`);
  console.log(`CPU of one change: ${Object.entries(after).map(([name, ms]) => `${name} ${((ms - before[name]) / (CHANGES / 2)).toFixed(1)} ms`).join(", ")}`);
  console.log(`${"".padEnd(28)}  median     p95`);
  row("server, requested by a program", alone);
  for (const [name, list] of Object.entries(found)) row(name, list);
  row("shown", shown.filter(Number.isFinite));
} finally {
  await browser.close();
  await server.stop();
}
