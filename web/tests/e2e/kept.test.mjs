// Nothing is lost: undo and redo, drafts over reloads and restarts, changes of the file by others, two tabs.

import assert from "node:assert/strict";
import { existsSync, readFileSync, unlinkSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, restart, serve, settled } from "./setup.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

/** A page on a server of its own. */
async function at(work) {
  const server = await serve();
  try {
    const page = await open(browser, server.url);
    await work(page, server, join(server.folder, "study.toml"));
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  } finally {
    await server.stop();
  }
}
const value = (page, id) => page.inputValue(`#field-${id}`);
const waitForValue = (page, id, expected) => page.waitForFunction(([id, expected]) => document.querySelector(`#field-${id}`).value === expected, [id, expected]);
const notice = (page, id) => page.locator(`[data-notice="${id}"]`);
const fine = (page) => page.waitForSelector(".problems .fine");
/** Accepts the question whether to leave, and counts it. */
const leaves = (page) => {
  const asked = [];
  page.on("dialog", (dialog) => {
    asked.push(dialog.type());
    void dialog.accept();
  });
  return asked;
};
const draftKept = (page) => page.waitForTimeout(300);

test("undo and redo of controls, by keyboard and by buttons", () =>
  at(async (page, server, file) => {
    const [x, tolerance] = [await value(page, "x"), await value(page, "limit")];
    assert.ok(await page.getByRole("button", { name: "Undo" }).isDisabled());
    await page.fill("#field-x", "850");
    await settled(page);
    await page.fill("#field-limit", "120");
    await settled(page);
    // Inside of a field too.
    await page.keyboard.press("Control+z");
    await waitForValue(page, "limit", tolerance);
    await page.keyboard.press("Control+z");
    await waitForValue(page, "x", x);
    await settled(page);
    assert.ok(await page.locator(".changed").isHidden(), "as in the file");
    await page.keyboard.press("Control+y");
    await waitForValue(page, "x", "850");
    await page.keyboard.press("Control+Shift+z");
    await waitForValue(page, "limit", "120");
    await settled(page);
    assert.match(await page.locator(".verdict-line").innerText(), /120/);
    await page.getByRole("button", { name: "Undo" }).click();
    await waitForValue(page, "limit", tolerance);
    await page.getByRole("button", { name: "Redo" }).press("Enter");
    await waitForValue(page, "limit", "120");
    // Discarding all is a change like others.
    await page.click(".changed");
    await waitForValue(page, "x", x);
    await page.keyboard.press("Control+z");
    await waitForValue(page, "x", "850");
    await settled(page);
    // Saved from here, too; undo goes back behind it.
    await page.keyboard.press("Control+s");
    await page.waitForSelector(".changed", { state: "hidden" });
    assert.match(readFileSync(file, "utf8"), /850/);
    await page.keyboard.press("Control+z");
    await waitForValue(page, "limit", tolerance);
    await page.waitForSelector(".changed", { state: "visible" });
  }));

test("undo of typed text and of fields in Study; the analysis is undone too", () =>
  at(async (page) => {
    await page.click("#tab-study");
    await fine(page);
    const editor = page.locator("#study-text");
    const text = await editor.inputValue();
    await editor.focus();
    await page.keyboard.press("Control+Home");
    // In one piece: how fast letters follow each other on a loaded machine does not matter.
    await page.keyboard.insertText("# typed");
    await page.waitForTimeout(1000);
    await page.keyboard.insertText(" more");
    await page.keyboard.press("Control+z");
    assert.equal(await editor.inputValue(), `# typed${text}`);
    // Where the change was, not at the end.
    assert.equal(await editor.evaluate((e) => e.selectionStart), 7);
    await page.keyboard.press("Control+z");
    assert.equal(await editor.inputValue(), text);
    await page.keyboard.press("Control+y");
    await page.keyboard.press("Control+z");
    await fine(page);
    await page.locator('[data-table=""] > summary').click();
    const tolerance = page.locator('.row[data-path="tolerance_um"] input');
    await tolerance.fill("77");
    await tolerance.press("Tab");
    await page.waitForFunction(() => document.querySelector("#study-text").value.includes("tolerance_um = 77"));
    await page.keyboard.press("Control+z");
    await page.waitForFunction((text) => document.querySelector("#study-text").value === text, text);
    await page.click("#tab-live");
    await settled(page);
    const options = await page.locator("#field-analysis option").allInnerTexts();
    if (options.length > 1) {
      await page.selectOption("#field-analysis", options[1]);
      await settled(page);
      await page.keyboard.press("Control+z");
      await page.waitForFunction((name) => document.querySelector("#field-analysis").value === name, options[0]);
    }
  }));

test("text with an error survives another tab of the page, a reload and the end of the server", () =>
  at(async (page, server, file) => {
    const asked = leaves(page);
    await page.click("#tab-study");
    await fine(page);
    const editor = page.locator("#study-text");
    const broken = (await editor.inputValue()).replace("tolerance_um = 50", "tolerance_um = -5 # typed");
    await editor.fill(broken);
    await page.waitForSelector(".problems .wrong");
    await page.click("#tab-live");
    await page.waitForSelector(".banner:not([hidden])");
    await page.click("#tab-study");
    assert.equal(await editor.inputValue(), broken);
    await draftKept(page);
    await page.reload();
    assert.deepEqual(asked, ["beforeunload"], "a warning before leaving");
    await page.waitForSelector(".problems .wrong");
    assert.equal(await editor.inputValue(), broken);
    assert.match(await notice(page, "restored").innerText(), /Unsaved changes of .* were restored/);
    assert.match(await page.locator(".changed").innerText(), /Unsaved/);
    // A change of a control in a text with another error is kept as well.
    await page.click("#tab-live");
    await page.waitForSelector(".banner:not([hidden])");
    await page.click("#tab-study");
    // The server ends; what is typed meanwhile is kept for the next one, at its new address.
    const typed = broken.replace("-5 # typed", "140 # typed");
    await server.end();
    await editor.fill(typed);
    await notice(page, "server").waitFor();
    assert.match(await notice(page, "server").innerText(), /does not answer.*kept in this browser/);
    await draftKept(page);
    const context = page.context();
    await page.close();
    const url = await restart(server);
    const next = await context.newPage();
    await next.goto(url);
    await settled(next);
    assert.match(await next.locator(".verdict-line").innerText(), /140/);
    await next.click("#tab-study");
    assert.equal(await next.inputValue("#study-text"), typed);
    assert.doesNotMatch(readFileSync(file, "utf8"), /typed/);
    await notice(next, "restored").getByRole("button", { name: "Discard them" }).click();
    await next.waitForSelector(".changed", { state: "hidden" });
    await next.close();
  }));

test("an open tab continues when the study is opened at the address of a restarted server", () =>
  at(async (page, server) => {
    leaves(page);
    await page.fill("#field-x", "870");
    await settled(page);
    await server.end();
    await page.fill("#field-limit", "130");
    await notice(page, "server").waitFor();
    const url = await restart(server);
    assert.equal(new URL(url).port, new URL(server.url).port, "the same port");
    await page.bringToFront();
    await page.waitForFunction(() => document.querySelector('[data-notice="server"]')?.textContent.includes("restarted") ?? false);
    const next = await page.context().newPage();
    await next.goto(url);
    await settled(next);
    // The first one has its text, and what was changed without a server is answered now.
    await page.bringToFront();
    await notice(page, "server").waitFor({ state: "detached" });
    await page.waitForFunction(() => /130/.test(document.querySelector(".verdict-line").textContent));
    assert.equal(await value(page, "x"), "870");
    // The new one sees that.
    await next.bringToFront();
    assert.equal(await next.locator(".others").innerText(), "2 tabs");
    await notice(next, "tab").getByRole("button", { name: "Take them over" }).click();
    await waitForValue(next, "x", "870");
    await next.close();
  }));

test("a change of the file by another program: loaded, merged, or chosen", () =>
  at(async (page, server, file) => {
    const text = readFileSync(file, "utf8");
    // Nothing unsaved: loaded, and that can be undone.
    writeFileSync(file, text.replace("tolerance_um = 50", "tolerance_um = 60"));
    await notice(page, "disk-loaded").waitFor();
    await waitForValue(page, "limit", "60");
    await notice(page, "disk-loaded").getByRole("button", { name: "Undo" }).click();
    await waitForValue(page, "limit", "50");
    await settled(page);
    // Unsaved: both changed different lines.
    await page.fill("#field-x", "880");
    await settled(page);
    writeFileSync(file, text.replace("tolerance_um = 50", "tolerance_um = 70"));
    await notice(page, "disk").waitFor();
    assert.match(await notice(page, "disk").innerText(), /was changed on disk, and you have unsaved changes\..*same lines/s);
    await notice(page, "disk").getByRole("button", { name: "Keep mine" }).press("Enter");
    await notice(page, "disk").waitFor({ state: "detached" });
    await page.click(".changed");
    await waitForValue(page, "limit", "70");
    await settled(page);
    await page.fill("#field-x", "880");
    await settled(page);
    writeFileSync(file, text.replace("tolerance_um = 50", "tolerance_um = 80"));
    await notice(page, "disk").getByRole("button", { name: "Merge both" }).click();
    await waitForValue(page, "limit", "80");
    await settled(page);
    assert.equal(await value(page, "x"), "880");
    await page.click(".keep");
    await page.waitForSelector(".changed", { state: "hidden" });
    const merged = readFileSync(file, "utf8");
    assert.ok(/tolerance_um = 80/.test(merged) && /880/.test(merged));
    // The same line: one of the two is chosen, and a save does not overwrite the other by accident.
    await page.click("#tab-study");
    await page.locator("#study-text").fill(merged.replace("tolerance_um = 80", "tolerance_um = 90"));
    await fine(page);
    writeFileSync(file, merged.replace("tolerance_um = 80", "tolerance_um = 95"));
    await page.keyboard.press("Control+s");
    await notice(page, "disk").waitFor();
    assert.match(readFileSync(file, "utf8"), /tolerance_um = 95/);
    assert.equal(await notice(page, "disk").getByRole("button", { name: "Merge both" }).count(), 0);
    await notice(page, "disk").getByRole("button", { name: "Load it" }).click();
    await waitForValue(page, "limit", "95");
    await page.waitForSelector(".changed", { state: "hidden" });
    await page.keyboard.press("Control+z");
    assert.match(await page.inputValue("#study-text"), /tolerance_um = 90/);
    await waitForValue(page, "limit", "90");
  }));

test("a deleted file is saved as a new one", () =>
  at(async (page, server, file) => {
    const text = readFileSync(file, "utf8");
    unlinkSync(file);
    await notice(page, "disk").waitFor();
    assert.match(await notice(page, "disk").innerText(), /was deleted\. Its text is kept here/);
    assert.ok(!existsSync(file));
    await notice(page, "disk").getByRole("button", { name: "Save as a new file" }).press("Enter");
    await notice(page, "disk").waitFor({ state: "detached" });
    assert.equal(readFileSync(file, "utf8"), text);
  }));

test("two tabs on one study: a save in one is loaded by the other", () =>
  at(async (page, server) => {
    const other = await page.context().newPage();
    await other.goto(server.url);
    await settled(other);
    assert.equal(await page.locator(".others").innerText(), "2 tabs");
    await page.bringToFront();
    await page.fill("#field-x", "890");
    await settled(page);
    await other.bringToFront();
    await notice(other, "tab").waitFor();
    await page.bringToFront();
    await page.keyboard.press("Control+s");
    await page.waitForSelector(".changed", { state: "hidden" });
    await other.bringToFront();
    await waitForValue(other, "x", "890");
    await notice(other, "tab").waitFor({ state: "detached" });
    await other.close();
    await page.waitForSelector(".others", { state: "hidden" });
  }));

test("a link to a state contains no token, opens next to a tab with the study, and is used on request", () =>
  at(async (page, server) => {
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    await page.fill("#field-x", "910");
    await settled(page);
    await page.getByRole("button", { name: "Copy a link to this state" }).press("Enter");
    await notice(page, "link").waitFor();
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(!link.includes(new URL(server.url).searchParams.get("token")), link);
    await page.click(".changed");
    await settled(page);
    await draftKept(page);
    const next = await page.context().newPage();
    await next.goto(link);
    await settled(next);
    assert.notEqual(await value(next, "x"), "910", "only on request");
    await notice(next, "linked").getByRole("button", { name: "Show it" }).press("Enter");
    await waitForValue(next, "x", "910");
    await settled(next);
    await next.keyboard.press("Control+z");
    await next.keyboard.press("Control+z");
    await next.waitForFunction(() => document.querySelector("#field-x").value !== "910");
    // Without another tab there is no token.
    const alone = await open(browser, link, { answers: false });
    await alone.waitForSelector("text=This address has no valid token");
    await alone.context().close();
    await next.close();
  }));
