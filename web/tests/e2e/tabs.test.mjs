// Pictures, study and files, on a study folder of their own.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
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
  assert.match(await page.locator(".problems li").first().innerText(), /line 12.*Tolerance: must be at least 0 µm \(got −5 µm\)/s);
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

test("files in groups, with a filter and a preview", async () => {
  mkdirSync(join(server.folder, "out/deep"), { recursive: true });
  writeFileSync(join(server.folder, "out/report.html"), '<h1>the report</h1><script>document.body.textContent = "script"</script>');
  writeFileSync(join(server.folder, "out/plate.svg"), '<svg xmlns="http://www.w3.org/2000/svg" width="90" height="40"><rect width="9" height="9"/></svg>');
  writeFileSync(join(server.folder, "out/deep/rim.csv"), `x_mm\n${"1\n".repeat(100_000)}`);
  const page = await open(browser, server.url);
  await page.click("#tab-files");
  await page.waitForSelector(".file-group");
  const titles = await page.locator(".file-group h2").allInnerTexts();
  assert.deepEqual(titles, ["Study and inputs", "Results of the run: out/", "out/deep/"]);
  // Text, shortened; a picture; the report, without its scripts.
  await page.locator('[data-file="out/deep/rim.csv"]').press("Enter");
  await page.locator(".preview pre").waitFor();
  assert.match(await page.locator(".preview").innerText(), /x_mm\n1\n[^]*The first 64 kB of 200 kB/);
  await page.locator('[data-file="out/plate.svg"]').click();
  await page.waitForFunction(() => document.querySelector(".preview img")?.naturalWidth === 90);
  assert.equal(await page.locator('[data-file="out/plate.svg"]').getAttribute("aria-pressed"), "true");
  await page.locator('[data-file="out/report.html"]').click();
  await page.frameLocator(".preview iframe").locator("h1", { hasText: "the report" }).waitFor();
  // The filter opens what was folded, and Escape clears it.
  await page.locator('[data-folder="out/deep"] summary').press("Enter");
  await page.waitForFunction(() => !document.querySelector('[data-folder="out/deep"]').open);
  await page.fill("#files-filter", "RIM csv");
  assert.deepEqual(await page.locator(".file-group [data-file]").evaluateAll((all) => all.map((f) => f.dataset.file)), ["out/deep/rim.csv"]);
  assert.match(await page.locator(".file-tools").innerText(), /1 of \d+ files/);
  assert.ok(await page.locator('[data-file="out/deep/rim.csv"]').isVisible());
  // Its own undo, not that of the study.
  await page.locator("#files-filter").press("Control+z");
  await page.fill("#files-filter", "no such file");
  assert.match(await page.locator(".file-groups").innerText(), /No file matches/);
  await page.fill("#files-filter", "");
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Download out/plate.svg" }).click()]);
  assert.equal(download.suggestedFilename(), "plate.svg");
  assert.match(readFileSync(await download.path(), "utf8"), /^<svg/);
  assert.deepEqual(page.complaints.filter((text) => !/Blocked script execution/.test(text)), []);
  await page.context().close();
});
