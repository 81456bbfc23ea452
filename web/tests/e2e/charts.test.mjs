// Charts of every kind of question: each is drawn, and can be had as SVG, PNG and the numbers behind it as CSV.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, open, serve, settled } from "./setup.mjs";

const STUDY = `format = 1
robot = "yaskawa/mh12"
tolerance_um = 200
tool = { flange_from_tool_mm_deg = [0, 0, 100, 0, 0, 0] }
plane = { centre_mm = [1000, 0, 800], half_size_mm = 150, step_mm = 25 }
load = { cases_n = [[6, 10, 10], [6, -10, 10]] }

[[analysis]]
kind = "map"
name = "plate"

[[analysis]]
kind = "sections"
name = "distances"
distances_mm = [900, 1000, 1100]

[[analysis]]
kind = "volume"
name = "space"
box = { half_size_mm = [100, 100, 100], step_mm = 25 }

[[analysis]]
kind = "path"
name = "groove"
circle = { radius_mm = 100 }

[[analysis]]
kind = "path"
name = "turned"
circle = { radius_mm = 100 }
step_mm = 20
posture.search = { step_deg = 30 }

[[analysis]]
kind = "holes"
name = "panel"
posture.search = { step_deg = 30 }
holes = { at_mm = [[0, 0, 0], [60, 20, 0], [-50, 60, 0], [20, -70, 0]] }

[measured]
analysis = "groove"
part = "part.csv"
radius_mm = 100
ballbar = ["run.csv"]
`;
/** A ball-bar run both ways, and a part: ellipses with what reverses. */
function measured(folder) {
  const um = (a) => 45 * Math.cos(2 * a - 0.7) + 18 * Math.cos(3 * a + 0.4);
  const rows = ["CCW", "CW"].flatMap((way) => Array.from({ length: 360 }, (_, k) => `${k},${(um((k * Math.PI) / 180) + (way === "CCW" ? 12 : -12) * Math.sign(Math.sin((k * Math.PI) / 180 - 0.3))).toFixed(4)},${way},1`));
  writeFileSync(join(folder, "run.csv"), `# radius_mm: 100\nangle_deg,radius_dev_um,direction,run\n${rows.join("\n")}\n`);
  writeFileSync(join(folder, "part.csv"), `angle_deg,deviation_um\n${Array.from({ length: 360 }, (_, k) => `${k},${(um((k * Math.PI) / 180) + 30 * Math.cos((2 * k * Math.PI) / 180)).toFixed(4)}`).join("\n")}\n`);
}
let server, browser;
before(async () => {
  server = await serve(() => STUDY.replace(/\[measured\][^]*/, ""));
  measured(server.folder);
  writeFileSync(join(server.folder, "study.toml"), STUDY);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** What each question draws, by the ends of the names of its pictures, and a column of its table. */
const CHARTS = {
  plate: [["region", "shares", "ellipse", "arm"], "in_plane_um"],
  distances: [[], "in_plane_um"],
  space: [[], "in_plane_um"],
  groove: [["along", "polar", "budget", "measured", "waves"], "in_plane_um"],
  turned: [["turns", "along"], "turn_deg"],
  panel: [["holes"], "in_plane_um"],
};
for (const [analysis, [names, column]] of Object.entries(CHARTS))
  test(`the charts of ${analysis} are drawn and can be downloaded as SVG, PNG and CSV`, async () => {
    const page = await open(browser, server.url);
    await page.selectOption("#field-analysis", analysis);
    await settled(page);
    await page.click("#tab-pictures");
    await page.waitForSelector(".picture img");
    const cards = page.locator(".picture");
    const drawn = await page.locator(".picture img").evaluateAll((images) => Promise.all(images.map((i) => i.decode().then(() => i.naturalWidth * i.naturalHeight))));
    assert.ok(drawn.length >= 1 && drawn.every((area) => area > 10_000), `${drawn}`);
    const files = [];
    for (let i = 0; i < drawn.length; i++) {
      const saved = {};
      for (const kind of ["SVG", "PNG", "CSV"]) {
        // Chromium takes ten downloads of a page at once, and drops what comes faster.
        await page.waitForTimeout(200);
        const [download] = await Promise.all([page.waitForEvent("download"), cards.nth(i).getByRole("button", { name: kind, exact: true }).click()]);
        assert.ok(download.suggestedFilename().endsWith(`.${kind.toLowerCase()}`), download.suggestedFilename());
        saved[kind] = readFileSync(await download.path());
        files.push(download.suggestedFilename());
      }
      assert.match(saved.SVG.toString(), /^<svg[^]*<\/svg>\s*$/);
      assert.deepEqual([...saved.PNG.subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47]);
      const budget = /-(budget|measured|waves)\.csv$/.test(files.at(-1));
      const lines = saved.CSV.toString().split("\n").filter((line) => !line.startsWith("#"));
      assert.ok(lines[0].split(",").includes(budget ? "sum_um" : column), `${files.at(-1)}: ${lines[0]}`);
      assert.ok(lines.length > 4, files.at(-1));
    }
    for (const name of names) assert.ok(files.some((file) => file.endsWith(`-${name}.svg`)), `${name} is among ${files}`);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });
