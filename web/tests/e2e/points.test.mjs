// Values under the pointer, and clicks, where there are many points: in a volume, and along a path of more than 4000 points.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { client, drawn, launch, open, serve, settled } from "./setup.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());
const plain = (text) => text.replace(/[\u00a0\u202f]/g, " ");
const number = (text) => Number(/[−\d.]+/.exec(text.replace(/\u202f/g, ""))[0].replace("−", "-"));
const tip = async (page) => Object.fromEntries(await page.locator(".tip dt").evaluateAll((all) => all.map((dt) => [dt.textContent, dt.nextElementSibling.textContent])));
/** Moves the pointer over the scene until a point is under it. */
async function overPoint(page) {
  const box = await page.locator(".stage").boundingBox();
  for (let i = 0; i < 24; i++)
    for (let j = 0; j < 24; j++) {
      const [x, y] = [box.x + box.width * (0.3 + 0.4 * (i / 24)), box.y + box.height * (0.2 + 0.5 * (j / 24))];
      await page.mouse.move(x, y);
      if (await page.locator(".tip").isVisible()) return [x, y];
    }
  throw new Error("no point is under the pointer");
}

const BOX = `format = 1
robot = "yaskawa/mh12"
tolerance_um = 300
tool = { flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }
plane = { centre_mm = [1000, 0, 800], half_size_mm = 150, step_mm = 25 }
load = { cases_n = [[6, 10, 10], [6, -10, 10]] }
[[analysis]]
kind = "volume"
name = "space"
box = { half_size_mm = [200, 200, 200], step_mm = 40, centre_mm = [900, 0, 800] }
`;
test("a volume: sections with values under the pointer, a click sends the robot there, x, y and z move the box", async () => {
  const own = await serve(() => BOX);
  const page = await open(browser, own.url);
  const request = client(own.url);
  assert.match(await page.locator(".legend").getAttribute("aria-label"), /^Colours from \d/);
  const at = await overPoint(page);
  const rows = await tip(page);
  const { scene } = await request("POST", "/api/view", { text: BOX, analysis: "space" });
  const point = Number(rows.Point) - 1;
  assert.ok(Math.abs(number(rows["In plane"]) - scene.points.columns.in_plane_um[point]) < 0.6);
  await page.mouse.click(...at);
  await settled(page);
  assert.equal(await page.inputValue("#target-point"), String(point + 1));
  const position = plain(await page.locator("#panel-point .facts dd").first().innerText()).replaceAll("−", "-").replace(" mm", "").split(", ").map(Number);
  assert.deepEqual(position.map(Math.round), scene.points.xyz_mm[point].map(Math.round));
  await page.fill("#field-x", "1000");
  await settled(page);
  const moved = (await request("POST", "/api/change", { text: BOX, analysis: "space", changes: [{ key: "box.centre_mm", value: [1000, 0, 800] }] })).text;
  const [volume] = (await request("POST", "/api/answer", { text: moved, analysis: "space" })).volumes;
  assert.equal(number(await page.locator("[data-follow=worst] .extreme-value").innerText()), Number(volume.worst.in_plane_um.toFixed(volume.worst.in_plane_um < 99.95 ? 1 : 0)));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await own.stop();
});

test("a path of 13 000 points: values under the pointer, a click sends the robot there, the force has its value", async () => {
  // Without its part, which the tool path would cover.
  const own = await serve((text) => text.replace(/\[analysis\.machined_part\][^]*?(?=\[place\])/, ""), "r2000ic-pocket");
  const page = await open(browser, own.url);
  const text = readFileSync(`${own.folder}/study.toml`, "utf8");
  const { scene } = await client(own.url)("POST", "/api/view", { text, analysis: "pocket" });
  assert.ok(scene.points.xyz_mm.length > 4000);
  assert.match(await page.locator(".label.force").textContent(), /^force [\d.]+ N$/);
  await page.click(".views button:nth-child(5)");
  await drawn(page);
  const at = await overPoint(page);
  const rows = await tip(page);
  const point = Number(rows.Point) - 1;
  assert.ok(Math.abs(number(rows["In plane"]) - scene.points.columns.in_plane_um[point]) < 0.6);
  await page.mouse.click(...at);
  await settled(page);
  assert.equal(await page.inputValue("#target-point"), String(point + 1));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await own.stop();
});
