// A pinned state in the scene: its arm, the difference to its values, and the change in the verdict; by keyboard.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { difference, drawn, launch, open, serious, serve, settled, still } from "./setup.mjs";

let server, browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const pinButton = (page) => page.getByRole("button", { name: "Pin this state for comparison" });
const toggle = (page) => page.getByRole("button", { name: "Difference to pinned" });
const legend = (page) => page.locator(".legend").getAttribute("aria-label");
async function change(page, field, value) {
  await page.fill(field, value);
  await settled(page);
}

test("the pinned arm stays, and the verdict says how much the worst deviation changed", async () => {
  const page = await open(browser, server.url);
  await pinButton(page).press("Enter");
  // In the same posture one arm would hide the other.
  await drawn(page);
  assert.ok(await page.locator(".label.pinned").evaluateAll((all) => all.every((e) => getComputedStyle(e).visibility === "hidden")));
  assert.equal(await page.locator(".verdict-change").count(), 0);
  await change(page, "#field-x", "700");
  await page.waitForFunction(() => [...document.querySelectorAll(".label.pinned")].some((e) => getComputedStyle(e).visibility === "visible"));
  // It is a part of the picture that can be hidden.
  const shot = () => page.locator(".stage").screenshot();
  await still(page);
  const shown = await shot();
  await page.locator(".shown summary").press("Enter");
  const box = page.locator(".shown label", { hasText: "Pinned arm" }).locator("input");
  await box.press("Space");
  await page.locator(".shown summary").press("Enter");
  await still(page);
  assert.ok((await difference(page, shown, await shot())) > 0.001);
  // A change that is within the uncertainties is not in the verdict, and the line says so.
  await change(page, "#field-x", "1300");
  const verdict = page.locator(".verdict-change");
  assert.match(await page.locator(".pin").innerText(), /\d\s% more than pinned \(within the uncertainty\)/);
  assert.equal(await verdict.count(), 0);
  await page.getByLabel("Case 1, force along y, newton").fill("-50");
  await settled(page);
  assert.match(await verdict.innerText(), /^· \d+\s% more than pinned$/);
  assert.equal(await verdict.innerText(), `· ${await page.locator(".pin-change").innerText()}`);
  assert.doesNotMatch(await page.locator(".pin").innerText(), /uncertainty/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the difference map is about zero, at the same points only, and ends with the pin", async () => {
  const page = await open(browser, server.url);
  const plain = await legend(page);
  await pinButton(page).press("Enter");
  await toggle(page).press("Enter");
  assert.equal(await toggle(page).getAttribute("aria-pressed"), "true");
  await change(page, "#field-x", "1100");
  const ends = /minus pinned: colours from (\S+) µm to (\S+) µm/.exec(await legend(page));
  assert.ok(ends, await legend(page));
  const number = (text) => Number(text.replace("−", "-"));
  assert.equal(number(ends[1]), -number(ends[2]));
  // The tooltip has the difference too.
  await page.click(".views button:nth-child(5)");
  await drawn(page);
  const stage = await page.locator(".stage").boundingBox();
  await page.mouse.move(stage.x + stage.width / 2 + 9, stage.y + stage.height / 2 + 7);
  assert.match(await page.locator(".stage .tip").innerText(), /minus pinned\s+[+−]?[\d.]+ µm/);
  // Another layer: the pinned values of it are requested.
  await page.selectOption("#layer", "normal_um");
  await settled(page);
  await page.waitForFunction(() => /normal, minus pinned/.test(document.querySelector(".legend").getAttribute("aria-label")));
  await page.selectOption("#layer", "largest_share");
  await settled(page);
  assert.match(await page.locator(".pin").innerText(), /Contributors have no difference/);
  await page.selectOption("#layer", "in_plane_um");
  // Other points: said, and the plain layer is shown.
  await change(page, "#field-step", "40");
  assert.match(await page.locator(".pin").innerText(), /has other points/);
  assert.doesNotMatch(await legend(page), /minus pinned/);
  await page.locator(".pin").getByRole("button", { name: "Unpin" }).press("Enter");
  assert.ok(await page.locator(".pin").isHidden());
  assert.doesNotMatch(await legend(page), /minus pinned/);
  assert.match(plain, /^Colours from/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

for (const [name, width, height, dark] of [["a desk", 1280, 800, true], ["a tablet", 820, 1180, false], ["a phone", 390, 844, false]])
  test(`${name}, ${width} x ${height}: pinned and different, nothing is cut off, no serious finding`, async () => {
    const page = await open(browser, server.url, { width, height, dark });
    await pinButton(page).press("Enter");
    await toggle(page).press("Enter");
    await page.locator("#field-x").scrollIntoViewIfNeeded();
    await change(page, "#field-x", "1300");
    await page.getByLabel("Case 1, force along y, newton").fill("-50");
    await settled(page);
    const cut = await page.evaluate(() => ({
      page: document.documentElement.scrollWidth - innerWidth,
      beside: [...document.querySelectorAll(".pin *, .verdict *")].filter((e) => {
        const b = e.getBoundingClientRect();
        return b.width > 1 && (b.right > innerWidth + 1 || b.left < -1);
      }).map((e) => `${e.tagName}.${e.className}`),
      tall: [...document.querySelectorAll(".verdict")].filter((e) => e.scrollHeight > e.clientHeight + 1).length,
    }));
    assert.deepEqual(cut, { page: 0, beside: [], tall: 0 });
    assert.deepEqual(await serious(page), []);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });
