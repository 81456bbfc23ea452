// The cell: its bodies in the scene, the two nearest with their distance, contact in red, points in collision in the legend.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { difference, launch, open, serve, settled, still } from "./setup.mjs";

let server, browser;
/** A plate in front of the robot, beside it a fence; a spindle of 160 mm meets it at y' = 300 mm. */
const STUDY = `format = 1
title = "A fence beside the plate"
robot = "yaskawa/mh12"
tolerance_um = 60
plane = { centre_mm = [1000, 0, 800], half_size_mm = 320, step_mm = 20 }
load = { cases_n = [[3, 5, 5], [3, -5, 5]] }
posture = { branch = "front elbow-up no-flip" }

[tool]
flange_from_tool_mm_deg = [0, 0, 220, 0, 0, 0]

[[tool.body]]
name = "spindle"
cylinder_mm = { from = [0, 0, 0], to = [0, 0, 150], diameter = 160 }

[[tool.body]]
cuts = true
cylinder_mm = { from = [0, 0, 150], to = [0, 0, 220], diameter = 12 }

[part]
box_mm = { from = [-320, -320, -80], to = [320, 320, 0] }

[[obstacle]]
name = "fence"
box_mm = { from = [300, 340, 0], to = [1300, 370, 1500] }

[[obstacle]]
name = "clamp"
mesh = "clamp.obj"

[[analysis]]
kind = "map"
name = "plate"

[[analysis]]
kind = "path"
name = "edge"
circle.radius_mm = 300
`;
/** A wedge at the lower edge of the plate, mm. */
const CLAMP = "v 980 -60 440\nv 1080 -60 440\nv 1080 -60 480\nv 980 60 440\nv 1080 60 440\nv 1080 60 480\nf 1 2 3\nf 4 6 5\nf 1 4 5\nf 1 5 2\nf 2 5 6\nf 2 6 3\nf 1 3 6\nf 1 6 4\n";

before(async () => {
  server = await serve(() => STUDY);
  writeFileSync(join(server.folder, "clamp.obj"), CLAMP);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** What the command says of the posture of the study with the tool there. */
function command(y, z) {
  // The plate faces the robot: its x is x of the base, y' its y, z' its z.
  const out = execFileSync(process.env.ARMILL_BIN, ["pose", join(server.folder, "study.toml"), "--at-mm", `1000,${y},${800 + z}`, "--json"], { encoding: "utf8" });
  return JSON.parse(out).postures.find(({ branch }) => branch === "front elbow-up no-flip");
}

async function send(page, y, z) {
  await page.fill("#target-y", String(y));
  await page.fill("#target-z", String(z));
  await page.waitForTimeout(150);
  await settled(page);
}
const label = (page, kind) => page.locator(`.labels .label.${kind}`).first();
const stage = async (page) => {
  await page.mouse.move(0, 0);
  await still(page);
  return page.locator(".stage canvas").screenshot();
};

test("the nearest bodies are those of the command, and in the fence they are red", async () => {
  const page = await open(browser, server.url);
  const meshes = [];
  page.on("response", (response) => response.url().endsWith("/api/body-mesh") && meshes.push(response.status()));
  await send(page, 0, 0);
  const free = command(0, 0);
  assert.ok(free.clearance_mm > 1);
  assert.equal(await label(page, "clear").textContent(), `${free.clearance_mm.toFixed(1)} mm  ${free.nearest.join(" – ")}`);
  assert.ok(await page.locator("#panel-point dd", { hasText: free.nearest.join(" – ") }).isVisible());
  await send(page, 200, 0);
  const nearer = command(200, 0);
  assert.ok(nearer.nearest.includes("fence"));
  assert.equal(await label(page, "clear").textContent(), `${nearer.clearance_mm.toFixed(1)} mm  ${nearer.nearest.join(" – ")}`);
  await send(page, 300, 0);
  assert.equal(command(300, 0).clearance_mm, 0);
  assert.match(await label(page, "near").textContent(), /^0\.0 mm .*fence/);
  assert.match(await page.locator("#panel-point .warn").first().textContent(), /^In contact: .*fence/);
  assert.ok(await page.locator(".legend .mark.collision").isVisible());
  assert.ok(meshes.every((status) => status === 200));
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("the mesh of the clamp is requested once; the bodies can be taken away", async () => {
  const page = await open(browser, server.url, { answers: false });
  const meshes = [];
  page.on("response", (response) => response.url().endsWith("/api/body-mesh") && meshes.push(response.status()));
  await settled(page);
  await send(page, 100, 0);
  await send(page, 0, 100);
  assert.deepEqual(meshes, [200]);
  await page.locator(".shown summary").click();
  const bodies = page.locator(".shown label", { hasText: "Bodies of the cell" }).locator("input");
  const all = await stage(page);
  await bodies.uncheck();
  assert.ok((await difference(page, await stage(page), all)) > 0.002, "the picture without bodies differs");
  await bodies.check();
  assert.ok((await difference(page, await stage(page), all)) < 0.001, "as before");
  await page.context().close();
});

test("a path into the fence: its points in collision have a colour, and the pointer names the bodies", async () => {
  const page = await open(browser, server.url);
  await page.selectOption("#field-analysis", "edge");
  await settled(page);
  assert.ok(await page.locator(".legend .mark.collision").isVisible());
  assert.match(await page.locator(".verdict").textContent(), /\d+ in collision/);
  // Somewhere on the fence, which is the only body at the top of its picture.
  const box = await page.locator(".stage canvas").boundingBox();
  const names = new Set();
  for (let i = 1; i < 24; i++)
    for (let j = 2; j < 10; j++) {
      await page.mouse.move(box.x + (box.width * i) / 24, box.y + (box.height * j) / 10);
      const tip = page.locator(".tip b");
      if (await tip.isVisible()) names.add(await tip.textContent());
    }
  assert.ok(names.has("fence"), [...names].join());
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

/** A ring on a turntable in front of the robot. */
const TURNTABLE = `format = 1
title = "A ring on a turntable"
robot = "kuka/kr210r2700extra"
tolerance_um = 500
base = "table"
tool = { flange_from_tool_mm_deg = [0, 0, 200, 0, 0, 0] }
plane = { centre_mm = [0, 0, 50], tilt_deg = 90, half_size_mm = 100, step_mm = 50 }

[[obstacle]]
name = "wall"
box_mm = { from = [-2600, 1200, -500], to = [1000, 1300, 1500] }

[[analysis]]
kind = "path"
name = "ring"
load = { frame = "feed", cases_n = [[0, 0, 50]] }
circle = { radius_mm = 900 }
step_mm = 200

[positioner]
robot = "table.toml"
base_from_root_mm_deg = [2300, 150, 0, 0, 0, 20]
joints_deg = [0]

[posture.search]
step_deg = 30
axes = [{ joint = "turn", range_deg = [-360, 360], deg_per_mm = 1 }]
`;
const TABLE = `format = 1
name = "Turntable"
chain = { source = "made-up", motions = [{ along = "z", length_mm = 400 }, { about = "z", joint = "turn" }, { along = "z", length_mm = 100 }] }

[[joint]]
name = "turn"
sign = -1
limits_deg = [-360, 360]
max_speed_deg_per_s = 90
source = "made-up"
compliance_rad_per_n_m = 2e-7
compliance_source = "made-up"

[sources.made-up]
what = "all"
where = "this test"
licence = "none needed"
`;

test("the ground stands still in the picture while a turntable turns the part", async () => {
  const own = await serve(() => TURNTABLE);
  writeFileSync(join(own.folder, "table.toml"), TABLE);
  const page = await open(browser, own.url, { answers: false });
  const table = () => page.locator(".bars.joints").innerText();
  const ticks = () =>
    page.locator(".label.tick").evaluateAll((all) => all.map((label) => (label.style.visibility === "hidden" ? null : [label.textContent, ...(label.style.transform.match(/-?[\d.]+/g) ?? []).map(Number)])));
  try {
    await settled(page);
    await page.locator(".charts").focus();
    await page.keyboard.press("Home");
    await settled(page);
    const [first, turned_first] = [await ticks(), await table()];
    await page.keyboard.press("End");
    await settled(page);
    assert.notEqual(await table(), turned_first);
    const last = await ticks();
    // Other labels may cover one.
    const both = first.map((tick, i) => [tick, last[i]]).filter(([tick, there]) => tick && there);
    assert.ok(both.length > 4, `${both.length} of ${first.length}`);
    for (const [[text, x, y], there] of both) {
      assert.equal(there[0], text);
      assert.ok(Math.abs(there[1] - x) < 1 && Math.abs(there[2] - y) < 1, `${text} at ${x}, ${y}: ${there}`);
    }
    assert.deepEqual(page.complaints, []);
  } finally {
    await page.context().close();
    await own.stop();
  }
});
