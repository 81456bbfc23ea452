// Jobs in the page: finished, cancelled, after a reload; their results in the page and as files.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, restart, serve, settled, um } from "./setup.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const study = (path, place = "") => `format = 1
robot = "yaskawa/mh12"
tolerance_um = 50
[plane]
centre_mm = [1000, 0, 800]
half_size_mm = 100
step_mm = 20
[load]
cases_n = [[3, 5, 5]]
[[analysis]]
kind = "path"
name = "groove"
circle.radius_mm = 100
${path}
${place}`;
// So few points and so little room that a search is over soon; so much work at each point that it is not.
const SMALL = study("step_mm = 60", "[place]\nx_mm = [900, 1100]\n");
const LARGE = study("step_mm = 0.5", "[place]\nx_mm = [700, 1200]\ny_mm = [-300, 300]\nz_mm = [400, 1100]\ntilt_deg = [-30, 60]\n").replace("tolerance_um = 50", "tolerance_um = 50\nload_dependent = true");

/** A page on a server of this study, at its jobs. */
async function at(text, work) {
  const server = await serve(() => text);
  try {
    const page = await open(browser, server.url);
    await page.click("#tab-jobs");
    await work(page, server.folder, server);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  } finally {
    await server.stop();
  }
}
const search_applied = (folder) => json(folder, "posture/result.json").paths[0].search.applied;
const json = (folder, name) => JSON.parse(readFileSync(join(folder, name), "utf8"));

test("a small placement runs to its end: its place is told, shown, and lies in the folder", () =>
  at(SMALL, async (page, folder, server) => {
    await page.click("[data-kind=place]");
    await page.waitForSelector(".job.done");
    const placed = json(folder, "place/placement.json");
    const words = await page.locator(".job.done").innerText();
    assert.ok(words.includes(`deviation ${placed.recommended.cost_um.toFixed(1)} ± `), `${words} does not report ${placed.recommended.cost_um}`);
    for (const name of ["place/placement.json", "place/result.json", "place/report.html"]) assert.ok(existsSync(join(folder, name)), name);
    assert.ok(!existsSync(join(folder, "place/place.rounds")));
    assert.match(await page.locator(".job.done header").innerText(), /^Placement\n/, "its kind, not only the study");
    // After a reload its result and its actions are there again.
    await page.reload();
    await page.getByRole("button", { name: "Apply this placement" }).waitFor();
    // Every file of the card can be opened, by an address without the token.
    const files = await page.locator(".job.done .files [data-file]").evaluateAll((all) => all.map((a) => a.dataset.file));
    assert.ok(files.length > 3);
    const token = new URL(server.url).searchParams.get("token");
    const requests = [];
    page.context().on("request", (request) => requests.push(request.url()));
    for (const file of files.filter((name) => name.endsWith(".csv")).slice(0, 1)) {
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`.job.done .files [data-file="${file}"]`).click()]);
      assert.deepEqual(readFileSync(await download.path()), readFileSync(join(folder, file)));
    }
    const [report] = await Promise.all([page.context().waitForEvent("page"), page.getByRole("button", { name: "Show the report" }).press("Enter")]);
    await report.waitForURL(/\/open\/[0-9a-f]{32}\/report\.html$/);
    await report.waitForSelector("h1");
    assert.equal(await report.evaluate(() => window.opener), null);
    // The address was for once.
    await report.reload();
    assert.match(await report.locator("body").innerText(), /has been used or is older than a minute/);
    await report.close();
    assert.ok(requests.length > 2 && requests.every((url) => !url.includes(token)), "the token is in no address");
    await page.getByRole("button", { name: "Apply this placement" }).click();
    await settled(page);
    assert.equal(Number(await page.inputValue("#field-x")), placed.place.centre_mm[0]);
    assert.notEqual(placed.place.centre_mm[0], 1000);
    // The path there is what the placement found.
    const worst = await page.locator("[data-follow=worst] .extreme-value").innerText();
    assert.ok(worst.startsWith(um(placed.recommended.cost_um)), `${worst}, ${placed.recommended.cost_um}`);
    // It is a change like others.
    await page.keyboard.press("Control+z");
    await page.waitForFunction(() => document.querySelector("#field-x").value === "1000");
  }));

test("a placement goes on over a reload and is shown again; cancelled it leaves no answer, and the next one ends", () =>
  at(LARGE, async (page, folder) => {
    await page.click("[data-kind=place]");
    await page.waitForSelector(".job.running progress");
    const counted = async () => Number(/^([\d.,]+) of/.exec((await page.locator(".job.running p").first().innerText()).replaceAll("\u202f", ""))?.[1] ?? -1);
    await page.waitForFunction(() => /about .* left/.test(document.querySelector(".job.running p")?.textContent ?? ""));
    const said = await page.locator(".job.running").innerText();
    assert.match(said, /^Placement\n/);
    assert.ok((said.match(/best so far/g) ?? []).length <= 1, said);
    await page.waitForFunction(() => / of /.test(document.querySelector(".job.running p")?.textContent ?? ""));
    const before = await counted();
    await page.reload();
    await page.waitForSelector(".job.running progress");
    await page.waitForFunction(() => / of /.test(document.querySelector(".job.running p")?.textContent ?? ""));
    assert.ok((await counted()) >= before, "it went on meanwhile");
    assert.equal(await page.locator(".job").count(), 1);
    // A second one waits for it, in another tab.
    const other = await page.context().newPage();
    await other.goto(page.url().replace(/#.*/, "#jobs"));
    await page.click("[data-kind=run]");
    await page.waitForSelector(".job.waiting");
    await page.locator(".job.running").getByRole("button", { name: "Cancel" }).click();
    await page.waitForSelector(".job.cancelled");
    assert.ok(!existsSync(join(folder, "place/placement.json")));
    await page.waitForSelector(".job.done");
    assert.ok(json(folder, "out/result.json").paths[0].points > 100);
    await other.close();
  }));

test("the best posture is searched to its end, its table lies in the folder", () =>
  at(`${SMALL}[posture.search]\nstep_deg = 30\n`, async (page, folder) => {
    await page.click("[data-kind=posture]");
    await page.waitForSelector(".job.done");
    const { search } = json(folder, "posture/result.json").paths[0];
    assert.equal(search.turns, 12);
    assert.ok((await page.locator(".job.done").innerText()).includes("posture/"), "its files are named");
    assert.match(readFileSync(join(folder, "posture/groove.csv"), "utf8"), /turn_deg/);
    assert.match(await page.locator(".job.done header").innerText(), /^Posture\n/);
    assert.match(await page.locator(".job.done .job-lines").innerText(), /^groove .*(µm less by the search|no significant gain)/);
    const apply = page.getByRole("button", { name: "Apply this search" });
    assert.equal(await apply.count(), search_applied(folder) ? 1 : 0);
  }));

test("compliances are identified from a table that was dropped, and the study takes the robot", () =>
  at(SMALL, async (page, folder) => {
    // A plan whose readings are what a typical arm would show.
    execFileSync(process.env.ARMILL_BIN, ["identify", "--plan", "14", "--robot", "yaskawa/mh12", "--out", join(folder, "..", "armill-plan.csv")], { stdio: "ignore" });
    const rows = readFileSync(join(folder, "..", "armill-plan.csv"), "utf8").trim().split(/\r?\n/).map((row) => row.split(","));
    const [first, expected] = [rows[0].indexOf("dx_mm"), rows[0].indexOf("expected_dx_mm")];
    for (const row of rows.slice(1)) for (let k = 0; k < 3; k++) row[first + k] = row[expected + k];
    await page.click("#tab-files");
    await page.setInputFiles("#pick", { name: "tests.csv", mimeType: "text/csv", buffer: Buffer.from(rows.map((row) => row.join(",")).join("\n")) });
    await page.waitForSelector(".said li");
    await page.click("#tab-jobs");
    await page.click("[data-kind=identify]");
    await page.getByRole("button", { name: "Start" }).click();
    await page.waitForSelector(".job.done");
    assert.match(readFileSync(join(folder, "identify/robot.toml"), "utf8"), /tests\.csv/);
    assert.match(await page.locator(".job.done").innerText(), /^Compliance identification\n.*springs from 14 load tests.*N m\/rad/s);
    await page.reload();
    await page.getByRole("button", { name: "Apply these compliances" }).click();
    await settled(page);
    await page.click("#tab-study");
    assert.match(await page.inputValue("#study-text"), /robot = "identify\/robot\.toml"/);
    await page.waitForSelector(".problems .fine");
    await page.click("#tab-live");
    await settled(page);
    assert.match(await page.locator("[data-follow=worst] .extreme-value").innerText(), /µm/);
    // A table that is none is told as such.
    writeFileSync(join(folder, "tests.csv"), "nothing\n");
    await page.click("#tab-jobs");
    await page.click("[data-kind=identify]");
    await page.getByRole("button", { name: "Start" }).click();
    await page.waitForSelector(".job.failed .note.warn");
  }));

test("a run with several analyses says each", () =>
  at(`${SMALL}\n[[analysis]]\nkind = "map"\nname = "plate"\n`, async (page) => {
    await page.click("[data-kind=run]");
    await page.waitForSelector(".job.done .job-lines");
    const lines = await page.locator(".job.done .job-lines li").allInnerTexts();
    assert.equal(lines.length, 2);
    assert.ok(lines.some((line) => /^plate .*within tolerance, worst .* µm/.test(line)) && lines.some((line) => /^groove /.test(line)), lines.join());
  }));

test("a finished job is in the list after a restart of the server, with its files", () =>
  at(SMALL, async (page, folder, server) => {
    await page.click("[data-kind=run]");
    await page.waitForSelector(".job.done");
    await server.end();
    await page.goto(await restart(server));
    await page.click("#tab-jobs");
    await page.waitForSelector(".job.done");
    assert.equal(await page.locator(".job").count(), 1);
    const [report] = await Promise.all([page.context().waitForEvent("page"), page.getByRole("button", { name: "Show the report" }).click()]);
    await report.waitForSelector("h1");
    // A new one is another one, though the server begins to count anew.
    await page.click("[data-kind=run]");
    await page.waitForSelector(".job.done + .job.done");
    assert.equal(await page.locator(".job").count(), 2);
  }));
