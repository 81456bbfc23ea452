// A pinned state, and the present one compared with it; by keyboard.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { client, launch, open, serve, settled, um } from "./setup.mjs";

let server, browser, request;
before(async () => {
  server = await serve();
  browser = await launch();
  request = client(server.url);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

test("pin a state, change a value, swap, unpin", async () => {
  const page = await open(browser, server.url);
  const { text } = await request("GET", "/api/study");
  const worst = async (of) => (await request("POST", "/api/answer", { text: of, analysis: "Fig. 6" })).maps[0].worst.in_plane_um;
  const pinned = await worst(text);
  await page.getByRole("button", { name: "Pin this state for comparison" }).press("Enter");
  await page.locator(".pin").waitFor();
  assert.match(await page.locator(".pin").innerText(), /the same as pinned/);
  const x = await page.inputValue("#field-x");
  await page.fill("#field-x", "1100");
  await settled(page);
  const changed = await request("POST", "/api/change", { text, analysis: "Fig. 6", changes: [{ key: "plane.centre_mm[0]", value: 1100 }] }).catch(() => null);
  const share = await page.locator(".pin-change").innerText();
  assert.match(share, /^\d+\s% (less|more) than pinned$/);
  assert.ok((await page.locator(".pin").innerText()).includes(`worst ${um(pinned)} µm`));
  if (changed && changed.problems.length === 0) {
    const now = await worst(changed.text);
    assert.equal(share.replace(/\s/g, " "), `${Math.round(100 * Math.abs(now / pinned - 1))} % ${now < pinned ? "less" : "more"} than pinned`);
  }
  await page.locator(".pin").getByRole("button", { name: "Swap" }).press("Enter");
  await page.waitForFunction((x) => document.querySelector("#field-x").value === x, x);
  await settled(page);
  assert.match(await page.locator(".pin-change").innerText(), share.includes("less") ? /more/ : /less/);
  await page.locator(".pin").getByRole("button", { name: "Unpin" }).press("Enter");
  assert.ok(await page.locator(".pin").isHidden());
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});
