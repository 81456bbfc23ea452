// Errors: at the top and at their field, in the words of the page; robots without known compliances.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { after, before, test } from "node:test";
import { launch, open, serious, serve, settled, until } from "./setup.mjs";

let server, browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});
const banner = (page) => page.locator(".banner");

test("a value that is refused: said at the top and at its field, with limit, value and unit", async () => {
  const page = await open(browser, server.url);
  await page.fill("#field-limit", "-50");
  await page.waitForSelector("#field-limit-error:not(:empty)");
  await banner(page).waitFor();
  assert.match(await page.locator("#field-limit-error").innerText(), /^must be .* 0 µm \(got −50 µm\)/);
  const words = await banner(page).innerText();
  assert.match(words, /tolerance: must be .* 0 µm \(got −50 µm\)/i);
  assert.match(words, /The page shows the last valid answer/);
  assert.doesNotMatch(words, /`|_um/);
  const box = await banner(page).boundingBox();
  assert.ok(box.y < 120 && box.y + box.height < 400, "in sight");
  await page.fill("#field-limit", "60");
  await settled(page);
  assert.ok(await banner(page).isHidden());
  // A coordinate is named as its field is; what is no number refers to the last accepted value.
  const x = await page.inputValue("#field-x");
  await page.fill("#field-x", "1e9");
  await page.waitForSelector("#field-x-error:not(:empty)");
  await page.fill("#field-x", "far");
  assert.match(await page.locator("#field-x-error").innerText(), new RegExp(`such as ${x}\\.`));
  // By keyboard to the text.
  await page.fill("#field-x", x);
  await settled(page);
  await page.fill("#field-limit", "-50");
  await banner(page).waitFor();
  await page.getByRole("button", { name: "Open in Study" }).press("Enter");
  assert.equal(await page.locator("#tab-study").getAttribute("aria-selected"), "true");
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("an error stays at its field when the list of robots comes after it", async () => {
  const page = await open(browser, server.url);
  let arrive;
  const arrives = new Promise((done) => (arrive = done));
  await page.route("**/api/robots", async (route) => {
    await arrives;
    await route.continue();
  });
  await page.reload();
  await settled(page);
  await page.fill("#field-limit", "-50");
  await page.waitForSelector("#field-limit-error:not(:empty)");
  assert.equal(await page.locator("#field-robot option").count(), 1, "the robot of the study alone");
  arrive();
  await until(async () => (await page.locator("#field-robot option").count()) > 10);
  assert.match(await page.locator("#field-limit-error").innerText(), /got −50 µm/);
  assert.equal(await page.inputValue("#field-limit"), "-50");
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a robot without known compliances: its class is assumed by one click, and marked everywhere", async () => {
  const page = await open(browser, server.url);
  const before = await page.inputValue("#field-robot");
  const [other] = await page.locator("#field-robot option").evaluateAll((all) => all.filter((o) => /no compliance known/.test(o.textContent) && /kr120/.test(o.value)).map((o) => o.value));
  await page.selectOption("#field-robot", other);
  const offer = banner(page).getByRole("button", { name: "Assume class heavy" });
  await offer.waitFor();
  assert.match(await page.locator("#field-robot-error").innerText(), /Assume class heavy/);
  assert.ok((await banner(page).innerText()).length < 400, "no wall of text");
  await offer.press("Enter");
  await settled(page);
  await page.waitForFunction((name) => document.querySelector("#field-robot").value === name, other);
  for (const tab of ["live", "pictures", "jobs", "study", "files"]) {
    await page.click(`#tab-${tab}`);
    assert.ok(await page.locator(".assumed").isVisible(), tab);
  }
  await page.click("#tab-study");
  assert.match(await page.inputValue("#study-text"), /class = "heavy"/);
  await page.click("#tab-live");
  // A robot with known ones: they are used.
  await page.selectOption("#field-robot", before);
  await page.waitForSelector(".assumed", { state: "hidden" });
  await page.click("#tab-study");
  assert.doesNotMatch(await page.inputValue("#study-text"), /class = "heavy"/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("in a folder without a study the page says that it shows an example", async () => {
  const folder = mkdtempSync(join(tmpdir(), "armill-empty-"));
  const child = spawn(resolve(process.env.ARMILL_BIN), ["serve", "--no-open"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  try {
    const url = await new Promise((done) => createInterface({ input: child.stdout }).once("line", done));
    const page = await open(browser, url);
    assert.match(await page.locator('[data-notice="example"]').innerText(), /no study: the page shows the example .* not saved; `armill new DIR`/);
    await page.locator('[data-notice="example"]').getByRole("button", { name: "Close this message" }).press("Enter");
    assert.equal(await page.locator('[data-notice="example"]').count(), 0);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  } finally {
    await new Promise((done) => {
      child.once("exit", done);
      child.kill("SIGTERM");
    });
    rmSync(folder, { recursive: true, force: true });
  }
});

for (const dark of [false, true])
  test(`axe finds nothing serious with an error, a notice, a pinned state and unsaved changes, ${dark ? "dark" : "light"}`, async () => {
    const page = await open(browser, server.url, { dark });
    await page.getByRole("button", { name: "Pin this state for comparison" }).click();
    await page.fill("#field-x", "1000");
    await settled(page);
    await page.getByRole("button", { name: "Copy a link to this state" }).click();
    await page.locator(".notice").waitFor();
    await page.fill("#field-limit", "-50");
    await banner(page).waitFor();
    await page.click("[data-handle='move part']");
    await page.waitForTimeout(400);
    assert.deepEqual(await serious(page), []);
    await page.context().close();
  });
