// The machined part on the live page: numbers and places of the answer, its surface in the scene, what is under the pointer, material along
// the path, both themes, a phone.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { client, difference, drawn, launch, open, serious, serve, settled, still, um, until } from "./setup.mjs";

/** The pocket of the examples with coarse cells, and further keys of its part. */
const coarse = (given, keys = "") => given.replace("cell_mm = 0.5", `cell_mm = 1\n${keys}`);
/** Depth of the pocket, mm. */
const FLOOR_MM = -6;
let server, text, answer, count, lines, browser;
before(async () => {
  server = await serve((given) => coarse(given), "r2000ic-pocket");
  text = readFileSync(`${server.folder}/study.toml`, "utf8");
  const ask = client(server.url);
  answer = (await ask("POST", "/api/answer", { text, analysis: "pocket" })).paths[0].machined_part;
  const { path } = await ask("POST", "/api/view", { text, analysis: "pocket", columns: true });
  count = path.points;
  const at = new URL(server.url);
  const response = await fetch(new URL("/api/path-columns", at), { method: "POST", headers: { Authorization: `Bearer ${at.searchParams.get("token")}`, "Content-Type": "application/json" }, body: JSON.stringify({ text, analysis: "pocket", keys: ["line"] }) });
  lines = new Float32Array(await response.arrayBuffer());
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** The points of the path that the material shown is cut by. */
const points = (page) => page.evaluate(() => Number(document.querySelector(".stage").dataset.part || NaN));
const shown = (page, expected = count) => page.waitForFunction((expected) => document.querySelector(".stage").dataset.part === String(expected) && document.querySelector("#panel-machined").getAttribute("aria-busy") === "false", expected);
const picture = async (page) => {
  await still(page);
  return page.locator(".stage > canvas").screenshot();
};
const plain = (words) => words.replace(/[\u00a0\u202f]/g, " ").replaceAll("−", "-");
const signed = (value) => (value > 0 ? "+" : "") + um(value);

/** A page with the finished part, seen along the normal of the plate. */
async function opened(options) {
  const page = await open(browser, server.url, options);
  await shown(page);
  await page.click(".views button:nth-child(5)");
  await drawn(page);
  return page;
}

/** A place inside of the pocket in the picture: between its corners, which are the worst places. */
async function middle(page) {
  // A label that another one would cover is not seen.
  const places = await page.locator(".label.place").evaluateAll((all) => all.filter((label) => label.style.visibility === "visible").map((label) => label.getBoundingClientRect().toJSON()));
  return ["x", "y"].map((k) => places.reduce((sum, box) => sum + box[k] / places.length, 0));
}

test("the panel has the numbers, places and features of the answer; a place is looked at", async () => {
  const page = await opened();
  const panel = page.locator("#panel-machined");
  const figures = await panel.locator(".figure-value").allInnerTexts();
  assert.deepEqual(figures.slice(0, 2), [signed(answer.most_left_um), signed(answer.most_gouged_um)]);
  assert.equal(plain(figures[2]), `${Math.round(100 * answer.fraction_within)} %`);
  const rows = panel.locator(".worst-places button");
  assert.equal(await rows.count(), answer.worst_places.length);
  for (const [i, { deviation_um, u_um, line, cause }] of answer.worst_places.entries()) {
    const row = await rows.nth(i).innerText();
    for (const part of [`${signed(deviation_um)} ± ${um(u_um)} µm`, `line ${line}`, cause]) assert.ok(row.includes(part), `${row}: ${part}`);
  }
  const table = await panel.locator(".machined-features tbody tr").allInnerTexts();
  assert.equal(table.length, answer.features.length);
  for (const [i, { name, mean_um, profile_um }] of answer.features.entries()) assert.ok(table[i].startsWith(name) && table[i].includes(signed(mean_um)) && table[i].includes(um(profile_um)), table[i]);
  const labels = () => page.locator(".label.place").evaluateAll((all) => all.map((label) => label.textContent));
  assert.deepEqual(await labels(), answer.worst_places.map((_, i) => String(i + 1)));
  const before = await picture(page);
  await rows.first().click();
  assert.ok((await difference(page, before, await picture(page))) > 0.02, "the camera has moved");
  // The place is in the middle of the picture.
  const stage = await page.locator(".stage").boundingBox();
  const label = await page.locator(".label.place").first().boundingBox();
  assert.ok(Math.hypot(label.x + label.width / 2 - stage.x - stage.width / 2, label.y + label.height / 2 - stage.y - stage.height / 2) < 25);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the slider displaces the surface without a request; a switch hides it, and the tool path has one of its own", async () => {
  const page = await opened();
  let requests = 0;
  page.on("request", (request) => (requests += Number(request.url().endsWith("/api/part-surface"))));
  const nominal = await picture(page);
  const slider = page.locator("#machined-magnified");
  assert.equal(await page.locator(".machined-scale output").innerText(), "nominal");
  await slider.focus();
  await page.keyboard.press("End");
  assert.equal(await page.locator(".machined-scale output").innerText(), "deviation × 100");
  const displaced = await picture(page);
  assert.ok((await difference(page, nominal, displaced)) > 0.002, "walls are displaced by up to 18 mm");
  await page.keyboard.press("Home");
  assert.ok((await difference(page, nominal, await picture(page))) < 1e-3);
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.locator(".machined-scale output").innerText(), "deviation × 1");
  await page.keyboard.press("Home");
  await page.click(".shown summary");
  const path = page.getByLabel("Tool path", { exact: true });
  assert.equal(await path.isChecked(), false, "the tool path covers the part");
  assert.equal(await page.locator("#layer").isVisible(), false);
  await path.check();
  assert.equal(await page.locator("#layer").isVisible(), true);
  assert.ok((await difference(page, nominal, await picture(page))) > 0.002);
  const machined = page.getByLabel("Machined part", { exact: true });
  await machined.uncheck();
  assert.ok(Number.isNaN(await points(page)));
  assert.equal(await page.locator(".part-legend").isVisible(), false);
  assert.match(await page.locator("#panel-machined").innerText(), /Not shown/);
  await machined.check();
  assert.equal(await points(page), count);
  assert.equal(requests, 0);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("under the pointer are the deviation with its uncertainty and the line that made the surface; a click sends the robot there", async () => {
  const page = await opened();
  const stage = await page.locator(".stage").boundingBox();
  const [x, y] = await middle(page);
  await page.mouse.move(x, y);
  const tip = page.locator(".tip");
  const words = plain(await tip.innerText());
  assert.match(words, /Deviation\s+[+-]?[\d.]+ ± [\d.]+ µm/);
  const line = Number(/Made by\s+line (\d+)/.exec(words)[1]);
  await page.mouse.click(x, y);
  await settled(page);
  const point = Number(await page.inputValue("#target-point")) - 1;
  assert.equal(lines[point], line);
  assert.equal(await points(page), count, "the part stays finished");
  // The stock around has no deviation, and sends the robot nowhere.
  await page.mouse.move(x, y - 5);
  let [at, stock] = [x, ""];
  while (!/stock/.test(stock) && (at += 6) < stage.x + stage.width) {
    await page.mouse.move(at, y);
    stock = plain(await tip.innerText().catch(() => ""));
  }
  assert.match(stock, /Deviation\s+not known\s+Made by\s+the stock: not cut$/);
  await page.mouse.click(at, y);
  await settled(page);
  assert.equal(Number(await page.inputValue("#target-point")) - 1, point);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("scrubbing and play show the material at the point, the end the finished part; a switch chooses by hand", async () => {
  const page = await opened();
  const pressed = () => page.locator("#panel-machined .switch [aria-pressed=true]").innerText();
  assert.equal(await pressed(), "Finished");
  await page.locator(".charts").focus();
  await page.keyboard.press("Home");
  await shown(page, 1);
  assert.equal(await pressed(), "At the point");
  assert.equal(await page.locator(".part-legend").isVisible(), false, "material in process is plain");
  await settled(page);
  const first = await picture(page);
  await page.selectOption("#play-speed", { label: "whole path in 60 s" });
  await page.click(".play");
  const seen = new Set();
  await until(async () => seen.add(await points(page)).size > 4);
  assert.ok([...seen].every((now, i, all) => i === 0 || now > all[i - 1]), `material only goes away: ${[...seen]}`);
  // A busy machine shows few states of a quick play.
  await page.selectOption("#play-speed", { label: "whole path in 5 s" });
  await shown(page);
  assert.equal(await pressed(), "Finished");
  assert.equal(await page.locator(".part-legend").isVisible(), true);
  // Where the robot is, by hand; then the finished part again, which a worst place also chooses.
  await page.locator(".charts").focus();
  await page.keyboard.press("PageDown");
  await settled(page);
  const there = Number(await page.inputValue("#target-point"));
  await shown(page, there);
  assert.ok((await difference(page, first, await picture(page))) > 0.002);
  await page.click("#panel-machined .switch button:first-child");
  await shown(page);
  await page.click("#panel-machined .switch button:last-child");
  await shown(page, there);
  await page.locator(".worst-places button").first().click();
  await shown(page);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a change of the study cuts the part again; what cannot be cut is said in a sentence", async () => {
  const page = await opened();
  const most = () => page.locator("#panel-machined .figure-value").first().innerText();
  const before = await most();
  await page.fill("#field-x", "1850");
  await page.keyboard.press("Enter");
  await page.waitForFunction((before) => document.querySelector("#panel-machined .figure-value").textContent !== before, before);
  await shown(page);
  const moved = await client(server.url)("POST", "/api/answer", { text: text.replace("centre_mm = [1700,", "centre_mm = [1850,"), analysis: "pocket" });
  assert.equal(await most(), signed(moved.paths[0].machined_part.most_left_um));
  await page.route("**/api/part-surface", (route) => route.fulfill({ status: 400, contentType: "application/json", body: JSON.stringify({ error: { kind: "invalid-input", message: "the mesh of the stock has no triangle", hint: null, problems: [] } }) }));
  await page.fill("#field-x", "1800");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /no triangle/.test(document.querySelector("#panel-machined").textContent));
  assert.ok(Number.isNaN(await points(page)));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("with a scan, colours and surface show what was measured, and what differs from the prediction", async () => {
  // Points of the floor of the pocket, 60 um above it.
  const own = await serve((given) => coarse(given, 'scan = { file = "scan.xyz", align = "none" }'), "r2000ic-pocket");
  const ends = answer.worst_places.map(({ xyz_mm }) => xyz_mm);
  const [low, high] = [0, 1].map((k) => [Math.min(...ends.map((at) => at[k])) + 6, Math.max(...ends.map((at) => at[k])) - 6]);
  const grid = ([from, to]) => Array.from({ length: 60 }, (_, i) => from + ((to - from) * i) / 59);
  writeFileSync(`${own.folder}/scan.xyz`, grid(low).flatMap((x) => grid(high).map((y) => `${x.toFixed(3)} ${y.toFixed(3)} ${(FLOOR_MM + 0.06).toFixed(3)}`)).join("\n"));
  const page = await open(browser, own.url);
  await shown(page);
  await page.click(".views button:nth-child(5)");
  const choice = page.locator("#machined-quantity");
  assert.deepEqual(await choice.locator("option").allInnerTexts(), ["Predicted", "Measured (scan)", "Measured minus predicted"]);
  const predicted = await picture(page);
  await choice.selectOption("measured_um");
  assert.match(await page.locator(".part-legend").getAttribute("aria-label"), /^Measured deviation of the surface: colours from/);
  const measured = await picture(page);
  assert.ok((await difference(page, predicted, measured)) > 0.002);
  const [x, y] = await middle(page);
  await page.mouse.move(x, y);
  assert.match(plain(await page.locator(".tip").innerText()), /Measured\s+(\+60\.0 µm|between points)/);
  await choice.selectOption("measured_less_predicted_um");
  assert.match(await page.locator(".part-legend").getAttribute("aria-label"), /^Measured minus predicted: /);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await own.stop();
});

test("both themes; only an analysis with a part has its panel", async () => {
  const page = await opened();
  const swatch = () => page.locator(".mark.plain").evaluate((mark) => getComputedStyle(mark).backgroundColor);
  const [light, colour] = [await picture(page), await swatch()];
  await page.click("button.theme");
  assert.notEqual(await swatch(), colour);
  assert.ok((await difference(page, light, await picture(page))) > 0.05);
  assert.equal(await points(page), count);
  await page.locator("#panel-machined").scrollIntoViewIfNeeded();
  assert.deepEqual(await serious(page, "#panel-machined"), []);
  await page.context().close();
  const own = await serve();
  const other = await open(browser, own.url);
  assert.equal(await other.locator("#panel-machined").isVisible(), false);
  await other.click(".shown summary");
  assert.equal(await other.getByLabel("Tool path", { exact: true }).isVisible(), false);
  await other.context().close();
  await own.stop();
});

test("a phone, 390 x 844: the panel is under the scene and nothing is cut off", async () => {
  const page = await opened({ width: 390, height: 844 });
  const cut = await page.evaluate(() => ({
    page: document.documentElement.scrollWidth - innerWidth,
    beside: [...document.querySelectorAll("#panel-machined *")].filter((e) => {
      const box = e.getBoundingClientRect();
      return box.width > 1 && (box.right > innerWidth + 1 || box.left < -1);
    }).map((e) => `${e.tagName}.${e.className}`),
  }));
  assert.deepEqual(cut, { page: 0, beside: [] });
  assert.deepEqual(await serious(page, "#panel-machined"), []);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});
