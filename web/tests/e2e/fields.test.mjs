// Every table of the study as fields: what is typed is in the text, comments kept; what is wrong is told at its field.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { client, launch, open, serve, settled } from "./setup.mjs";

let server, browser, request;
before(async () => {
  server = await serve((text) => text.replace(/\[place\]\n(.+\n)+/, ""));
  browser = await launch();
  request = client(server.url);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const field = (page, path) => page.locator(`.row[data-path="${path}"]`);
const unfold = async (page, path) => {
  await page.locator(`[data-table="${path}"] > summary`).click();
  await page.locator(`[data-table="${path}"] .fold-body .row`).first().waitFor();
};
const fine = (page) => page.waitForSelector(".problems .fine");

test("[place] by fields: made, changed, wrong, taken away; the comments stay", async () => {
  const page = await open(browser, server.url);
  await page.click("#tab-jobs");
  await page.getByRole("button", { name: "Bounds: [place]" }).click();
  await fine(page);
  const text = () => page.inputValue("#study-text");
  const before = await text();
  const [least, most] = [field(page, "place.x_mm").locator("input").nth(0), field(page, "place.x_mm").locator("input").nth(1)];
  await least.fill("700");
  await most.fill("1100");
  await most.press("Tab");
  await page.waitForFunction(() => document.querySelector("#study-text").value.includes("x_mm = [700, 1100]"));
  assert.match(await text(), /\[place\]\nx_mm = \[700, 1100\]/);
  assert.match(await text(), /# Fig. 6: a vertical plate/);
  await field(page, "place.objective").locator("select").selectOption("mean");
  await page.waitForFunction(() => document.querySelector("#study-text").value.includes('objective = "mean"'));
  await fine(page);
  // Beyond its bounds: told by the server, at the field.
  await field(page, "place.margin_deg").locator("input").fill("120");
  await field(page, "place.margin_deg").locator("input").press("Tab");
  await page.waitForSelector('.row[data-path="place.margin_deg"] [aria-invalid=true]');
  assert.match(await field(page, "place.margin_deg").locator(".field-error").innerText(), /must be at most 90° \(got 120°\)/);
  assert.equal(await page.locator('[data-table="place"].wrong').count(), 1);
  // Not a number: reported before any request.
  const margin = field(page, "place.margin_deg").locator("input");
  await margin.fill("wide");
  await margin.press("Tab");
  assert.match(await field(page, "place.margin_deg").locator(".field-error").innerText(), /"wide" is not a number/);
  await margin.fill("");
  await margin.press("Tab");
  await fine(page);
  assert.doesNotMatch(await text(), /margin_deg/);
  await page.getByRole("button", { name: "Save", exact: true }).click();
  await page.getByText("Saved.", { exact: true }).waitFor();
  assert.equal(readFileSync(join(server.folder, "study.toml"), "utf8"), await text());
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("[posture.search], [tool] and the analyses as fields; their changes are answered", async () => {
  const page = await open(browser, server.url);
  await page.click("#tab-study");
  await fine(page);
  await unfold(page, "posture");
  await unfold(page, "posture.search");
  await field(page, "posture.search.step_deg").locator("input").fill("15");
  await field(page, "posture.search.step_deg").locator("input").press("Tab");
  await page.waitForFunction(() => /search = \{ step_deg = 15 \}/.test(document.querySelector("#study-text").value));
  await fine(page);
  await unfold(page, "load");
  const cases = field(page, "load.cases_n").locator("input");
  const forces = JSON.parse(await cases.inputValue());
  await cases.fill("three");
  await cases.press("Tab");
  assert.match(await field(page, "load.cases_n").locator(".field-error").innerText(), /A list belongs here/);
  await cases.fill(JSON.stringify(forces.map((f) => f.map((v) => 2 * v))));
  await cases.press("Tab");
  await fine(page);
  await page.click("#tab-live");
  await settled(page);
  const doubled = await request("POST", "/api/change", { text: readFileSync(join(server.folder, "study.toml"), "utf8"), analysis: null, changes: [{ key: "load.cases_n", value: forces.map((f) => f.map((v) => 2 * v)) }] });
  const { maps } = await request("POST", "/api/answer", { text: doubled.text, analysis: "Fig. 6" });
  assert.ok((await page.locator("[data-follow=worst] .extreme-value").innerText()).startsWith(String(Math.round(maps[0].worst.in_plane_um))));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("an analysis is added, filled in, answered and removed again; so is a list in it", async () => {
  const page = await open(browser, server.url);
  await page.click("#tab-study");
  await fine(page);
  const text = () => page.inputValue("#study-text");
  const before = await text();
  const analyses = (before.match(/^\[\[analysis\]\]/gm) ?? []).length;
  const at = `analysis[${analyses}]`;
  await page.getByRole("button", { name: "Add analysis", exact: true }).click();
  await field(page, `${at}.kind`).waitFor();
  // After the last analysis, before the comment of the next table.
  const last = before.lastIndexOf("[[analysis]]");
  const next = last + before.slice(last).search(/\n\n/) + 1;
  assert.equal(await text(), `${before.slice(0, next)}\n[[analysis]]\nkind = "map"\n${before.slice(next)}`);
  // Ready to be filled in: its first field has the focus.
  await page.waitForFunction((key) => document.activeElement?.dataset.key === key, `${at}.kind 0`);
  await field(page, `${at}.kind`).locator("select").selectOption("path");
  // What a path needs is missing: told.
  await page.waitForSelector(".problems .wrong");
  await field(page, `${at}.name`).locator("input").fill("rim");
  await field(page, `${at}.name`).locator("input").press("Tab");
  await page.locator(`[data-table="${at}"] > summary`, { hasText: "analysis: rim" }).waitFor();
  await unfold(page, `${at}.circle`);
  await field(page, `${at}.circle.radius_mm`).locator("input").fill("40");
  await field(page, `${at}.circle.radius_mm`).locator("input").press("Tab");
  await fine(page);
  // An entry of a list inside of a table: required keys are there, and its problem is shown at its field.
  await unfold(page, "tool");
  await page.locator('[data-key="add tool.spring"]').click();
  await field(page, "tool.spring[0].at").waitFor();
  assert.match(await text(), /spring = \[\{ at = "\w*", source = "" \}\]/);
  await page.waitForSelector('[data-table="tool.spring[0]"].wrong .row [aria-invalid=true]');
  await page.locator('[data-key="remove tool.spring[0]"]').click();
  await fine(page);
  assert.doesNotMatch(await text(), /spring = /);
  await page.click("#tab-live");
  await settled(page);
  await page.locator("#field-analysis").selectOption("rim");
  await settled(page);
  const { paths } = await request("POST", "/api/answer", { text: `${before}\n[[analysis]]\nkind = "path"\nname = "rim"\ncircle = { radius_mm = 40 }\n`, analysis: "rim" });
  assert.ok((await page.locator("[data-follow=worst] .extreme-value").innerText()).startsWith(String(Math.round(paths[0].worst.in_plane_um))));
  await page.click("#tab-study");
  await page.getByRole("button", { name: "Remove analysis: rim", exact: true }).click();
  await page.waitForFunction((text) => document.querySelector("#study-text").value === text, before);
  // Its table goes once the text has been read anew.
  await page.locator(`[data-table="${at}"]`).waitFor({ state: "detached" });
  await fine(page);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("joints are counted as the controller does, or as the chain does", async () => {
  const page = await open(browser, server.url);
  const text = readFileSync(join(server.folder, "study.toml"), "utf8");
  const { maps } = await request("POST", "/api/answer", { text, analysis: "Fig. 6" });
  const pose = await request("POST", "/api/pose", { text, analysis: "Fig. 6", at: { y_mm: maps[0].worst.in_plane_mm[0], z_mm: maps[0].worst.in_plane_mm[1] }, case: maps[0].worst.worst_case });
  const shown = pose.answer.postures.findIndex((p) => p.branch === maps[0].worst.branch);
  const written = (list) => list.map((q) => `${q < -0.05 ? "−" : ""}${Math.abs(q).toFixed(1)}°`);
  const read = () => page.locator("#panel-joints .bar-value").allInnerTexts();
  assert.deepEqual(await read(), written(pose.answer.postures[shown].joints_deg));
  await page.locator("#panel-joints .switch button", { hasText: "Chain" }).click();
  const chain = written(pose.chain[shown].map((c) => c.at_deg));
  assert.deepEqual(await read(), chain);
  assert.notDeepEqual(chain, written(pose.answer.postures[shown].joints_deg), "they differ for this robot");
  await page.context().close();
});
