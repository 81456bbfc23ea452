// The live view shows the numbers that the server answers, whatever is turned.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { client, drawn, launch, open, serve, settled, STUDY, um } from "./setup.mjs";

const text = readFileSync(STUDY, "utf8");
let server, browser, request;
before(async () => {
  server = await serve();
  browser = await launch();
  request = client(server.url);
});
after(async () => {
  await browser?.close();
  assert.ok([0, undefined].includes(await server?.stop()), "the server ends with 0");
});

const extreme = async (page, which) => (await page.locator(`[data-follow=${which}] .extreme-value`).innerText()).replaceAll("\u00a0", " ");
async function showsAnswer(page, study, name) {
  const { maps } = await request("POST", "/api/answer", { text: study, analysis: name });
  assert.equal(await extreme(page, "worst"), `${um(maps[0].worst.in_plane_um)} ± ${um(maps[0].worst.in_plane_u_um)} µm`);
  assert.equal(await extreme(page, "best"), `${um(maps[0].best.in_plane_um)} ± ${um(maps[0].best.in_plane_u_um)} µm`);
  return maps[0];
}
const changed = async (name, ...changes) => (await request("POST", "/api/change", { text, analysis: name, changes: changes.map(([key, value]) => ({ key, value })) })).text;

test("the paper's study: the numbers of the page are those of the server, the token is out of the address", async () => {
  const page = await open(browser, server.url);
  const map = await showsAnswer(page, text, "Fig. 6");
  assert.equal(map.fraction_within, 0);
  assert.match(await page.locator(".verdict-line").innerText(), /No point of the plate is within 50\u00a0µm/);
  assert.ok(!page.url().includes("token"));
  const pose = await request("POST", "/api/pose", { text, analysis: "Fig. 6", at: { y_mm: map.worst.in_plane_mm[0], z_mm: map.worst.in_plane_mm[1] }, case: map.worst.worst_case });
  const shown = pose.answer.postures.findIndex((p) => p.branch === map.worst.branch);
  const values = pose.in_plane[shown][map.worst.worst_case - 1];
  assert.deepEqual(await page.locator("#panel-point .figure-value").allInnerTexts(), [um(values.in_plane_um), um(values.normal_um), um(values.full_um)]);
  assert.deepEqual(await page.locator("#panel-shares .bar-value").allInnerTexts(), map.worst.joint_share_um.map(um));
  assert.equal(await page.locator("#panel-branches .branch").count(), pose.answer.postures.length);
  assert.deepEqual(await page.locator("#panel-cases tbody td:nth-child(2)").allInnerTexts(), pose.in_plane[shown].map((c) => um(c.in_plane_um)));
  const angles = pose.answer.postures[shown].joints_deg.map((q) => `${q < -0.05 ? "−" : ""}${Math.abs(q).toFixed(1)}°`);
  assert.deepEqual(await page.locator("#panel-joints .bar-value").allInnerTexts(), angles);
  const first = pose.answer.postures[shown].compliance[2][2] * 1e6;
  assert.equal(Number((await page.locator("#panel-matrix tbody tr:nth-child(3) td:nth-child(4)").innerText()).replace("−", "-")), Number(first.toFixed(first < 9.995 ? 2 : first < 99.95 ? 1 : 0)));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("distance and tilt: each change shows the map of the changed study", async () => {
  const page = await open(browser, server.url);
  await page.fill("#field-x", "900");
  await settled(page);
  const near = await showsAnswer(page, await changed("Fig. 6", ["plane.centre_mm", [900, 0, 1000]]), "Fig. 6");
  await page.fill("#field-tilt", "30");
  await settled(page);
  const tilted = await showsAnswer(page, await changed("Fig. 6", ["plane.centre_mm", [900, 0, 1000]], ["plane.tilt_deg", 30]), "Fig. 6");
  assert.notEqual(um(near.worst.in_plane_um), um(tilted.worst.in_plane_um));
  assert.equal(await page.locator(".changed").isVisible(), true);
  await page.click(".changed");
  await settled(page);
  await showsAnswer(page, text, "Fig. 6");
  assert.equal(await page.locator("#field-x").inputValue(), "800");
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("scrubbing does not pile up: the last value is shown, most others are never requested", async () => {
  const page = await open(browser, server.url);
  let requests = 0;
  page.on("request", (r) => r.url().endsWith("/api/view") && requests++);
  await page.locator("#field-x").focus();
  for (let i = 0; i < 60; i++) await page.keyboard.press("ArrowUp", { delay: 5 });
  await settled(page);
  assert.equal(await page.locator("#field-x").inputValue(), "1400");
  await showsAnswer(page, await changed("Fig. 6", ["plane.centre_mm", [1400, 0, 1000]]), "Fig. 6");
  assert.ok(requests > 0 && requests < 60, `${requests} answers were requested`);
  await page.context().close();
});

test("a change is one question, and what is shown of map and arm comes with it", async () => {
  const page = await open(browser, server.url);
  const requests = [];
  // In addition the file is watched.
  page.on("request", (r) => /\/api\/(?!study\/version)/.test(r.url()) && requests.push(new URL(r.url()).pathname));
  await page.locator("#field-x").focus();
  await page.keyboard.press("ArrowUp");
  await settled(page);
  assert.deepEqual(requests, ["/api/view"]);
  const map = await showsAnswer(page, await changed("Fig. 6", ["plane.centre_mm", [810, 0, 1000]]), "Fig. 6");
  assert.deepEqual(await page.locator("#panel-shares .bar-value").allInnerTexts(), map.worst.joint_share_um.map(um));
  // The same numbers in the same elements: a panel takes on what is new, it is not made anew.
  await page.evaluate(() => (document.querySelector("#panel-shares .bar-value").mine = true));
  await page.keyboard.press("ArrowUp");
  await settled(page);
  assert.equal(await page.evaluate(() => document.querySelector("#panel-shares .bar-value").mine), true);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a fixed colour scale stays while values change; lines and scale follow their switches", async () => {
  const page = await open(browser, server.url);
  const legend = () => page.locator(".legend").getAttribute("aria-label");
  const turn = async (text) => {
    await page.locator(".shown label", { hasText: text }).click();
    await settled(page);
  };
  const lines = page.locator(".labels .iso:visible");
  await page.click(".views button:nth-child(5)");
  await page.locator(".shown summary").click();
  assert.ok((await lines.count()) > 0);
  await turn("Lines of equal deviation");
  assert.equal(await lines.count(), 0);
  await turn("Lines of equal deviation");
  assert.ok((await lines.count()) > 0);
  const first = await legend();
  await turn("Fix the colour scale");
  await page.fill("#field-x", "1400");
  await settled(page);
  assert.equal(await legend(), first);
  await turn("Fix the colour scale");
  assert.notEqual(await legend(), first);
  const { levels_um } = await request("POST", "/api/view", { text: await changed("Fig. 6", ["plane.centre_mm", [1400, 0, 1000]]), analysis: "Fig. 6" });
  assert.equal(await legend(), `Colours from ${um(levels_um[0])} to ${um(levels_um.at(-1))} micrometres; tolerance 50.0`);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

const HOLES = `format = 1
robot = "yaskawa/mh12"
tolerance_um = 90
plane = { centre_mm = [900, 0, 900], half_size_mm = 100, step_mm = 50 }
load = { cases_n = [[3, 5, 5]] }
[[analysis]]
kind = "holes"
name = "rivets"
holes = { at_mm = [[-50, 0, 0], [0, 0, 0], [50, 0, 0]] }
`;
test("holes: verdict, tolerance and the robot at the worst", async () => {
  const own = await serve(() => HOLES);
  const page = await open(browser, own.url);
  const { holes } = await client(own.url)("POST", "/api/answer", { text: HOLES, analysis: "rivets" });
  assert.match(await page.locator(".verdict-line").innerText(), /holes? (is|are) within 90\u00a0µm/);
  assert.equal(await extreme(page, "worst"), `${um(holes[0].worst_holes[0].point.in_plane_um)} ± ${um(holes[0].worst_holes[0].point.in_plane_u_um)} µm`);
  assert.equal(await page.inputValue("#target-point"), String(holes[0].worst_holes[0].hole));
  assert.match(await page.locator(".legend").innerText(), /tolerance 90/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await own.stop();
});

test("a click on the plate sends the robot there", async () => {
  const page = await open(browser, server.url);
  await page.click(".views button:nth-child(5)");
  await drawn(page);
  const box = await page.locator(".stage").boundingBox();
  await page.mouse.move(box.x + box.width * 0.42, box.y + box.height * 0.4);
  await page.locator(".tip dd").first().waitFor();
  const place = (await page.locator(".tip dd").first().innerText()).replace(" mm", "").replaceAll("−", "-").split(", ").map(Number);
  await page.mouse.click(box.x + box.width * 0.42, box.y + box.height * 0.4);
  await settled(page);
  assert.deepEqual([await page.inputValue("#target-y"), await page.inputValue("#target-z")].map(Number), place);
  const told = (await page.locator("#panel-point .facts dd").first().innerText()).replace(" mm", "").replaceAll("−", "-").split(", ").map(Number);
  assert.deepEqual(told, [800, place[0], 1000 + place[1]]);
  const { maps } = await request("POST", "/api/answer", { text, analysis: "Fig. 6" });
  const { y_mm, z_mm, in_plane_um } = maps[0].grid;
  const here = in_plane_um[z_mm.indexOf(place[1]) * y_mm.length + y_mm.indexOf(place[0])];
  assert.equal(await page.locator("#panel-point .figure-value").first().innerText(), um(here));
  // The same by number, without a mouse.
  await page.fill("#target-y", "0");
  await settled(page);
  assert.match(await page.locator("#panel-point .facts dd").first().innerText(), /^800, 0, /);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("another branch: its map, and it stays where the study said", async () => {
  const page = await open(browser, server.url);
  await page.locator("#panel-branches .use").first().click();
  await settled(page);
  const branch = await page.inputValue("#field-branch");
  assert.match(branch, /elbow-down/);
  const map = await showsAnswer(page, await changed("Fig. 6", ["posture.branch", branch]), "Fig. 6");
  assert.ok(map.worst.in_plane_um < 158);
  await page.selectOption("#field-branch", "best");
  await settled(page);
  await showsAnswer(page, await changed("Fig. 6", ["posture.branch", "best"]), "Fig. 6");
  await page.context().close();
});

test("another load case: its numbers, until the worst one is chosen again", async () => {
  const page = await open(browser, server.url);
  const rows = page.locator("#panel-cases tbody tr");
  await rows.nth(0).locator("button").click();
  await settled(page);
  assert.equal(await page.locator("#panel-point .figure-value").first().innerText(), await rows.nth(0).locator("td").first().innerText());
  await page.click("text=Show the worst case");
  await settled(page);
  assert.equal(await page.locator("#panel-point .figure-value").first().innerText(), await page.locator("#panel-cases td.strong").innerText());
  await page.context().close();
});

test("a path: its worst point, and a walk along it", async () => {
  const name = "(ii) vertical plate, tool 100 mm, elbow up";
  const page = await open(browser, server.url);
  await page.selectOption("#field-analysis", name);
  await settled(page);
  const { paths } = await request("POST", "/api/answer", { text, analysis: name });
  assert.equal(await extreme(page, "worst"), `${um(paths[0].worst.in_plane_um)} ± ${um(paths[0].worst.in_plane_u_um)} µm`);
  assert.equal(await page.locator("#panel-point .figure-value").first().innerText(), um(paths[0].worst.in_plane_um));
  await page.fill("#target-point", "1");
  await settled(page);
  assert.match(await page.locator("#panel-point .facts dd").first().innerText(), /^1000, 100, 800 mm/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a wrong value is reported at its field, in the words of the page, and what is shown stays", async () => {
  const page = await open(browser, server.url);
  const before = await extreme(page, "worst");
  await page.fill("#field-tilt", "300");
  await page.waitForSelector("#field-tilt[aria-invalid=true]");
  assert.match(await page.locator("#field-tilt-error").innerText(), /must be at most 180° \(got 300°\)/);
  assert.equal(await extreme(page, "worst"), before);
  await page.fill("#field-tilt", "abc");
  assert.match(await page.locator("#field-tilt-error").innerText(), /"abc" is not a number/);
  await page.fill("#field-tilt", "0");
  await settled(page);
  assert.equal(await page.locator("#field-tilt-error").innerText(), "");
  await page.context().close();
});

test("two tabs do not disturb each other", async () => {
  const [one, two] = await Promise.all([open(browser, server.url), open(browser, server.url)]);
  await one.fill("#field-x", "700");
  await two.fill("#field-x", "1100");
  await Promise.all([settled(one), settled(two)]);
  await showsAnswer(one, await changed("Fig. 6", ["plane.centre_mm", [700, 0, 1000]]), "Fig. 6");
  await showsAnswer(two, await changed("Fig. 6", ["plane.centre_mm", [1100, 0, 1000]]), "Fig. 6");
  await one.context().close();
  await two.context().close();
});

test("without a valid token the page says what to do", async () => {
  const page = await (await browser.newContext()).newPage();
  const wrong = new URL(server.url);
  wrong.searchParams.set("token", "0".repeat(32));
  await page.goto(wrong.href);
  await page.waitForSelector("text=no valid token");
  await page.context().close();
});
