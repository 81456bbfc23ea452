// Looks and manners: small, quick to paint, light and dark, tablet, keyboard, no complaint of axe, pictures as kept.

import assert from "node:assert/strict";
import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { gzipSync } from "node:zlib";
import { difference, launch, open, serious, serve, settled, still } from "./setup.mjs";

const KEPT = new URL("./pictures/", import.meta.url).pathname;
const DIST = new URL("../../dist/", import.meta.url).pathname;
let server, browser;
before(async () => {
  server = await serve();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

test("the page is below 1 MB compressed, has fixed names and no script inside", () => {
  const names = readdirSync(DIST).sort();
  assert.deepEqual(names, ["app.css", "app.js", "index.html", "vendor.js"]);
  const size = names.reduce((sum, name) => sum + gzipSync(readFileSync(DIST + name)).length, 0);
  assert.ok(size < 1_000_000, `${size} bytes`);
  assert.doesNotMatch(readFileSync(`${DIST}index.html`, "utf8"), /<script(?![^>]*src=)/);
});

test("the first paint comes within a second", async () => {
  // The browser itself may start slowly: not the page's doing.
  await (await open(browser, server.url)).context().close();
  const page = await open(browser, server.url);
  const paint = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
  assert.ok(paint < 1000, `${paint} ms`);
  await page.context().close();
});

for (const dark of [false, true])
  test(`axe finds nothing serious in any tab, ${dark ? "dark" : "light"}`, async () => {
    const page = await open(browser, server.url, { dark });
    for (const tab of ["live", "pictures", "jobs", "study", "files"]) {
      await page.click(`#tab-${tab}`);
      await page.waitForTimeout(400);
      assert.deepEqual(await serious(page), [], tab);
    }
    await page.context().close();
  });

test("dark and light: as the system has it, until switched; the choice stays", async () => {
  const page = await open(browser, server.url, { dark: true });
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  assert.equal(await theme(), "dark");
  await page.click(".theme");
  assert.equal(await theme(), "light");
  await page.reload();
  await settled(page);
  assert.equal(await theme(), "light");
  await page.context().close();
});

for (const [width, height] of [[1280, 800], [1024, 768]])
  test(`nothing is cut off at ${width} x ${height}`, async () => {
    const page = await open(browser, server.url, { width, height });
    const wide = await page.evaluate(() => ({
      page: document.documentElement.scrollWidth - innerWidth,
      cut: [...document.querySelectorAll(".top *, .verdict-main, .verdict-points, .views, .legend, .scales, .left, .right")].filter((e) => {
        const b = e.getBoundingClientRect();
        return b.width > 0 && (b.right > innerWidth + 1 || b.left < -1 || b.bottom > innerHeight + 1);
      }).map((e) => e.className || e.tagName),
      over: ["left", "right"].filter((c) => { const e = document.querySelector(`.${c}`); return e.scrollWidth > e.clientWidth + 1; }),
    }));
    assert.deepEqual(wide, { page: 0, cut: [], over: [] });
    const [legend, scales] = await Promise.all([page.locator(".legend").boundingBox(), page.locator(".scales").boundingBox()]);
    assert.ok(legend.x + legend.width <= scales.x, "legend and scales lie side by side");
    await page.context().close();
  });

test("the keyboard reaches tabs, settings, points and branches, and what has focus is seen", async () => {
  const page = await open(browser, server.url);
  const seen = new Set();
  for (let i = 0; i < 120; i++) {
    await page.keyboard.press("Tab");
    const at = await page.evaluate(() => {
      const e = document.activeElement;
      const style = getComputedStyle(e);
      return { name: e.id || e.className || e.tagName, outline: style.outlineStyle !== "none" || style.boxShadow !== "none" };
    });
    if (at.name === "BODY") break;
    seen.add(String(at.name).split(" ")[0]);
    assert.ok(at.outline, `${at.name} shows no focus`);
  }
  for (const name of ["tab-live", "icon", "field-analysis", "field-x", "field-branch", "extreme", "stage", "target-y", "branch", "use", "row-button"]) assert.ok(seen.has(name), `${name} is not reached: ${[...seen]}`);
  await page.context().close();
});

const VIEWS = {
  map: async () => {},
  plate: async (page) => {
    await page.selectOption("#field-analysis", "Fig. 6, elbow down");
    await settled(page);
    await page.click(".views button:nth-child(5)");
  },
  path: async (page) => {
    await page.selectOption("#field-analysis", "(i) horizontal plate, tool 250 mm, elbow up");
    await settled(page);
  },
  sections: async (page) => {
    await page.selectOption("#field-analysis", "Table 4");
    await settled(page);
  },
  study: (page) => page.click("#tab-study"),
  fields: async (page) => {
    await page.click("#tab-study");
    await page.waitForSelector(".problems .fine");
    for (const table of ["place", "posture", "posture.search"]) await page.locator(`[data-table="${table}"] > summary`).click();
  },
  jobs: (page) => page.click("#tab-jobs"),
};
for (const dark of [false, true])
  for (const [name, go] of Object.entries(VIEWS))
    test(`${name} looks as it was kept, ${dark ? "dark" : "light"}`, async () => {
      const page = await open(browser, server.url, { dark, scale: 0.5 });
      await go(page);
      await still(page);
      await page.evaluate(() => document.querySelectorAll(".pace").forEach((e) => (e.style.visibility = "hidden")));
      const now = await page.screenshot();
      const file = `${KEPT}${name}-${dark ? "dark" : "light"}.png`;
      if (process.env.KEEP_PICTURES || !existsSync(file)) {
        mkdirSync(KEPT, { recursive: true });
        writeFileSync(file, now);
      }
      const apart = await difference(page, readFileSync(file), now);
      assert.ok(apart < 0.02, `mean difference ${apart.toFixed(4)}; KEEP_PICTURES=1 keeps the new one, after a look at it`);
      await page.context().close();
    });
