// The documentation with the live page in it: search, themes, small screens, own files alone.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, serious, settled, site } from "./setup.mjs";

let browser, pages, all;
before(async () => {
  browser = await launch();
  pages = await site({}, "..");
  const files = readdirSync(pages.folder, { recursive: true }).map((name) => name.replaceAll("\\", "/"));
  all = files.filter((name) => name.endsWith(".html") && !name.startsWith("live/") && !name.startsWith("assets/")).sort();
});
after(async () => {
  await browser?.close();
  pages?.stop();
});

const visit = (path, options = {}) => open(browser, new URL(path, pages.url).href, { answers: false, ...options });

/** The answer of the live page inside of this one. */
async function inside(page) {
  const element = await page.waitForSelector(".live iframe");
  await element.scrollIntoViewIfNeeded();
  const frame = await element.contentFrame();
  await frame.waitForSelector(".pace");
  await settled(frame);
  return frame;
}

/** Types into the search; the titles of the pages found. */
async function search(page, words) {
  await page.click(".md-search__input");
  await page.keyboard.type(words);
  await page.waitForSelector(".md-search-result__item a");
  return page.locator(".md-search-result__item h1").allInnerTexts();
}

const ROOTS = [
  ["served", () => pages.url],
  ["from a disk", () => `file://${pages.folder}/`],
];

for (const [where, root] of ROOTS) {
  test(`search finds a term and leads to its page, ${where}`, async () => {
    const page = await open(browser, `${root()}index.html`, { answers: false });
    const found = await search(page, "regenerative");
    assert.ok(found.includes("Stability of milling"), found.join());
    await Promise.all([page.waitForNavigation(), page.locator(".md-search-result__item a", { hasText: "Stability of milling" }).first().click()]);
    assert.match(page.url(), /theory\/stability\.html/);
    assert.match(await page.locator("h1").innerText(), /^Stability of milling/);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });

  test(`a guide page shows the live page when it is opened, ${where}`, async () => {
    const page = await open(browser, `${root()}guide/predict.html`, { answers: false });
    await page.waitForTimeout(300);
    assert.equal(page.frames().filter((frame) => frame.url().includes("live/")).length, 0, "not loaded before it is opened");
    await page.click("details.example summary");
    const frame = await inside(page);
    const worst = () => frame.locator("[data-follow=worst] .extreme-value").innerText();
    const before = await worst();
    assert.match(before, /\d/);
    await frame.fill("#field-x", "900");
    await settled(frame);
    assert.notEqual(await worst(), before);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });
}

test("each example study has its page, with the live page and its own title", async () => {
  for (const name of all.filter((path) => /^studies\/[^/]+\/index\.html$/.test(path))) {
    const page = await visit(name);
    const title = await page.locator("h1").innerText();
    assert.ok(title.includes(await (await inside(page)).locator(".study-title").innerText()), name);
    assert.deepEqual(page.complaints, [], name);
    await page.context().close();
  }
});

test("with the headers of the guide the live page inside of a page may use more than one thread", async () => {
  const isolated = await site({ "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp" }, "..");
  const page = await open(browser, `${isolated.url}studies/mh12-groove/index.html`, { answers: false });
  const frame = await inside(page);
  assert.equal(await frame.evaluate(() => crossOriginIsolated), true);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  isolated.stop();
});

test("every page loads own files alone, without errors, and fits a telephone", async () => {
  const copies = all.filter((path) => path.startsWith("source/"));
  const own = all.filter((path) => !path.startsWith("source/"));
  assert.ok(own.length > 150 && copies.length > 100, `${own.length} pages, ${copies.length} copies of sources`);
  const page = await visit("index.html", { width: 390, height: 844 });
  // Other tests load these: here they would cost most of the time.
  const { config, docs } = JSON.parse(readFileSync(join(pages.folder, "search/search_index.json"), "utf8"));
  assert.ok(docs.length > 1000);
  await page.route("**/search/search_index.json", (route) => route.fulfill({ json: { config, docs: docs.slice(0, 1) } }));
  await page.route("**/live/index.html*", (route) => route.fulfill({ contentType: "text/html", body: "" }));
  // Copies are all made in one way.
  for (const path of [...own, ...copies.slice(0, 20)]) {
    await page.goto(new URL(path, pages.url).href);
    const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(over <= 0, `${path} is ${over} pixels wider than the screen`);
    assert.deepEqual(page.complaints, [], path);
  }
  await page.context().close();
});

test("light and dark follow the system, and the reader's choice is kept", async () => {
  const brightness = (page) => page.evaluate(() => Number(getComputedStyle(document.body).backgroundColor.match(/\d+/)[0]));
  const dark = await visit("index.html", { dark: true });
  assert.ok((await brightness(dark)) < 80);
  await dark.context().close();
  const page = await visit("index.html");
  assert.ok((await brightness(page)) > 200);
  await page.locator("label[for='__palette_1']:visible").click();
  await page.locator("label[for='__palette_2']:visible").click();
  assert.ok((await brightness(page)) < 80);
  await page.goto(new URL("theory/chain.html", pages.url).href);
  assert.ok((await brightness(page)) < 80);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("nothing serious for a reader who cannot see the page, in both themes", async () => {
  for (const dark of [false, true])
    for (const path of ["index.html", "guide/predict.html", "theory/compliance.html", "python/robot.html", "library/materials.html"]) {
      const page = await visit(path, { dark });
      assert.deepEqual(await serious(page), [], `${path}, ${dark ? "dark" : "light"}`);
      await page.context().close();
    }
});

test("the policy of a page refuses other scripts, and other servers", async () => {
  const page = await visit("index.html");
  const other = await page.evaluate(() => fetch("http://127.0.0.1:9/").then(() => "sent", (error) => String(error)));
  assert.match(other, /TypeError/);
  const ran = await page.evaluate(() => {
    const script = document.createElement("script");
    script.textContent = "globalThis.ran = true";
    document.body.append(script);
    return globalThis.ran === true;
  });
  assert.equal(ran, false);
  assert.match(page.complaints.join(), /Content Security Policy/);
  await page.context().close();
});
