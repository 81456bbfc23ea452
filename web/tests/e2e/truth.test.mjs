// True at a glance: what is outside joint limits or cannot be drilled is never under a green tick; the arm takes the
// posture of the answer; warnings and the nearest reachable place are at the verdict.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { client, difference, launch, open, serve, settled, STUDY } from "./setup.mjs";

const text = readFileSync(STUDY, "utf8");
let browser, server, request;
before(async () => {
  browser = await launch();
  server = await serve();
  request = client(server.url);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});
const plain = (text) => text.replace(/[\u00a0\u202f]/g, " ");
const line = async (page) => plain(await page.locator(".verdict-line").innerText());
const branchShown = async (page) => (await page.locator("#panel-branches li.chosen .branch-name").innerText()).split(" · ")[0];

test("a plate outside joint limits: counted inside them, hatched, no green tick", async () => {
  const page = await open(browser, server.url);
  await page.selectOption("#field-analysis", "Fig. 6, elbow down");
  await settled(page);
  await page.click(".views button:nth-child(5)");
  await page.fill("#field-limit", "110");
  await settled(page);
  assert.match(await line(page), /17 % of the plate is within 110 µm and inside joint limits/);
  assert.equal(await page.locator(".verdict-line.good").count(), 0);
  assert.match(await page.locator(".verdict-extra").innerText(), /5438 of 6561 points outside joint limits \(hatched\)/);
  assert.match(await page.locator(".legend .marks").innerText(), /outside joint limits/);
  // The deviation is below the tolerance, but the posture is impossible: neither panel is green.
  assert.equal(await page.locator("#panel-branches li.chosen .bar.good").count(), 0);
  // The hatching itself: without the flags of the answer the picture is another one.
  const hatched = await page.locator(".stage").screenshot();
  await page.route("**/api/view", async (route) => {
    const response = await route.fetch();
    const body = await response.json();
    for (const map of body.answer.maps) map.grid.flags = [];
    await route.fulfill({ response, json: body });
  });
  await page.fill("#field-limit", "110.0");
  await page.fill("#field-limit", "109.9999");
  await settled(page);
  const without = await page.locator(".stage").screenshot();
  assert.ok((await difference(page, hatched, without)) > 0.01, "hatching is seen");
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a plate inside joint limits has its tick, and no hatching in the legend", async () => {
  const page = await open(browser, server.url);
  await page.fill("#field-limit", "300");
  await settled(page);
  assert.match(await line(page), /The whole plate is within 300 µm/);
  assert.equal(await page.locator(".verdict-line.good").count(), 1);
  assert.equal(await page.locator(".legend .marks").count(), 0);
  await page.context().close();
});

test("a path outside joint limits: counted inside them, dashed, no green tick", async () => {
  const name = "(ii) vertical plate, tool 100 mm, elbow up";
  const page = await open(browser, server.url);
  await page.selectOption("#field-analysis", name);
  await settled(page);
  await page.fill("#field-limit", "500");
  await settled(page);
  assert.match(await line(page), /The whole path is within 500 µm/);
  await page.selectOption("#field-branch", "front elbow-down flip");
  await settled(page);
  const edited = (await request("POST", "/api/change", { text, analysis: name, changes: [{ key: "tolerance_um", value: 500 }, { key: "posture.branch", value: "front elbow-down flip" }] })).text;
  const [path] = (await request("POST", "/api/answer", { text: edited, analysis: name })).paths;
  assert.ok(path.outside_joint_limits > 0 && path.fraction_within === 1);
  assert.match(await line(page), path.fraction_within_and_inside_joint_limits > 0 ? /of the path is within 500 µm and inside joint limits/ : /No point of the path is within 500 µm and inside joint limits/);
  assert.equal(await page.locator(".verdict-line.good").count(), 0);
  assert.match(await page.locator(".legend .marks").innerText(), /outside joint limits/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("holes: those that cannot be drilled are named and crossed; the arm takes the posture of the answer", async () => {
  const own = await serve((text) => text, "kr210-rivets");
  const page = await open(browser, own.url);
  const { holes } = await client(own.url)("POST", "/api/answer", { text: readFileSync(`${own.folder}/study.toml`, "utf8"), analysis: "rivets" });
  assert.match(await line(page), /16 of 18 holes can be drilled; 17 and 18: wrist singular/);
  assert.equal(await page.locator(".verdict-line.good").count(), 0);
  const labels = await page.locator(".label.lost").allTextContents();
  assert.deepEqual(labels, ["17", "18"]);
  for (const number of [5, 1, 9, 17]) {
    await page.fill("#target-point", String(number));
    await settled(page);
    const row = holes[0].each.find(({ hole }) => hole === number);
    assert.equal(await branchShown(page), row.branch, `hole ${number}`);
    const angles = row.joints_deg.map((q) => `${q < -0.05 ? "−" : ""}${Math.abs(q).toFixed(1)}°`);
    assert.deepEqual(await page.locator("#panel-joints .bar-value").allInnerTexts(), angles, `hole ${number}`);
    if (row.blocked_by) {
      assert.match(await page.locator("#panel-point").innerText(), /cannot be drilled: wrist singular/);
      assert.equal(await page.locator("#panel-point .figure.within").count(), 0);
    }
  }
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await own.stop();
});

test("along a path the arm keeps the branch of the answer", async () => {
  const own = await serve((text) => text, "mh12-ballbar");
  const page = await open(browser, own.url);
  const table = await fetch(new URL("/api/table", own.url), {
    method: "POST",
    headers: { Authorization: `Bearer ${new URL(own.url).searchParams.get("token")}`, "Content-Type": "application/json" },
    body: JSON.stringify({ text: readFileSync(`${own.folder}/study.toml`, "utf8"), analysis: "groove", format: "csv" }),
  });
  const rows = (await table.text()).split("\n").filter((row) => row && !row.startsWith("#"));
  const at = rows[0].split(",").findIndex((head) => head.startsWith("branch"));
  for (const point of [1, 8, 17, 25, 33]) {
    await page.fill("#target-point", String(point));
    await settled(page);
    assert.equal(await branchShown(page), rows[point].split(",")[at], `point ${point}`);
    assert.equal(await page.locator("#panel-branches .used").count(), 1);
  }
  // Another posture is marked as such, and the way back is offered.
  await page.locator("#panel-branches li:not(.chosen) .branch").first().click();
  assert.match(await page.locator("#panel-branches").innerText(), /not the posture of the answer/);
  await page.click("text=Show the posture of the answer");
  assert.equal(await branchShown(page), rows[33].split(",")[at]);
  await page.context().close();
  await own.stop();
});

test("warnings have a badge at the verdict that shows them in place", async () => {
  // Without `base` the part may be 450 mm off.
  const named = 'base = "base_link"\n';
  assert.ok(text.includes(named));
  const unnamed = text.replace(named, "");
  const own = await serve(() => unnamed);
  const page = await open(browser, own.url);
  const { warnings } = await request("POST", "/api/answer", { text: unnamed, analysis: "Fig. 6" });
  assert.equal(warnings.length, 1);
  const badge = page.locator(".badge");
  assert.equal(plain(await badge.innerText()), `⚠ ${warnings.length === 1 ? "1 warning" : `${warnings.length} warnings`}`);
  const box = await badge.boundingBox();
  assert.ok(box.y + box.height < 200, "at the verdict");
  await badge.focus();
  await page.keyboard.press("Enter");
  assert.deepEqual(await page.locator("#warning-list li").allInnerTexts(), warnings);
  await page.keyboard.press("Escape");
  assert.equal(await page.locator("#warning-list").isVisible(), false);
  await page.context().close();
  await own.stop();
});

test("a part out of reach: no stale colours, the nearest reachable place, and a button that moves it there", async () => {
  const page = await open(browser, server.url);
  await page.fill("#field-x", "3500");
  await settled(page);
  assert.match(await line(page), /The robot does not reach the plate/);
  assert.equal(await page.locator(".legend").isVisible(), false);
  const nearest = page.locator(".nearest p");
  await page.waitForFunction(() => /Nearest reachable position: x/.test(document.querySelector(".nearest p")?.textContent ?? ""));
  const [x, y, z] = /x ([\d−.]+), y ([\d−.]+), z ([\d−.]+) mm/.exec(plain(await nearest.innerText()).replace(/(\d) (\d)/g, "$1$2")).slice(1).map((v) => Number(v.replace("−", "-")));
  await page.click("text=Move the part there");
  await settled(page);
  const fields = await Promise.all(["x", "y", "z"].map((axis) => page.inputValue(`#field-${axis}`)));
  assert.deepEqual(fields.map(Number), [x, y, z]);
  assert.match(await line(page), /of the plate/);
  assert.equal(await page.locator(".nearest").count(), 0);
  assert.ok(await page.locator(".legend").isVisible());
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("branches: possible ones first, impossible ones last and not green, one in use, colours explained", async () => {
  const page = await open(browser, server.url);
  await page.selectOption("#field-analysis", "Fig. 6, elbow down");
  await settled(page);
  await page.fill("#field-limit", "300");
  await settled(page);
  const rows = await page.locator("#panel-branches li").evaluateAll((list) => list.filter((e) => e.querySelector(".branch")).map((e) => ({ possible: !e.classList.contains("impossible"), green: e.querySelector(".bar.good") !== null })));
  assert.ok(rows.some((row) => row.possible) && rows.some((row) => !row.possible));
  assert.deepEqual(rows, [...rows].sort((a, b) => Number(b.possible) - Number(a.possible)));
  assert.ok(rows.every((row) => row.possible || !row.green));
  assert.equal(await page.locator("#panel-branches .used").count(), 1);
  assert.match(await page.locator(".branch-key").innerText(), /within the tolerance\s*above it\s*outside joint limits/);
  await page.context().close();
});
