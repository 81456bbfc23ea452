// The page without a server: its program computes in the browser what the command computes, and nothing leaves the browser.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { client, EXAMPLES, launch, open, serve, settled, site, STUDY, until } from "./setup.mjs";

/** Largest relative difference from the command; numbers below 1 (um, mm, deg) are compared as those of 1. Circles and waves are
 * fitted in steps, to a residual; coordinates of boundaries are rounded to 1e-10 mm. */
const SAME = 1e-12;
const SAME_FIT = 1e-10;
const FITTED = /^\/paths\/\d+\/circle|^\/measured\//;
const ROUNDED = /\/boundary_\w*mm\//;
/** Of load cases, or points of a path, with equal deviations either may be named: what differs between them is not compared. */
const CHOSEN = /worst_case$|\/worst_points\//;
const NAMES = ["mh12-groove", "kr120-groove", "kr210-rivets", "mh12-ballbar", "r2000ic-measured", "r2000ic-pocket"];
const URDF = `<robot name="two"><link name="base_link"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/><link name="f"/>
${[
  ["base_link", "a", "0 0 0.45", "0 0 1"],
  ["a", "b", "0.155 0 0", "0 1 0"],
  ["b", "c", "0 0 0.614", "0 -1 0"],
  ["c", "d", "0 0 0.2", "-1 0 0"],
  ["d", "e", "0.64 0 0", "0 -1 0"],
  ["e", "f", "0.1 0 0", "-1 0 0"],
]
  .map(([parent, child, xyz, axis]) => `<joint name="to_${child}" type="revolute"><parent link="${parent}"/><child link="${child}"/><origin xyz="${xyz}"/><axis xyz="${axis}"/><limit lower="-2.9" upper="2.9" velocity="3" effort="0"/></joint>`)
  .join("\n")}
</robot>`;

let browser, pages;
before(async () => {
  browser = await launch();
  pages = await site();
});
after(async () => {
  await browser?.close();
  pages?.stop();
});

const request = (page, method, path, body) => page.evaluate(([method, path, body]) => globalThis.armill.request(method, path, body), [method, path, body]);

/** Where two answers differ. */
function differences(a, b, at = "") {
  if (CHOSEN.test(at)) return [];
  if (typeof a === "number" && typeof b === "number") {
    const same = FITTED.test(at) || ROUNDED.test(at) ? SAME_FIT : SAME;
    return Math.abs(a - b) <= same * Math.max(Math.abs(a), Math.abs(b), 1) ? [] : [`${at}: ${a} and ${b}`];
  }
  if (a && b && typeof a === "object" && typeof b === "object") {
    const keys = new Set([...Object.keys(a), ...Object.keys(b)]);
    return [...keys].flatMap((key) => differences(a[key], b[key], `${at}/${key}`));
  }
  return a === b ? [] : [`${at}: ${a} and ${b}`];
}

for (const name of NAMES) {
  test(`${name}: the same answer as that of the command`, async () => {
    const server = await serve((text) => text, name);
    const page = await open(browser, `${pages.url}?example=${name}`);
    try {
      const { text } = await request(page, "GET", "/api/study");
      assert.equal(text, readFileSync(join(EXAMPLES, name, "study.toml"), "utf8"));
      const native = await client(server.url)("POST", "/api/answer", { text });
      const here = await request(page, "POST", "/api/answer", { text });
      assert.ok(JSON.stringify(here).length > 2000);
      assert.deepEqual(differences(native, here).slice(0, 10), []);
      assert.deepEqual(page.complaints, []);
    } finally {
      await page.context().close();
      await server.stop();
    }
  });
}

test("only files of the page are requested, each once, and the policy of the page refuses others", async () => {
  pages.requested.length = 0;
  const page = await open(browser, pages.url);
  await page.fill("#field-x", "900");
  await settled(page);
  assert.deepEqual([...pages.requested].sort(), ["GET /", "GET /app.css", "GET /app.js", "GET /armill.wasm.gz"]);
  const other = await page.evaluate(() => fetch("http://127.0.0.1:9/").then(() => "sent", (error) => String(error)));
  assert.match(other, /TypeError/);
  assert.match(page.complaints.join(), /Content Security Policy/);
  await page.context().close();
});

test("a page that is opened from a disk shows the same map", async () => {
  const served = await open(browser, pages.url);
  const page = await open(browser, `file://${pages.folder}/index.html`);
  const worst = (one) => one.locator("[data-follow=worst] .extreme-value").innerText();
  assert.equal(await worst(page), await worst(served));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await served.context().close();
});

/** Drops files on the page. */
const drop = (page, files) =>
  page.evaluate((files) => {
    const data = new DataTransfer();
    for (const [name, text] of files) data.items.add(new File([text], name));
    document.querySelector("main").dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, files);

test("a dropped URDF becomes the robot; its compliances are assumed on request, and marked", async () => {
  const page = await open(browser, pages.url);
  await drop(page, [["two.urdf", URDF]]);
  await page.locator("[data-notice=dropped]", { hasText: "two.urdf is in the folder" }).waitFor();
  await page.locator(".banner", { hasText: "no joint compliance is known for robot" }).waitFor();
  await page.click("[data-key='assume medium']");
  await settled(page);
  assert.match(await request(page, "GET", "/api/study").then(() => page.locator(".assumed").innerText()), /assumed/i);
  assert.equal(await page.locator(".banner").isVisible(), false);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a dropped file that is no robot file is refused with its line, and the study stays as it is", async () => {
  const page = await open(browser, pages.url);
  await drop(page, [["broken.urdf", "<robot name='x'>\n<joint</robot>"]]);
  await page.locator(".banner", { hasText: "broken.urdf, line 2" }).waitFor();
  assert.match(await page.locator("[data-notice=dropped]").innerText(), /broken\.urdf is in the folder of the study/);
  assert.equal(await page.locator(".changed").isVisible(), false);
  assert.equal(await page.inputValue("#field-robot"), "yaskawa/mh12");
  await page.context().close();
});

test("a study is opened from files, saved, kept over a reload, and downloaded", async () => {
  const page = await open(browser, pages.url);
  const text = readFileSync(STUDY, "utf8").replace("Circular groove by a Yaskawa MH12", "My own groove");
  assert.ok(text.includes("My own groove"));
  await page.click(".open-study");
  await Promise.all([page.waitForNavigation(), page.setInputFiles("#open-files", [{ name: "mine.toml", mimeType: "text/plain", buffer: Buffer.from(text) }])]);
  await page.locator(".study-title", { hasText: "My own groove" }).waitFor();
  await settled(page);
  await page.fill("#field-x", "950");
  await settled(page);
  await page.click(".keep");
  await page.locator(".changed").waitFor({ state: "hidden" });
  await page.reload();
  await settled(page);
  assert.equal(await page.inputValue("#field-x"), "950");
  assert.equal(await page.locator(".changed").isVisible(), false);
  // An example at its own address does not replace what is kept.
  await page.goto(`${pages.url}?example=kr120-groove`);
  await settled(page);
  assert.match(await page.locator(".study-title").innerText(), /KR ?120/);
  await page.goto(pages.url);
  await settled(page);
  assert.equal(await page.locator(".study-title").innerText(), "My own groove");
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Download", exact: true }).click()]);
  const saved = readFileSync(await download.path(), "utf8");
  assert.match(saved, /centre_mm = \[950/);
  assert.match(saved, /My own groove/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("an example at its own address is kept once it is saved", async () => {
  const page = await open(browser, `${pages.url}?example=kr120-groove`);
  await page.fill("#field-x", "1111");
  await settled(page);
  await page.click(".keep");
  await page.locator(".changed").waitFor({ state: "hidden" });
  assert.equal(new URL(page.url()).search, "");
  await page.reload();
  await settled(page);
  assert.equal(await page.inputValue("#field-x"), "1111");
  await page.context().close();
});

test("files without a study are not opened, and the page says why", async () => {
  const page = await open(browser, pages.url);
  await page.click(".open-study");
  await page.setInputFiles("#open-files", [{ name: "robot.toml", mimeType: "text/plain", buffer: Buffer.from("format = 1\n[[joint]]\n") }]);
  await page.locator("dialog [role=alert]", { hasText: "None of these files is a study" }).waitFor();
  await page.context().close();
});

test("an example is opened from the list", async () => {
  const page = await open(browser, pages.url);
  await page.click(".open-study");
  await page.locator("[data-example=mh12-groove]").waitFor();
  assert.deepEqual((await page.locator("[data-example]").evaluateAll((all) => all.map((one) => one.dataset.example))).sort(), [...NAMES].sort());
  await Promise.all([page.waitForNavigation(), page.click("[data-example=kr120-groove]")]);
  await settled(page);
  assert.match(await page.locator(".study-title").innerText(), /KR ?120/);
  await page.context().close();
});

test("a job runs in the browser: report, tables and pictures are in its folder", async () => {
  const page = await open(browser, pages.url);
  await page.click("#tab-jobs");
  await page.click("[data-kind=run]");
  await page.waitForSelector(".job.done");
  await page.click("#tab-files");
  const names = await page.locator("[data-file]").evaluateAll((all) => all.map((one) => one.dataset.file));
  for (const name of ["out/result.json", "out/report.html"]) assert.ok(names.includes(name), names.join());
  await page.click("[data-file='out/report.html']");
  await page.frameLocator(".preview iframe").locator("h1").first().waitFor();
  // What the answers' own worker sees next: the files of the other.
  const result = await request(page, "GET", "/api/files/out/result.json");
  assert.ok(result.analyses ?? result.maps);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a job that is cancelled ends at once, and the next one runs", async () => {
  const page = await open(browser, pages.url);
  const { text } = await request(page, "GET", "/api/study");
  // The plate with three million points: too many to be done before it is cancelled, and not more than memory has room for.
  const fine = text.replace(/step_mm = 10/, "step_mm = 2");
  const { id } = await request(page, "POST", "/api/jobs", { kind: "run", text: fine });
  /** Waits until a job is in this state; one that is over before has failed this. */
  const reached = async (id, expected) => {
    let job;
    await until(async () => {
      job = await request(page, "GET", `/api/jobs/${id}`);
      return (job.state === expected && (expected !== "running" || job.done > 0)) || ["done", "failed", "cancelled"].includes(job.state);
    });
    assert.equal(job.state, expected, JSON.stringify(job.error));
  };
  await reached(id, "running");
  await request(page, "DELETE", `/api/jobs/${id}`);
  await reached(id, "cancelled");
  const next = await request(page, "POST", "/api/jobs", { kind: "run", text, options: { no_pictures: true } });
  await reached(next.id, "done");
  await page.context().close();
});
