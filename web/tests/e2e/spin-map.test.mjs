// Path × spin map: it is that of the server, its knots are moved by mouse and keys, and the answer follows.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { client, launch, open, serious, serve, settled, um } from "./setup.mjs";

// A spindle across the flange: a spin moves the wrist.
const STUDY = `format = 1
title = "Circle"
robot = "yaskawa/mh12"
tolerance_um = 400
load = { cases_n = [[30, 50, 50]], frame = "feed" }
plane = { centre_mm = [700, 0, 500], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }
tool.flange_from_tool_mm_deg = [100, 0, 150, 0, 90, 0]

[[analysis]]
kind = "path"
name = "circle"
circle.radius_mm = 200
spin_deg = 10

[[analysis]]
kind = "map"
name = "plate"
load = { cases_n = [[30, 50, 50]] }
`;

let server, browser, request;
before(async () => {
  server = await serve(() => STUDY);
  browser = await launch();
  request = client(server.url);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** The page with the map opened by keyboard. */
async function opened(size = {}) {
  const page = await open(browser, server.url, size);
  await page.locator("#panel-spin-map > summary").press("Enter");
  await page.locator(".spin-knot").first().waitFor();
  await page.locator(".spin-plot").scrollIntoViewIfNeeded();
  return page;
}

/** The worst deviation of the path with these keys in its text. */
async function worst(changes) {
  const { text } = await request("POST", "/api/change", { text: STUDY, analysis: "circle", changes });
  return (await request("POST", "/api/answer", { text, analysis: "circle" })).paths[0].worst.in_plane_um;
}
const shownWorst = (page) => page.locator('[data-follow="worst"] .extreme-value').innerText();
const knots = (page) => page.locator(".spin-knot");
const value = (page, index) => knots(page).nth(index).getAttribute("aria-valuetext");
/** Waits for what the page says of a knot. */
const says = (page, index, pattern) => page.waitForFunction(([index, pattern]) => new RegExp(pattern).test(document.querySelectorAll(".spin-knot")[index]?.getAttribute("aria-valuetext") ?? ""), [index, pattern]);

test("the map of a path is that of the server, with a chosen spin", async () => {
  const page = await opened();
  const map = await request("POST", "/api/spin-map", { text: STUDY, analysis: "circle" });
  assert.equal(await knots(page).count(), 2);
  // The constant spin of the study, and the cell of the map there.
  const row = map.spins_deg.findIndex((spin) => Math.abs(spin - 10) < 1e-9);
  assert.match(await value(page, 0), new RegExp(`^10\\.0° at 0 mm: ${um(map.in_plane_um[row][0])} µm in plane`));
  const label = await page.locator(".spin-plot canvas").getAttribute("aria-label");
  assert.ok(label.includes(`${um(map.levels_um[0])} to ${um(map.levels_um.at(-1))} micrometres`), label);
  const states = map.state.flat();
  const legend = await page.locator(".spin-legend").innerText();
  for (const [bit, words] of [[1, "outside joint limits"], [8, "a joint jumps"]]) assert.equal(legend.includes(words), states.some((state) => (state & bit) !== 0), words);
  // Colours are on the canvas where cells can be used.
  const colours = await page.locator(".spin-plot canvas").evaluate((canvas) => new Set(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data).size);
  assert.ok(colours > 20, String(colours));
  // A plate has no such map.
  await page.selectOption("#field-analysis", "plate");
  await settled(page);
  assert.ok(await page.locator("#panel-spin-map").isHidden());
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a knot is moved, added and removed by keys; the answer and undo follow", async () => {
  const page = await opened();
  const before = await shownWorst(page);
  await knots(page).nth(1).focus();
  await page.keyboard.press("Shift+ArrowUp");
  await page.keyboard.press("Shift+ArrowUp");
  await page.keyboard.press("ArrowDown");
  await says(page, 1, "^29\\.0° at 1256\\.6 mm");
  await settled(page);
  const curve = [[0, 0], [1256.6, 19]];
  assert.ok((await shownWorst(page)).startsWith(um(await worst([{ key: "spin_curve_mm_deg", value: curve }]))));
  // The knot keeps the focus; a knot more is halfway to the one before.
  await page.keyboard.press("Insert");
  assert.equal(await knots(page).count(), 3);
  await says(page, 1, "at 628\\.3 mm");
  await page.keyboard.press("ArrowLeft");
  await says(page, 1, "at 615\\.7 mm");
  await page.keyboard.press("ArrowUp");
  await settled(page);
  await page.keyboard.press("Delete");
  await settled(page);
  assert.equal(await knots(page).count(), 2);
  assert.ok((await shownWorst(page)).startsWith(um(await worst([{ key: "spin_curve_mm_deg", value: curve }]))));
  // Undo leads back to the constant spin of the file, by as many steps as there were.
  for (let steps = 0; steps < 12 && (await page.locator(".changed").isVisible()); steps++) {
    await page.keyboard.press("Control+z");
    await settled(page);
  }
  await says(page, 1, "^10\\.0° at 1256\\.6 mm");
  assert.equal(await shownWorst(page), before);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a knot is dragged, and the constant spin comes back", async () => {
  const page = await opened();
  const knot = await knots(page).nth(0).boundingBox();
  const [x, y] = [knot.x + knot.width / 2, knot.y + knot.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 30, y - 20, { steps: 4 });
  await page.mouse.move(x + 60, y - 33, { steps: 4 });
  await page.mouse.up();
  await settled(page);
  const [, spin, at] = /^([\d.]+)° at ([\d.]+) mm/.exec(await value(page, 0));
  assert.ok(Number(spin) > 30 && Number(at) > 20, `${spin} ${at}`);
  const curve = [[Number(at), Number((Number(spin) - 10).toFixed(1))], [1256.6, 0]];
  assert.ok((await shownWorst(page)).startsWith(um(await worst([{ key: "spin_curve_mm_deg", value: curve }]))));
  await page.getByRole("button", { name: "Constant spin" }).press("Enter");
  await says(page, 0, "^10\\.0° at 0 mm");
  await settled(page);
  assert.ok((await shownWorst(page)).startsWith(um(await worst([]))));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the searched spin is drawn and can be used", async () => {
  const page = await opened();
  const found = await request("POST", "/api/spin-search", { text: STUDY, analysis: "circle" });
  await page.getByRole("button", { name: "Search", exact: true }).press("Enter");
  await page.locator(".spin-searched").waitFor({ state: "attached" });
  assert.ok((await page.locator(".spin-status").innerText()).includes(`Searched: at most ${um(found.max_in_plane_um)} µm`));
  await page.getByRole("button", { name: "Use the searched spin" }).press("Enter");
  await page.waitForFunction((count) => document.querySelectorAll(".spin-knot").length === count, found.curve_mm_deg.length);
  await settled(page);
  const branch = found.branch ? [{ key: "posture.branch", value: found.branch }] : [];
  const used = await worst([{ key: "spin_curve_mm_deg", value: found.curve_mm_deg }, ...branch]);
  assert.ok((await shownWorst(page)).startsWith(um(used)));
  assert.ok(used < (await worst([])), "the search is better than the constant spin");
  // The result belongs to the study that was searched.
  const status = page.locator(".spin-status");
  assert.doesNotMatch(await status.innerText(), /search again/);
  await page.fill("#field-z", "520");
  await settled(page);
  assert.match(await status.innerText(), /search again/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the tooltip has the values of a cell, and a click sends the robot there", async () => {
  const page = await opened();
  const map = await request("POST", "/api/spin-map", { text: STUDY, analysis: "circle" });
  const plot = await page.locator(".spin-border").boundingBox();
  const [x, y] = [plot.x + 0.25 * plot.width, plot.y + 0.5 * plot.height];
  await page.mouse.move(x, y);
  const tip = await page.locator(".spin-tip").innerText();
  const row = map.spins_deg.findIndex((spin) => Math.abs(spin) < 1e-9);
  const near = map.in_plane_um[row].slice(80, 101).map((value) => `${um(value)} µm`);
  assert.ok(near.some((text) => tip.includes(text)), tip);
  await page.mouse.click(x, y);
  await settled(page);
  const point = Number(await page.inputValue("#target-point"));
  assert.ok(point > 80 && point < 102, String(point));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a study that searches its spin shows the searched one, without knots", async () => {
  const page = await open(browser, server.url);
  await page.locator("#tab-study").click();
  await page.locator("textarea").first().fill(STUDY.replace("spin_deg = 10\n", "posture.search = { step_deg = 10 }\n"));
  await page.locator("#tab-live").click();
  await settled(page);
  await page.locator("#panel-spin-map > summary").press("Enter");
  await page.locator(".spin-chosen").waitFor({ state: "attached" });
  assert.equal(await knots(page).count(), 0);
  assert.match(await page.locator(".spin-status").innerText(), /The study searches the spin/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

for (const [name, width, height, dark] of [["a desk", 1280, 800, false], ["a desk, dark", 1280, 800, true], ["a tablet", 820, 1180, false], ["a phone", 390, 844, true]])
  test(`${name}, ${width} x ${height}: nothing beside the screen, no serious finding`, async () => {
    const page = await opened({ width, height, dark });
    await page.locator("#panel-spin-map").scrollIntoViewIfNeeded();
    await page.waitForTimeout(400);
    const beside = await page.evaluate(() => [...document.querySelectorAll("#panel-spin-map *")].filter((e) => {
      const b = e.getBoundingClientRect();
      return b.width > 1 && !e.closest(".spin-tip") && (b.right > innerWidth + 1 || b.left < -1);
    }).map((e) => `${e.tagName}.${e.getAttribute("class")}`));
    assert.deepEqual(beside, []);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), 0);
    const stage = await page.locator(".stage").boundingBox();
    assert.ok(stage.height >= 180, `the scene keeps a height: ${stage.height}`);
    assert.deepEqual(await serious(page), []);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });
