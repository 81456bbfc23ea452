// How long from an input to its picture: 101 x 101 points, 4 load cases, the branch that the study names. Env ARMILL_BIN:
// a release build of armill; ARMILL_PAGE=dist: the page of this folder, over a proxy. Without a graphics card Chromium
// draws with SwiftShader on the processor; that part is told for itself.
//
// | column | from - to |
// |---|---|
// | picture | the input, to the frame that shows its map |
// | server | the question is read, to the answer is written (Server-Timing) |
// | network | the page asks, to it has the text, without the server |
// | parse, draw | JSON to values; values to colours, lines, panels |
// | frame | the rest: the browser's own frame, styles, WebGL handed over |
// | CPU | what each process computed for one change, whatever else the machine does: server, page, WebGL |
// | GL | what WebGL still computes when the frame is handed over (a pixel is read back, which waits for it) |

import { readFileSync } from "node:fs";
import { client, launch, open, serve, settled } from "./e2e/setup.mjs";

const CHANGES = 50;
const STUDY = `format = 1
robot = "yaskawa/mh12"
limit_um = 50
plane = { centre_mm = [800, 0, 1000], half_size_mm = 500, step_mm = 10 }
load = { cases_n = [[3, 5, 5], [3, -5, 5], [3, 5, -5], [3, -5, -5]] }
posture = { branch = "front elbow-up no-flip" }
`;

const middle = (list, share) => [...list].sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(share * list.length))];
/** CPU time of a process, ms; Linux counts in hundredths of a second. */
const spent = (pid) => {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return 10 * (Number(fields[11]) + Number(fields[12]));
};
const row = (name, list) => console.log(`${name.padEnd(22)} ${middle(list, 0.5).toFixed(1).padStart(7)} ${middle(list, 0.95).toFixed(1).padStart(7)} ms`);

const server = await serve(() => STUDY);
const browser = await launch();
try {
  // The server alone, as a program asks it.
  const ask = client(server.url);
  const alone = [];
  let size = 0;
  for (let i = 0; i < CHANGES; i++) {
    const begun = performance.now();
    const view = await ask("POST", "/api/view", { text: STUDY, ask: null, changes: [{ key: "plane.centre_mm", value: [800 + i, 0, 1000] }] });
    alone.push(performance.now() - begun);
    size = JSON.stringify(view).length;
    if (view.answer.maps[0].grid.points !== 101 * 101) throw new Error(`${view.answer.maps[0].grid.points} points`);
  }
  const page = await open(browser, server.url);
  const system = await browser.newBrowserCDPSession();
  const cpu = async () => {
    const { processInfo } = await system.send("SystemInfo.getProcessInfo");
    const of = (type) => 1e3 * processInfo.filter((p) => p.type === type).reduce((sum, p) => sum + p.cpuTime, 0);
    return { server: spent(server.pid), page: of("renderer"), WebGL: of("GPU") };
  };
  const renderer = await page.evaluate(() => {
    const gl = document.querySelector(".stage canvas").getContext("webgl2");
    const told = gl.getExtension("WEBGL_debug_renderer_info");
    return gl.getParameter(told?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
  });
  await page.locator("#field-x").focus();
  const found = { picture: [], server: [], network: [], parse: [], draw: [], frame: [], gl: [] };
  let before = await cpu();
  for (let i = 0; i < CHANGES + 5; i++) {
    if (i === 5) before = await cpu();
    await page.evaluate(() => {
      performance.clearMeasures();
      performance.clearResourceTimings();
      const gl = document.querySelector(".stage canvas").getContext("webgl2");
      window.drawn = new Promise((done) => {
        new PerformanceObserver((list, observer) => {
          if (!list.getEntriesByName("armill:picture").length) return;
          observer.disconnect();
          const begun = performance.now();
          gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
          done(performance.now() - begun);
        }).observe({ entryTypes: ["measure"] });
      });
    });
    await page.keyboard.press("ArrowUp");
    const times = await page.evaluate(async () => {
      const gl = await window.drawn;
      const of = (name) => performance.getEntriesByName(`armill:${name}`)[0].duration;
      const asked = performance.getEntriesByType("resource").find((e) => e.name.endsWith("/api/view"));
      return { picture: of("picture"), answer: of("answer"), server: asked.serverTiming[0].duration, parse: of("parse"), draw: of("draw"), gl };
    });
    await settled(page);
    // The first few warm the page up.
    if (i < 5) continue;
    const { picture, answer, server: own, parse, draw, gl } = times;
    for (const [name, value] of Object.entries({ picture, server: own, network: answer - own, parse, draw, frame: picture - answer - parse - draw, gl })) found[name].push(value);
  }
  console.log(`101 x 101 points, 4 cases, ${CHANGES} changes; answer ${(size / 1e3).toFixed(0)} kB; WebGL by ${renderer}`);
  const after = await cpu();
  console.log(`CPU of one change with its arm: ${Object.entries(after).map(([name, ms]) => `${name} ${((ms - before[name]) / CHANGES).toFixed(1)} ms`).join(", ")}`);
  console.log(`${"".padEnd(22)}  median     p95`);
  row("server, program asks", alone);
  for (const [name, list] of Object.entries(found)) row(name === "gl" ? "GL behind the frame" : name, list);
} finally {
  await browser.close();
  await server.stop();
}
