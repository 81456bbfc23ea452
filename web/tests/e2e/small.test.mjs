// Tablets, phones, and 200 % zoom: the scene has a height and can be used, nothing is cut off.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { drawn, launch, open, serious, serve, settled } from "./setup.mjs";

let server, browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

// The last one is a screen of 1280 x 800 at 200 %.
for (const [name, width, height] of [["a tablet", 820, 1180], ["a phone", 390, 844], ["200 % zoom", 640, 400]])
  test(`${name}, ${width} x ${height}: verdict and scene first, all controls, nothing beside the screen`, async () => {
    const page = await open(browser, server.url, { width, height });
    const stage = await page.locator(".stage").boundingBox();
    assert.ok(stage.height >= 300 && stage.width > 0.95 * width - 20, JSON.stringify(stage));
    const verdict = await page.locator(".verdict").boundingBox();
    assert.ok(verdict.y < stage.y && stage.y < height, "verdict, then scene, on the first screen");
    const canvas = await page.locator(".stage canvas").boundingBox();
    assert.ok(Math.abs(canvas.height - stage.height) < 3);
    const cut = await page.evaluate(() => ({
      page: document.documentElement.scrollWidth - innerWidth,
      beside: [...document.querySelectorAll(".brand, .theme, .verdict *, .views, .shown, .scales, .colours, .left *, .right *")].filter((e) => {
        const b = e.getBoundingClientRect();
        return b.width > 1 && getComputedStyle(e).visibility !== "hidden" && !e.closest("[popover]") && (b.right > innerWidth + 1 || b.left < -1);
      }).map((e) => `${e.tagName}.${e.className} ${e.textContent.slice(0, 40)}`),
      tall: [...document.querySelectorAll(".verdict")].filter((e) => e.scrollHeight > e.clientHeight + 1).length,
    }));
    assert.deepEqual(cut, { page: 0, beside: [], tall: 0 });
    assert.deepEqual(await serious(page), []);
    // Cards over the scene do not cover each other.
    const cards = await page.locator(".overlay > .card:visible").evaluateAll((all) => all.map((e) => e.getBoundingClientRect().toJSON()));
    for (const [i, a] of cards.entries()) for (const b of cards.slice(i + 1)) assert.ok(a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top, "cards over each other");
    // Settings and panels are reached by scrolling; a change arrives.
    await page.locator("#field-x").scrollIntoViewIfNeeded();
    await page.fill("#field-x", "900");
    await settled(page);
    await page.locator("#panel-joints").scrollIntoViewIfNeeded();
    assert.equal(await page.locator("#panel-joints .bar-value").count(), 6);
    // A tap on the plate sends the robot.
    await page.locator(".stage").scrollIntoViewIfNeeded();
    await page.click(".views button:nth-child(5)");
    await drawn(page);
    const now = await page.locator(".stage").boundingBox();
    await page.mouse.click(now.x + now.width / 2 + 9, now.y + now.height / 2 + 7);
    await settled(page);
    assert.match(await page.locator("#panel-point .facts dd").first().innerText(), /^900, /);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });
