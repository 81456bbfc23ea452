// Pictures, study and files, on a study folder of their own.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, serve, settled } from "./setup.mjs";

let server, browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const save = async (page) => {
  await page.getByRole("button", { name: "Save", exact: true }).click();
  await page.getByText("Saved.", { exact: true }).waitFor();
};

test("pictures of the analysis can be downloaded as SVG, PNG and CSV", async () => {
  const page = await open(browser, server.url);
  await page.click("#tab-pictures");
  await page.waitForSelector(".picture img");
  assert.ok((await page.locator(".picture").count()) >= 4);
  const drawn = await page.locator(".picture img").evaluateAll((images) => Promise.all(images.map((i) => i.decode().then(() => i.naturalWidth))));
  assert.ok(drawn.every((w) => w > 100));
  for (const [button, ending] of [["SVG", ".svg"], ["PNG", ".png"]]) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator(".picture").first().getByRole("button", { name: button, exact: true }).click()]);
    assert.ok(download.suggestedFilename().endsWith(ending));
  }
  const [table] = await Promise.all([page.waitForEvent("download"), page.click("text=Table as CSV")]);
  assert.match(readFileSync(await table.path(), "utf8"), /in_plane_um/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the study: checked while it is typed, saved with its comments", async () => {
  const page = await open(browser, server.url);
  await page.click("#tab-study");
  const editor = page.locator("#study-text");
  const text = await editor.inputValue();
  await editor.fill(text.replace("tolerance_um = 50", "tolerance_um = -5"));
  await page.waitForSelector(".problems .wrong");
  assert.match(await page.locator(".problems li").first().innerText(), /line 12.*tolerance_um/s);
  assert.equal(await page.locator(".lines b").innerText(), "12");
  await editor.fill(text.replace("tolerance_um = 50", "tolerance_um = 130 # wider"));
  await page.waitForSelector(".problems .fine");
  await page.click("#tab-live");
  await settled(page);
  assert.match(await page.locator(".verdict-line").innerText(), /130\u00a0µm/);
  await page.click("#tab-study");
  await save(page);
  const saved = readFileSync(join(server.folder, "study.toml"), "utf8");
  assert.match(saved, /tolerance_um = 130 # wider/);
  assert.match(saved, /# Fig. 6: a vertical plate/);
  await editor.fill(text);
  await page.waitForSelector(".problems .fine");
  await save(page);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a change of a control is saved with the comments kept", async () => {
  const page = await open(browser, server.url);
  await page.fill("#field-x", "850");
  await settled(page);
  await page.click("#tab-study");
  await page.waitForSelector(".problems .fine");
  await save(page);
  const saved = readFileSync(join(server.folder, "study.toml"), "utf8");
  assert.match(saved, /850/);
  assert.match(saved, /# The paper does not state tool length/);
  await page.context().close();
});

test("a broken study opens in the editor with every problem marked", async () => {
  const broken = await serve((text) => text.replace("tolerance_um = 50", "tolerance_um = -5").replace("step_mm = 10", 'step_mm = "ten"'));
  try {
    const page = await open(browser, broken.url, { answers: false });
    await page.waitForSelector(".problems .wrong");
    assert.equal(await page.locator("#tab-study").getAttribute("aria-selected"), "true");
    assert.ok((await page.locator(".lines b").count()) >= 1);
    await page.locator("#study-text").fill((await page.inputValue("#study-text")).replace("tolerance_um = -5", "tolerance_um = 50").replace('step_mm = "ten"', "step_mm = 10"));
    await page.waitForSelector(".problems .fine");
    await page.click("#tab-live");
    await settled(page);
    assert.match(await page.locator(".verdict-line").innerText(), /50/);
    await page.context().close();
  } finally {
    await broken.stop();
  }
});

test("files: the report is listed; a file that is dropped lies in the folder", async () => {
  const page = await open(browser, server.url);
  await page.click("#tab-files");
  await page.waitForSelector("text=study.toml");
  const file = { name: "path.csv", mimeType: "text/csv", buffer: Buffer.from("x_mm,y_mm,z_mm\n0,0,0\n10,0,0\n") };
  await page.setInputFiles("#pick", file);
  await page.waitForSelector(".said li");
  assert.equal(readFileSync(join(server.folder, "path.csv"), "utf8"), file.buffer.toString());
  await page.setInputFiles("#pick", file);
  await page.click("text=Replace it");
  await page.waitForFunction(() => document.querySelectorAll(".said li").length === 3);
  await page.context().close();
});
