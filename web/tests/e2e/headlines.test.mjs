// The headline of every example is the same on the page, in the terminal and in the report: the sentence, and its number in
// the verdict.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { EXAMPLES, launch, open, serve, um } from "./setup.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
});
const plain = (text) => text.replace(/[\s\u00a0\u202f]+/g, " ").trim();
const unescaped = (html) => html.replace(/<[^>]*>/g, " ").replace(/&lt;/g, "<").replace(/&gt;/g, ">").replace(/&#39;|&#x27;/g, "'").replace(/&quot;/g, '"').replace(/&amp;/g, "&");

/** The part within the tolerance that a sentence reports: percent, or a count of holes. */
function part(sentence) {
  const holes = /(\d+) of (\d+) holes (?:is|are|can)/.exec(sentence) ?? /All (\d+) holes/.exec(sentence);
  if (holes) return `${holes[1]} holes`;
  if (/no point o[nf] the/i.test(sentence)) return "0 %";
  if (/the whole (plane|plate|path|box) is within/i.test(sentence)) return "100 %";
  const percent = /([\d.]+) % of the (?:plane|plate|path|box) is within/.exec(sentence);
  assert.ok(percent, sentence);
  return `${Math.round(Number(percent[1]))} %`;
}

for (const example of readdirSync(EXAMPLES))
  test(`${example}: page, terminal and report`, async () => {
    const own = await serve((text) => text, example);
    const out = mkdtempSync(join(tmpdir(), "armill-headline-"));
    const terminal = plain(execFileSync(process.env.ARMILL_BIN, ["run", own.folder, "--out", join(out, "out")], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] }));
    const result = JSON.parse(readFileSync(join(out, "out", "result.json"), "utf8"));
    const sentence = plain(result.answer);
    assert.ok(terminal.startsWith(sentence), `terminal: ${terminal.slice(0, 300)}`);
    assert.ok(plain(unescaped(readFileSync(join(out, "out", "report.html"), "utf8"))).includes(sentence), "report");

    const page = await open(browser, own.url);
    // The part that comes out of a path is cut after its view; its numbers are in a panel of their own.
    const [ofPath] = sentence.split(" The surface of the part is between");
    assert.equal(plain(await page.locator("#panel-trust .panel-body p").first().innerText()), ofPath);
    const verdict = plain(await page.locator(".verdict-line").innerText());
    assert.equal(part(verdict), part(sentence), `${verdict} | ${sentence}`);
    // Worst and largest share are in the sentence too; the page rounds to fewer digits.
    const worst = plain(await page.locator("[data-follow=worst] .extreme-value").innerText());
    const numbers = [...sentence.matchAll(/([\d.]+) µm/g)].map(([, number]) => um(Number(number)));
    assert.ok(numbers.some((number) => worst.startsWith(`${number} `)), `${worst} in: ${sentence}`);
    const most = plain(await page.locator(".extreme.still .extreme-value").innerText()).split(" ")[0];
    assert.match(sentence, new RegExp(`largest contribution: (joint|the) ${most}\\b`));
    assert.deepEqual(page.complaints, []);
    await page.context().close();
    await own.stop();
    rmSync(out, { recursive: true, force: true });
  });
