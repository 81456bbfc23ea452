// Direct manipulation: handles move and turn the part and move the tool, the deviation follows; the tip of the tool is
// dragged over the part.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { drawn, launch, open, serve, settled } from "./setup.mjs";

let browser, server;
before(async () => {
  browser = await launch();
  server = await serve();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** In the view of the plate its centre is the centre of the picture. Arrows and rings are 0.19 of half its height. */
async function plate(page) {
  await page.click(".views button:nth-child(5)");
  await drawn(page);
  const box = await page.locator(".stage canvas").boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2, arm: 0.16 * (box.height / 2), ring: 0.19 * (box.height / 2) };
}

async function drag(page, from, to) {
  await drawn(page);
  await page.mouse.move(from.x, from.y);
  await page.mouse.move(from.x + 1, from.y);
  await page.mouse.down();
  for (let i = 1; i <= 8; i++) await page.mouse.move(from.x + ((to.x - from.x) * i) / 8, from.y + ((to.y - from.y) * i) / 8);
  await page.mouse.up();
  await settled(page);
}
const value = async (page, field) => Number(await page.inputValue(`#field-${field}`));

test("the part is moved along an arrow, in steps, and back as one change", async () => {
  const page = await open(browser, server.url);
  const { x, y, arm } = await plate(page);
  const before = { x: await value(page, "x"), y: await value(page, "y"), z: await value(page, "z") };
  const deviation = await page.locator(".verdict-points").innerText();
  await page.click("[data-handle='move part']");
  await drag(page, { x, y: y - arm }, { x, y: y - arm - 70 });
  const after = { x: await value(page, "x"), y: await value(page, "y"), z: await value(page, "z") };
  assert.ok(after.z > before.z, `${after.z} is above ${before.z}`);
  assert.equal((after.z - before.z) % 10, 0, "snapped");
  assert.deepEqual([after.x, after.y], [before.x, before.y]);
  assert.notEqual(await page.locator(".verdict-points").innerText(), deviation);
  await page.keyboard.press("Control+z");
  await settled(page);
  assert.equal(await value(page, "z"), before.z, "one step back");
  // Without snapping it moves by any amount; the handle stays where the part is.
  await page.locator(".handles .snap input").uncheck();
  await plate(page);
  await drag(page, { x, y: y - arm }, { x, y: y - arm - 33 });
  assert.notEqual((await value(page, "z")) % 10, 0);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the part is turned about y: its tilt follows", async () => {
  const page = await open(browser, server.url);
  const { x, y, ring } = await plate(page);
  await page.click("[data-handle='turn part']");
  const before = await value(page, "tilt");
  await drag(page, { x, y: y - ring }, { x, y: y - ring - 60 });
  const after = await value(page, "tilt");
  assert.notEqual(after, before);
  assert.equal((after - before) % 5, 0, "snapped");
  // Typed, and by the keyboard: the button is reached and pressed without the mouse.
  await page.focus("[data-handle='turn part']");
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("[data-handle='turn part']", "aria-pressed"), "false");
  await page.context().close();
});

test("the tool is moved on the flange; its tip is dragged over the plate", async () => {
  const page = await open(browser, server.url);
  const { x, y, arm } = await plate(page);
  await page.mouse.click(x, y);
  await settled(page);
  const before = await page.inputValue("#target-y");
  await drag(page, { x, y }, { x: x + 80, y });
  // The robot follows the tip.
  await page.waitForFunction((before) => document.querySelector("#target-y").value !== before, before);
  await drag(page, { x: x + 80, y }, { x, y });
  await page.click("[data-handle='move tool']");
  const text = async () => {
    await page.click("#tab-study");
    const study = await page.locator("#study-text").inputValue();
    await page.click("#tab-live");
    return study;
  };
  const tool = await text();
  // One of the two arrows across the tool is upright or lies on its side.
  await drag(page, { x, y: y - arm }, { x, y: y - arm - 40 });
  if ((await text()) === tool) await drag(page, { x: x + arm, y }, { x: x + arm + 40, y });
  if ((await text()) === tool) await drag(page, { x: x - arm, y }, { x: x - arm - 40, y });
  assert.notEqual(await text(), tool);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the tool is turned by a ring; values of a handle are typed next to it", async () => {
  const page = await open(browser, server.url);
  const { x, y, ring } = await plate(page);
  await page.mouse.click(x, y);
  await settled(page);
  await page.click("[data-handle='turn tool']");
  const values = () => page.locator(".handle-fields input").evaluateAll((all) => all.map((box) => Number(box.value)));
  assert.deepEqual(await values(), [0, 0, 0]);
  // The axis of the tool is across the picture: its ring is a circle.
  await drag(page, { x: x + ring * 0.71, y: y - ring * 0.71 }, { x: x + ring * 0.71 + 60, y: y - ring * 0.71 + 60 });
  const turned = await values();
  assert.ok(turned.some((deg) => deg !== 0) && turned.every((deg) => deg % 5 === 0), turned.join());
  await page.keyboard.press("Control+z");
  await settled(page);
  assert.deepEqual(await values(), [0, 0, 0]);
  await page.getByLabel("rz, °").fill("30");
  await settled(page);
  assert.deepEqual(await values(), [0, 0, 30]);
  await page.getByLabel("rz, °").fill("x");
  assert.equal(await page.getByLabel("rz, °").getAttribute("aria-invalid"), "true");
  await page.click("[data-handle='move part']");
  await page.getByLabel("z, mm", { exact: true }).fill("950");
  await settled(page);
  assert.equal(await value(page, "z"), 950);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});
