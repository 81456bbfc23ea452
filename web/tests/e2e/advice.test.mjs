// Advice in place: measures with their gains under the verdict, each applied by its button; the compensated path and its
// program as files; the values of the cut as controls.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, serve, settled } from "./setup.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

/** The pocket with so few points and so little room that its searches are short. */
const short = (text) =>
  text
    .replace(/program = .*/, 'program = { file = "pocket.ngc", step_mm = 20 }')
    .replace("x_mm = [1300, 1900]", "x_mm = [1650, 1750]")
    .replace("y_mm = [-600, 600]", "y_mm = [200, 200]")
    .replace("z_mm = [500, 1200]", "z_mm = [900, 900]");

async function at(work, edit = short, options = {}) {
  const server = await serve(edit, "r2000ic-pocket");
  try {
    const page = await open(browser, server.url, options);
    await settled(page);
    await work(page, server.folder);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  } finally {
    await server.stop();
  }
}

async function study(page) {
  await page.click("#tab-study");
  const value = await page.locator("#study-text").inputValue();
  await page.click("#tab-live");
  return value;
}

test("advice: each measure with its gain, applied by its button, taken back as one step", () =>
  at(async (page, folder) => {
    await page.click("[data-key=advise]");
    await page.locator(".advice-measures").waitFor();
    const advice = JSON.parse(readFileSync(join(folder, "advice/advice.json"), "utf8"));
    const words = await page.locator(".advice").innerText();
    assert.ok(words.includes(advice.advice[0].replaceAll(" um", " µm")), words);
    assert.ok(existsSync(join(folder, "advised/study.toml")));
    // The permitted depth is what the command says, rounded down.
    const depth = advice.limits.axial_depth;
    assert.equal(depth.verdict, "up to");
    const permitted = Math.floor(depth.value / 0.01) * 0.01;
    await page.click("[data-key=axial_depth]");
    await settled(page);
    const set = Number(/axial_depth_mm = ([\d.]+)/.exec(await study(page))[1]);
    assert.ok(Math.abs(set - permitted) < 1e-9, `${set} is not ${permitted}`);
    assert.equal(Number(await page.inputValue("#field-axial")), set);
    assert.match(await page.locator(".advice-measures li.used").innerText(), /depth of cut[\s\S]*applied/);
    assert.equal(await page.getByText("For an earlier state").count(), 0, "the other measures still hold");
    // Taken back, it can be applied again; another change makes the advice one of an earlier state.
    await page.keyboard.press("Control+z");
    await settled(page);
    assert.equal(await page.locator(".advice-measures li.used").count(), 0);
    await page.fill("#field-limit", "90");
    await settled(page);
    await page.getByText("For an earlier state of the study: advise again for this one.").waitFor();
    // It is there again after a reload, for the study that it is about.
    await page.keyboard.press("Control+z");
    await settled(page);
    await page.reload();
    await page.locator(".advice-measures").waitFor();
  }));

test("compensation: what remains, the path and a robot program as files, in the language of the robot or another", () =>
  at(async (page, folder) => {
    await page.click("[data-key=compensate]");
    await page.locator(".advice-files").waitFor();
    assert.match(await page.locator(".advice-files").innerText(), /compensated [\d.]+ µm/);
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator('.advice-files [data-file="programs/pocket.LS"]').click()]);
    assert.deepEqual(readFileSync(await download.path()), readFileSync(join(folder, "programs/pocket.LS")));
    assert.ok(existsSync(join(folder, "compensated/pocket.commanded.csv")));
    await page.selectOption(".advice-language", "src");
    await page.click("[data-key=compensate]");
    await page.locator('.advice-files [data-file="programs/pocket.src"]').waitFor();
    // Keyboard alone.
    await page.focus("[data-key=compensate]");
    await page.keyboard.press("Enter");
    await page.locator('.advice-files [data-file="programs/pocket.src"]').waitFor();
  }));

test("compensation that is done, its answer still to come: nothing is shown of it, and nothing fails", () =>
  at(async (page) => {
    let pass;
    const requested = new Promise((done) => void page.route(/\/api\/jobs\/[^/]+$/, (route) => {
      pass = () => route.continue();
      done();
    }));
    await page.click("[data-key=compensate]");
    await requested;
    await page.locator("[data-key=compensate]:not([disabled])").waitFor();
    assert.equal(await page.locator(".advice-files").count(), 0);
    await pass();
    await page.locator(".advice-files").waitFor();
  }));

test("the cut: values as controls, at the field what is wrong, and what the program gives instead", () =>
  at(async (page) => {
    assert.match(await page.locator(".controls").innerText(), /Feed: given by the program/);
    assert.equal(await page.locator("#field-feed").isVisible(), false);
    const before = await page.locator(".verdict-points").innerText();
    await page.fill("#field-axial", "4");
    await settled(page);
    assert.notEqual(await page.locator(".verdict-points").innerText(), before, "the deviation follows");
    await page.selectOption("#field-material", "aluminium-7075-t6");
    await settled(page);
    assert.match(await study(page), /material = "aluminium-7075-t6"/);
    await page.selectOption("#field-side", "slot");
    await settled(page);
    const slot = await study(page);
    assert.match(slot, /side = "slot"/);
    assert.doesNotMatch(slot, /radial_depth_mm/);
    await page.selectOption("#field-side", "down");
    await settled(page);
    assert.match(await study(page), /radial_depth_mm = 5/);
    await page.fill("#field-diameter", "-3");
    await page.locator("#field-diameter-error:not(:empty)").waitFor();
    assert.equal(await page.getAttribute("#field-diameter", "aria-invalid"), "true");
    await page.fill("#field-diameter", "12");
    await settled(page);
    assert.equal(await page.locator(".field-error:not(:empty)").count(), 0);
  }));

for (const width of [820, 390])
  test(`advice at ${width} px: no sideways scrolling, the scene is seen`, () =>
    at(
      async (page) => {
        await page.locator("[data-key=advise]").scrollIntoViewIfNeeded();
        const { right } = await page.locator(".advice").evaluate((e) => e.getBoundingClientRect().toJSON());
        assert.ok(right <= width + 0.5, `${right} of ${width}`);
        assert.ok((await page.locator(".stage").boundingBox()).height > 150);
      },
      short,
      { width, height: 800 },
    ));
