// Layers: colours, legend and tooltip follow the chosen quantity; its values are those of the table.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { client, difference, drawn, launch, open, serve, settled, STUDY } from "./setup.mjs";

const text = readFileSync(STUDY, "utf8");
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
const KEYS = ["in_plane_um", "normal_um", "full_um", "in_plane_u_um", "probability_within", "limit_margin_deg", "largest_share"];

test("a map: each layer has its legend, its colours and its value in the tooltip", async () => {
  const page = await open(browser, server.url);
  await page.click(".views button:nth-child(5)");
  await drawn(page);
  const sent = [];
  page.on("request", (r) => r.url().endsWith("/api/view") && sent.push(r.postDataJSON().layer));
  assert.deepEqual(await page.locator("#layer option").evaluateAll((all) => all.map((o) => o.value)), KEYS);
  const legend = page.locator(".legend");
  const box = await page.locator(".stage").boundingBox();
  let before = await page.locator(".stage").screenshot();
  for (const key of KEYS.slice(1)) {
    await page.selectOption("#layer", key);
    await settled(page);
    const { layer, answer } = await request("POST", "/api/view", { text, analysis: "Fig. 6", layer: { key } });
    const title = await page.locator("#layer option:checked").innerText();
    assert.match(await legend.getAttribute("aria-label"), new RegExp(`^${title}: `));
    await page.mouse.move(box.x + box.width * 0.41, box.y + box.height * 0.4);
    await page.locator(".tip dt").first().waitFor();
    const rows = Object.fromEntries(await page.locator(".tip dt").evaluateAll((all) => all.map((dt) => [dt.textContent, dt.nextElementSibling.textContent])));
    const [y, z] = rows["y′, z′"].replace(" mm", "").replaceAll("−", "-").split(", ").map(Number);
    const { y_mm, z_mm } = answer.maps[0].grid;
    const value = layer.values[0][z_mm.indexOf(z) * y_mm.length + y_mm.indexOf(y)];
    const shown = rows[title] ?? rows[{ normal_um: "Normal", full_um: "Full" }[key]];
    if (key === "largest_share") assert.equal(shown, layer.names[value]);
    else assert.ok(Math.abs(Number(/[−\d.]+/.exec(shown)[0].replace("−", "-")) / (key === "probability_within" ? 100 : 1) - value) < (Math.abs(value) > 99 ? 0.6 : 0.06), `${key}: ${shown}, ${value}`);
    await page.mouse.move(5, 5);
    const now = await page.locator(".stage").screenshot();
    assert.ok((await difference(page, before, now)) > 0.002, `${key} has colours of its own`);
    before = now;
  }
  assert.deepEqual(sent.map((layer) => layer?.key), KEYS.slice(1), "one question a layer");
  // The first one needs no question: its values are in every answer.
  await page.selectOption("#layer", "in_plane_um");
  await page.waitForTimeout(300);
  assert.equal(sent.length, KEYS.length - 1);
  assert.match(await legend.getAttribute("aria-label"), /^Colours from /);
  await page.fill("#field-x", "820");
  await settled(page);
  assert.equal(sent.at(-1), null);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the chosen layer stays while values change, for a path and for holes too", async () => {
  const own = await serve((text) => text, "kr210-rivets");
  const page = await open(browser, own.url);
  await page.selectOption("#layer", "limit_margin_deg");
  await settled(page);
  await page.fill("#field-x", "1850");
  await settled(page);
  assert.equal(await page.inputValue("#layer"), "limit_margin_deg");
  assert.match(await page.locator(".legend").getAttribute("aria-label"), /^Margin to the joint limits: colours from/);
  await page.selectOption("#layer", "largest_share");
  await settled(page);
  assert.ok((await page.locator(".legend .named span").count()) >= 1);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await own.stop();
  const other = await open(browser, server.url);
  await other.selectOption("#field-analysis", "(ii) vertical plate, tool 100 mm, elbow up");
  await other.selectOption("#layer", "full_um");
  await settled(other);
  assert.match(await other.locator(".legend").getAttribute("aria-label"), /^Full deviation: colours from/);
  await other.context().close();
});
