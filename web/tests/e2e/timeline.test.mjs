// The timeline of a path: charts, tolerance, cursor, hover, clicks, keys, bands, play, the worst points; also at 820 and 390 px.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { client, drawn, launch, open, serious, serve, settled, um } from "./setup.mjs";

/** Two operations, each with its tool; feeds are known. */
const APT = `PARTNO/1
UNIT/MM
INSERT/Rough
CUTTER/6.
LOAD/TOOL,1
RAPID/
GOTO/0,0,5
FEDRAT/600,MMPM
GOTO/0,0,0
GOTO/10,0,0
RAPID/
GOTO/10,0,5
INSERT/Finish
CUTTER/4.
LOAD/TOOL,2
RAPID/
GOTO/0,5,5
FEDRAT/600,MMPM
GOTO/0,5,0
GOTO/21,5,0
FINI/
`;
let server, text, view, path, browser;
before(async () => {
  server = await serve((text) => text, "r2000ic-pocket");
  text = readFileSync(`${server.folder}/study.toml`, "utf8");
  view = await client(server.url)("POST", "/api/view", { text, analysis: "pocket" });
  path = (await client(server.url)("POST", "/api/view", { text, analysis: "pocket", columns: true })).path;
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});
const plain = (text) => text.replace(/[\u00a0\u202f]/g, "").replaceAll("−", "-");
const reading = async (page) => plain(await page.locator(".timeline-reading").innerText());
const point = async (page) => Number(/^point (\d+) of/.exec(await reading(page))[1]) - 1;
const chart = (page, i = 0) => page.locator(".charts canvas").nth(i).boundingBox();
const pixels = (page, i) =>
  page.locator(".charts canvas").nth(i).evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let sum = 0;
    for (let k = 3; k < data.length; k += 4) if (data[k] > 0) sum++;
    return sum;
  });

test("charts of deviation, force and joints under each other, with the tolerance; values of the point of the robot", async () => {
  const page = await open(browser, server.url);
  const names = await page.locator(".charts .strip-name").allInnerTexts();
  assert.deepEqual(names, ["Deviation", "Force", ...path.columns.flatMap(({ joint }) => joint ?? [])]);
  assert.equal(names.length, 8);
  await page.waitForFunction(() => document.querySelectorAll(".charts .strip.waits").length === 0);
  for (let i = 0; i < names.length; i++) assert.ok((await pixels(page, i)) > 100, `${names[i]} is drawn`);
  const boxes = await page.locator(".charts canvas").evaluateAll((all) => all.map((c) => c.getBoundingClientRect().toJSON()));
  for (const [i, box] of boxes.entries()) {
    assert.equal(box.left, boxes[0].left);
    if (i > 0) assert.ok(box.top >= boxes[i - 1].bottom);
  }
  // The robot is at the worst point.
  const worst = view.extremes[0].worst.point;
  assert.equal(await point(page), worst);
  const { in_plane_um, distance_mm } = view.scene.points.columns;
  assert.match(await reading(page), new RegExp(`· ${um(in_plane_um[worst])} µm$`));
  assert.equal(await page.locator(".charts .strip-value").first().innerText(), `${um(in_plane_um[worst])} µm`);
  assert.equal(await page.locator(".charts .strip-value.over").count(), 1);
  const cursor = await page.locator(".timeline-cursor").boundingBox();
  const expected = boxes[0].left + (boxes[0].width * distance_mm[worst]) / distance_mm.at(-1);
  assert.ok(Math.abs(cursor.x + cursor.width / 2 - expected) < 1.5, `${cursor.x} ${expected}`);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("hovering reads values, a click and a drag send the robot, the marker is there at once", async () => {
  const page = await open(browser, server.url);
  const box = await chart(page);
  const worst = await point(page);
  const { in_plane_um, distance_mm } = view.scene.points.columns;
  const at = (place) => distance_mm.reduce((best, d, i) => (Math.abs(d - place * distance_mm.at(-1)) < Math.abs(distance_mm[best] - place * distance_mm.at(-1)) ? i : best), 0);
  await page.mouse.move(box.x + 0.25 * box.width, box.y + 20);
  const over = await point(page);
  assert.ok(Math.abs(distance_mm[over] - distance_mm[at(0.25)]) <= distance_mm.at(-1) / box.width + 1);
  assert.match(await reading(page), new RegExp(`${um(in_plane_um[over])} µm$`));
  await page.mouse.move(box.x + 0.25 * box.width, box.y - 120);
  assert.equal(await point(page), worst, "the robot has not moved");
  // A click.
  await page.mouse.click(box.x + 0.25 * box.width, box.y + 20);
  await settled(page);
  assert.equal(await page.inputValue("#target-point"), String(over + 1));
  assert.match(await page.locator(".label.force").textContent(), /^force [\d.]+ N$/);
  // A drag: the reading follows the pointer before the robot is answered.
  let release;
  const held = new Promise((done) => (release = done));
  await page.route("**/api/pose", async (route) => {
    await held;
    await route.continue().catch(() => undefined);
  });
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.8 * box.width, box.y + 20, { steps: 5 });
  await page.waitForFunction((before) => !document.querySelector(".timeline-reading").textContent.startsWith(before), `point ${over + 1} `);
  const there = await point(page);
  assert.ok(Math.abs(distance_mm[there] / distance_mm.at(-1) - 0.8) < 0.01);
  assert.notEqual(await page.inputValue("#target-point"), String(there + 1), "the robot is still on its way");
  await page.mouse.up();
  release();
  await settled(page);
  await page.waitForFunction((value) => document.querySelector("#target-point").value === value, String(there + 1));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("all keys of a slider, and play and pause with the space bar", async () => {
  const page = await open(browser, server.url);
  const n = view.scene.points.xyz_mm.length;
  await page.locator(".charts").focus();
  const press = async (key) => {
    await page.keyboard.press(key);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    return point(page);
  };
  assert.equal(await press("Home"), 0);
  assert.equal(await press("ArrowRight"), 1);
  assert.equal(await press("ArrowUp"), 2);
  assert.equal(await press("ArrowLeft"), 1);
  assert.equal(await press("Shift+ArrowRight"), 11);
  const page_up = await press("PageUp");
  assert.equal(page_up, 11 + Math.round(n / 50));
  assert.equal(await press("PageDown"), 11);
  assert.equal(await press("End"), n - 1);
  assert.equal(await press("ArrowRight"), n - 1);
  const slider = page.locator(".charts");
  assert.equal(await slider.getAttribute("aria-valuenow"), String(n));
  assert.equal(await slider.getAttribute("aria-valuemax"), String(n));
  assert.match(await slider.getAttribute("aria-valuetext"), /^point .* µm$/);
  await settled(page);
  await press("Home");
  await page.selectOption("#play-speed", { label: "whole path in 5 s" });
  await page.locator(".charts").focus();
  await page.keyboard.press("Space");
  assert.match(await page.locator(".play").innerText(), /Pause/);
  await page.waitForFunction(() => Number(document.querySelector(".charts").getAttribute("aria-valuenow")) > 100);
  await page.keyboard.press("Space");
  assert.match(await page.locator(".play").innerText(), /Play/);
  const stopped = await point(page);
  await page.waitForTimeout(250);
  assert.equal(await point(page), stopped);
  await settled(page);
  assert.equal(await page.inputValue("#target-point"), String(stopped + 1), "the robot has followed");
  // To the end, where it stops by itself; then again from the start.
  await page.locator(".charts").focus();
  await press("End");
  await press("PageDown");
  await page.click(".play");
  await page.waitForFunction(() => /Play/.test(document.querySelector(".play").textContent));
  assert.equal(await point(page), n - 1);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the worst points are listed as in the answer; a click goes there", async () => {
  const page = await open(browser, server.url);
  const { worst_points } = view.answer.paths[0];
  assert.ok(worst_points.length > 1);
  const rows = page.locator(".worst-points li button");
  assert.equal(await rows.count(), worst_points.length);
  const { in_plane_um } = view.scene.points.columns;
  for (const [i, { point: worst, line, cause }] of worst_points.entries()) {
    const row = plain(await rows.nth(i).innerText());
    assert.ok(row.startsWith(`${um(worst.in_plane_um)} µm`) && row.endsWith(`line ${line}`), row);
    const about = await rows.nth(i).getAttribute("title");
    assert.ok(about.includes(cause));
    await rows.nth(i).click();
    await settled(page);
    const there = await point(page);
    assert.ok(about.includes(`point ${there + 1},`));
    assert.ok(Math.abs(in_plane_um[there] - worst.in_plane_um) < 0.001);
  }
  await page.context().close();
});

test("operations and tools are bands; a click or an arrow key goes to the first point of one", async () => {
  const own = await serve(() => `format = 1\nrobot = "yaskawa/mh12"\ntolerance_um = 50\nload = { cases_n = [[3, 5, 5]] }\nplane = { centre_mm = [1000, 50, 800], half_size_mm = 100, step_mm = 20 }\n[[analysis]]\nkind = "path"\nname = "slots"\nprogram = { file = "slots.apt" }\n`);
  writeFileSync(`${own.folder}/slots.apt`, APT);
  const page = await open(browser, own.url);
  const operations = page.locator(".band-buttons").first().locator("button");
  const tools = page.locator(".band-buttons").nth(1).locator("button");
  const given = (await client(own.url)("POST", "/api/view", { text: readFileSync(`${own.folder}/study.toml`, "utf8"), analysis: "slots", columns: true })).path;
  assert.deepEqual(given.operations.map(({ name, tool }) => [name, tool]), [["Rough", 1], ["Finish", 2]]);
  assert.equal(await operations.count(), given.operations.length);
  assert.deepEqual(await tools.allInnerTexts(), ["T1", "T2"]);
  const last = given.operations.at(-1);
  await operations.last().click();
  await settled(page);
  assert.equal(await page.inputValue("#target-point"), String(last.first + 1));
  assert.equal(await operations.last().getAttribute("aria-current"), "true");
  assert.equal(await page.locator(".band-buttons [tabindex='0']").count(), 2, "one tab stop a band");
  await tools.last().focus();
  await page.keyboard.press("ArrowLeft");
  await settled(page);
  assert.equal(await page.inputValue("#target-point"), "1");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "T1");
  // 600 mm/min: 10 mm/s.
  assert.match(await reading(page), /· 0\.0 s ·/);
  assert.deepEqual(await page.locator("#play-speed option").allInnerTexts().then((all) => all.slice(0, 2)), ["as programmed", "10 times as fast"]);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await own.stop();
});

test("only a path has a timeline; it is closed and opened, and stays so", async () => {
  const own = await serve();
  const page = await open(browser, own.url);
  assert.equal(await page.locator("#timeline").isVisible(), false);
  await page.context().close();
  await own.stop();
  const shown = await open(browser, server.url);
  assert.ok(await shown.locator(".charts").isVisible());
  await shown.click("#timeline summary");
  assert.equal(await shown.locator(".charts").isVisible(), false);
  assert.match(await reading(shown), /^point \d+ of/);
  // The browser tells the page after the click that it is closed.
  await shown.waitForFunction(() => localStorage.getItem("armill-panel-timeline") === "false");
  await shown.reload();
  await settled(shown);
  assert.equal(await shown.locator(".charts").isVisible(), false);
  await shown.locator("#timeline summary").focus();
  await shown.keyboard.press("Enter");
  await shown.waitForFunction(() => document.querySelectorAll(".charts .strip.waits").length === 0);
  assert.ok((await pixels(shown, 0)) > 100);
  await shown.context().close();
});

for (const [name, width, height] of [["a tablet", 820, 1180], ["a phone", 390, 844]])
  test(`${name}, ${width} x ${height}: the timeline is under the scene, nothing is cut off, a tap and keys work`, async () => {
    const page = await open(browser, server.url, { width, height });
    const stage = await page.locator(".stage").boundingBox();
    const timeline = await page.locator("#timeline").boundingBox();
    assert.ok(timeline.y >= stage.y + stage.height - 1 && timeline.width > 0.95 * width - 20);
    const cut = await page.evaluate(() => ({
      page: document.documentElement.scrollWidth - innerWidth,
      beside: [...document.querySelectorAll("#timeline *")].filter((e) => {
        const b = e.getBoundingClientRect();
        return b.width > 1 && !e.closest(".band-buttons") && (b.right > innerWidth + 1 || b.left < -1);
      }).map((e) => `${e.tagName}.${e.className}`),
    }));
    assert.deepEqual(cut, { page: 0, beside: [] });
    await page.locator(".charts").scrollIntoViewIfNeeded();
    const box = await chart(page);
    await page.mouse.click(box.x + 0.5 * box.width, box.y + 20);
    await settled(page);
    const there = await point(page);
    assert.equal(await page.inputValue("#target-point"), String(there + 1));
    await page.keyboard.press("ArrowRight");
    await settled(page);
    assert.equal(await point(page), there + 1);
    assert.deepEqual(await serious(page, "#timeline"), []);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });

test("deviation vectors are thinned by zoom: about as many in the picture near and far", async () => {
  const page = await open(browser, server.url);
  const whiskers = () => page.evaluate(() => Number(document.querySelector(".stage").dataset.vectors));
  await page.click(".views button:nth-child(5)");
  await drawn(page);
  const far = await whiskers();
  const box = await page.locator(".stage").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  for (let i = 0; i < 8; i++) await page.mouse.wheel(0, -240);
  await drawn(page);
  const near = await whiskers();
  for (const count of [far, near]) assert.ok(count >= 24 && count <= 96, `${far} ${near}`);
  await page.context().close();
});
