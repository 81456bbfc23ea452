// A robot in its own shape: a URDF with meshes, as text and in binary; one that is missing or broken leaves the drawn arm.

import assert from "node:assert/strict";
import { mkdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { difference, launch, open, serve, settled, still, until } from "./setup.mjs";

let server, browser;
/** Joints of a made-up arm: name, where in the link before, axis; the box of the link behind it, from and to, m. */
const LINKS = [
  [null, null, null, [-0.16, -0.16, 0], [0.16, 0.16, 0.3]],
  ["A1", "0 0 0.3", "0 0 1", [-0.11, -0.13, 0], [0.2, 0.13, 0.22]],
  ["A2", "0.15 0 0.15", "0 1 0", [-0.08, -0.1, -0.05], [0.08, 0.1, 0.65]],
  ["A3", "0 0 0.6", "0 1 0", [-0.1, -0.08, -0.05], [0.25, 0.08, 0.25]],
  ["A4", "0.2 0 0.2", "1 0 0", [0, -0.06, -0.06], [0.45, 0.06, 0.06]],
  ["A5", "0.44 0 0", "0 1 0", [-0.05, -0.05, -0.05], [0.06, 0.05, 0.05]],
  ["A6", "0.06 0 0", "1 0 0", [0, -0.035, -0.035], [0.04, 0.035, 0.035]],
];
/** The triangles of a box. */
function triangles([x0, y0, z0], [x1, y1, z1]) {
  const c = [[x0, y0, z0], [x1, y0, z0], [x1, y1, z0], [x0, y1, z0], [x0, y0, z1], [x1, y0, z1], [x1, y1, z1], [x0, y1, z1]];
  return [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], [2, 3, 7], [2, 7, 6], [1, 2, 6], [1, 6, 5], [0, 4, 7], [0, 7, 3]].map((t) => t.map((i) => c[i]));
}
const asText = (all) => `solid s\n${all.map((t) => `facet normal 0 0 0\nouter loop\n${t.map((p) => `vertex ${p.join(" ")}\n`).join("")}endloop\nendfacet\n`).join("")}endsolid s\n`;
function asBinary(all) {
  const bytes = Buffer.alloc(84 + 50 * all.length);
  bytes.writeUInt32LE(all.length, 80);
  // Of a box the normals are made anew by the page.
  all.forEach((t, i) => t.flat().forEach((v, k) => bytes.writeFloatLE(v, 84 + 50 * i + 12 + 4 * k)));
  return bytes;
}
const URDF = `<robot name="boxes">${LINKS.map((_, i) => `<link name="l${i}"><visual><geometry><mesh filename="package://boxes/meshes/l${i}.stl"${i % 2 ? ' scale="0.001 0.001 0.001"' : ""}/></geometry></visual></link>`).join("")}<link name="tool0"/>
${LINKS.slice(1).map(([name, at, axis], i) => `<joint name="${name}" type="revolute"><parent link="l${i}"/><child link="l${i + 1}"/><origin xyz="${at}"/><axis xyz="${axis}"/><limit lower="-3" upper="3"/></joint>`).join("\n")}
<joint name="f" type="fixed"><parent link="l6"/><child link="tool0"/><origin xyz="0.04 0 0" rpy="0 1.5707963267948966 0"/></joint></robot>`;
const STUDY = `format = 1
title = "A robot in its own shape"
robot = "boxes.urdf"
tolerance_um = 60
plane = { centre_mm = [950, 0, 700], half_size_mm = 200, step_mm = 20 }
load = { cases_n = [[3, 5, 5], [3, -5, 5]] }
tool = { flange_from_tool_mm_deg = [0, 0, 120, 0, 0, 0] }
compliance = { rad_per_n_m = [2.1e-6, 2.5e-6, 4.0e-6, 6.0e-6, 6.0e-6, 8.0e-6], source = "made up" }
`;
const put = () =>
  LINKS.forEach(([, , , from, to], i) => {
    const big = i % 2 ? 1000 : 1;
    const all = triangles(from.map((v) => v * big), to.map((v) => v * big));
    writeFileSync(join(server.folder, `meshes/l${i}.stl`), i % 3 === 0 ? asText(all) : asBinary(all));
  });

before(async () => {
  server = await serve(() => STUDY.replace('"boxes.urdf"', '"yaskawa/mh12"').replace(/compliance.*\n/, ""));
  mkdirSync(join(server.folder, "meshes"));
  writeFileSync(join(server.folder, "boxes.urdf"), URDF);
  writeFileSync(join(server.folder, "study.toml"), STUDY);
  put();
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** The page with the robot, after it has requested this number of meshes, and their responses. */
async function shown(expected = LINKS.length) {
  const page = await open(browser, server.url, { answers: false });
  const requests = [];
  page.on("response", (r) => r.url().endsWith("/api/mesh") && requests.push(r.status()));
  await settled(page);
  await until(() => requests.length >= expected);
  // A further request would follow at once.
  await page.waitForTimeout(400);
  await page.locator(".shown summary").click();
  return { page, requests, own: page.locator(".shown label", { hasText: "CAD meshes" }) };
}
/** The scene; the pointer far away, so that nothing of it depends on where it is. */
async function stage(page) {
  await page.mouse.move(0, 0);
  await still(page);
  return page.locator(".stage canvas").screenshot();
}
const same = async (page, a, b) => (await difference(page, a, b)) < 0.001;

test("the meshes are fetched once each, drawn, and can be taken away", async () => {
  const { page, requests, own } = await shown();
  assert.deepEqual(requests, LINKS.map(() => 200));
  assert.ok(await own.isVisible());
  const boxes = await stage(page);
  await own.locator("input").uncheck();
  assert.ok(!(await same(page, await stage(page), boxes)), "another arm is drawn");
  await own.locator("input").check();
  assert.ok(await same(page, await stage(page), boxes), "the same as before");
  // Another posture moves them without asking again.
  await page.locator("#panel-branches .branch").last().click();
  assert.ok(!(await same(page, await stage(page), boxes)), "its pose differs");
  assert.equal(requests.length, LINKS.length);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("a mesh that is none, and one that is missing: the arm is drawn from its chain", async () => {
  writeFileSync(join(server.folder, "meshes/l3.stl"), "no mesh at all");
  const broken = await shown();
  assert.equal(broken.requests.length, LINKS.length);
  await broken.own.locator("input").uncheck();
  const without = await stage(broken.page);
  await broken.own.locator("input").check();
  assert.ok(await same(broken.page, await stage(broken.page), without));
  assert.deepEqual(broken.page.complaints, []);
  await broken.page.context().close();
  rmSync(join(server.folder, "meshes/l3.stl"));
  const missing = await shown(0);
  assert.deepEqual(missing.requests, []);
  assert.ok(!(await missing.own.isVisible()));
  await missing.page.context().close();
  put();
});
