// A stand-in for `armill serve` while the page is built: the same routes, answered by the real command line.
// node dev/server.mjs [PORT]; env ARMILL = path of the armill binary. No token is asked for, nothing is protected.
import { execFile } from "node:child_process";
import { createServer } from "node:http";
import { mkdtempSync, readFileSync, writeFileSync, existsSync, readdirSync, statSync } from "node:fs";
import { extname, join } from "node:path";
import { tmpdir } from "node:os";

const ARMILL = process.env.ARMILL ?? "/work/main/target/debug/armill";
const FILE = process.env.STUDY ?? "/work/main/studies/mh12-groove/study.toml";
const DIST = new URL("../dist/", import.meta.url).pathname;
const work = mkdtempSync(join(tmpdir(), "armill-dev-"));
let disk = readFileSync(FILE, "utf8");
const cache = new Map();

const armill = (args, cwd = work) =>
  new Promise((ok) => execFile(ARMILL, args, { cwd, maxBuffer: 1 << 30 }, (error, stdout, stderr) => ok({ rc: error ? error.code : 0, stdout, stderr })));

// ---- The study as text: blocks between headers ----
function blocks(text) {
  const out = [{ header: "", lines: [] }];
  for (const line of text.split("\n")) {
    if (/^\[/.test(line)) out.push({ header: line.replace(/#.*/, "").trim(), lines: [line] });
    else out.at(-1).lines.push(line);
  }
  return out;
}
const nameOf = (block) => /^name = "(.*)"/m.exec(block.lines.join("\n"))?.[1];
const only = (text, ask) =>
  blocks(text)
    .filter((b) => (b.header === "[[ask]]" ? ask === null || nameOf(b) === ask : !["[[statement]]", "[place]", "[measured]"].includes(b.header)))
    .map((b) => b.lines.join("\n"))
    .join("\n");
const toml = (v) => (Array.isArray(v) ? `[${v.map(toml).join(", ")}]` : typeof v === "string" ? JSON.stringify(v) : String(v));
function set(text, ask, key, value) {
  const all = blocks(text);
  const [table, leaf] = key.includes(".") ? key.split(".") : [null, key];
  let block, name;
  if (ask !== null) {
    block = all.find((b) => b.header === "[[ask]]" && nameOf(b) === ask);
    name = key;
    const inline = block.lines.findIndex((l) => l.startsWith(`${table} = {`));
    if (table && inline >= 0) {
      const old = new RegExp(`${leaf} = (\\[[^\\]]*\\]|[^,}]+)`);
      block.lines[inline] = old.test(block.lines[inline])
        ? block.lines[inline].replace(old, `${leaf} = ${toml(value)} `)
        : block.lines[inline].replace("{", `{ ${leaf} = ${toml(value)},`);
      return all.map((b) => b.lines.join("\n")).join("\n");
    }
  } else {
    block = table ? all.find((b) => b.header === `[${table}]`) : all[0];
    name = leaf;
  }
  const at = block.lines.findIndex((l) => l.startsWith(`${name} =`));
  if (value === null) at >= 0 && block.lines.splice(at, 1);
  else if (at >= 0) block.lines[at] = `${name} = ${toml(value)}`;
  else block.lines.splice(1, 0, `${name} = ${toml(value)}`);
  return all.map((b) => b.lines.join("\n")).join("\n");
}

// ---- What the command says ----
async function check(text) {
  const folder = mkdtempSync(join(work, "c-"));
  writeFileSync(join(folder, "study.toml"), text);
  const { stdout } = await armill(["check", "study.toml", "--json"], folder);
  const problems = JSON.parse(stdout || "{}").problems ?? [];
  const asks = blocks(text).filter((b) => b.header === "[[ask]]").map((b) => ({ name: nameOf(b), kind: /^kind = "(.*)"/m.exec(b.lines.join("\n"))?.[1], keys: [] }));
  return { problems, title: /^title = "(.*)"/m.exec(text)?.[1], robot: /^robot = "(.*)"/m.exec(text)?.[1], asks };
}
async function answer(text, ask) {
  const key = `${ask}\n${text}`;
  if (!cache.has(key)) {
    const folder = mkdtempSync(join(work, "r-"));
    writeFileSync(join(folder, "study.toml"), only(text, ask));
    const run = await armill(["run", "study.toml", "--json", "--no-pictures"], folder);
    if (run.rc !== 0) throw { status: 422, body: { error: { kind: "invalid-input", message: run.stderr.slice(0, 400), problems: (await check(text)).problems } } };
    cache.set(key, run.stdout);
  }
  return cache.get(key);
}
const settingOf = (j) => (j.maps[0] ?? j.paths[0] ?? j.volumes[0])?.setting;
async function values(text, ask) {
  const j = JSON.parse(await answer(text, ask));
  const s = settingOf(j);
  const y = j.maps[0]?.grid?.y_mm;
  return {
    robot: j.robot.name, kind: j.maps.length > 1 ? "sections" : j.maps.length ? "map" : j.paths.length ? "path" : "volume", base: s.base,
    centre_mm: s.centre_mm, tilt_deg: s.tilt_deg, half_size_mm: y ? [y[0], y[0]] : [400, 400], step_mm: y ? y[0] - y[1] : 10,
    flange_from_tool_mm_deg: [0, 0, s.tool_length_mm, 0, 0, 0], tool_length_mm: s.tool_length_mm, cases_n: s.cases_n, limit_um: s.limit_um,
    branch: (j.maps[0] ?? j.paths[0] ?? j.volumes[0]).branch, spin_deg: 0, branch_meant: (j.maps[0] ?? j.paths[0] ?? j.volumes[0]).branch,
    branches: ["front elbow-up", "front elbow-down", "back elbow-up", "back elbow-down"].flatMap((b) => [`${b} no-flip`, `${b} flip`]),
  };
}
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const along = (c, a, u, b, v) => c.map((x, i) => x + a * u[i] + b * v[i]);
const plateOf = (s, half) => {
  const y = [0, 1, 0], z = cross(y, s.normal_axis);
  return { centre_mm: s.centre_mm, normal_axis: s.normal_axis, y_axis: y, z_axis: z, corners_mm: [[1, 1], [1, -1], [-1, -1], [-1, 1]].map(([a, b]) => along(s.centre_mm, a * half[0], y, b * half[1], z)) };
};
// The MH12's own chain (figures of the paper); other robots draw as it does.
function drawing(q, tool, base) {
  const r = q.map((x) => (x * Math.PI) / 180), lift = 0;
  let R = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], p = [0, 0, lift];
  const joints = [], links = [[...p]];
  const turn = (axis, a) => {
    const [c, s] = [Math.cos(a), Math.sin(a)];
    const T = axis === 0 ? [[1, 0, 0], [0, c, -s], [0, s, c]] : axis === 1 ? [[c, 0, s], [0, 1, 0], [-s, 0, c]] : [[c, -s, 0], [s, c, 0], [0, 0, 1]];
    R = R.map((row) => [0, 1, 2].map((k) => row[0] * T[0][k] + row[1] * T[1][k] + row[2] * T[2][k]));
  };
  const move = (v) => { p = p.map((x, i) => x + R[i][0] * v[0] + R[i][1] * v[1] + R[i][2] * v[2]); links.push([...p]); };
  const joint = (name, axis, sign, i) => { joints.push({ name, origin_mm: [...p], axis: R.map((row) => row[axis] * sign), kind: "turns" }); turn(axis, sign * r[i]); };
  joint("S", 2, 1, 0); move([0, 0, 450]); move([155, 0, 0]);
  joint("L", 1, 1, 1); move([0, 0, 614]);
  joint("U", 1, -1, 2); move([0, 0, 200]);
  joint("R", 0, -1, 3); move([640, 0, 0]);
  joint("B", 1, -1, 4); move([100, 0, 0]);
  joint("T", 0, -1, 5);
  const flange = [...p], axis = R.map((row) => row[0]);
  return { joints, flange_mm: flange, tool_mm: along(flange, tool, axis, 0, axis), tool_axis: axis, links_mm: links };
}
async function pose({ text, ask, at, case: n = 1 }) {
  const j = JSON.parse(await answer(text, ask)), s = (j.maps[at.section ?? 0] ?? { setting: settingOf(j) }).setting;
  const plate = plateOf(s, [1, 1]);
  const xyz = at.xyz_mm ?? (at.point !== undefined ? (await scene(text, ask)).points.xyz_mm[at.point] : null) ?? ("y_mm" in at ? along(s.centre_mm, at.y_mm, plate.y_axis, at.z_mm, plate.z_axis) : s.centre_mm);
  const robot = /^robot = "(.*)"/m.exec(text)[1];
  const ask_case = (w) => armill(["pose", robot, ...(at.joints_deg ? [`--joints-deg=${at.joints_deg}`] : [`--at-mm=${xyz}`, `--tilt-deg=${s.tilt_deg}`]), `--tool-mm=0,0,${s.tool_length_mm}`, `--wrench-n=${w}`, `--base=${s.base}`, "--json"]);
  const all = await Promise.all(s.cases_n.map(ask_case));
  if (all[0].rc !== 0) throw { status: 422, body: { error: { kind: "invalid-input", message: all[0].stderr.trim(), problems: [] } } };
  const answers = all.map((x) => JSON.parse(x.stdout));
  const parts = (d) => {
    const normal = d[0] * s.normal_axis[0] + d[1] * s.normal_axis[1] + d[2] * s.normal_axis[2], full = Math.hypot(...d);
    return { in_plane_um: Math.sqrt(Math.max(0, full * full - normal * normal)), normal_um: normal, full_um: full };
  };
  const full = (x, k) => {
    const d = x.postures[k].deviation_um, p = parts(d), n = s.normal_axis;
    const flat = d.map((v, i) => v - p.normal_um * n[i]);
    return { ...p, share_um: x.postures[k].joint_share_um.map((j) => (j[0] * flat[0] + j[1] * flat[1] + j[2] * flat[2]) / p.in_plane_um), in_plane_u_um: 0.2 * p.in_plane_um, permissible_along_load_n: 2.4 };
  };
  const a = answers[n - 1];
  return {
    answer: a,
    drawings: a.postures.map((p) => drawing(p.joints_deg, s.tool_length_mm, s.base)),
    limits: [[-170, 170], [-90, 155], [-175, 240], [-180, 180], [-135, 135], [-360, 360]].map(([lower_deg, upper_deg], i) => ({ name: "SLURBT"[i], lower_deg, upper_deg, unit: "deg" })),
    in_plane: a.postures.map((_, k) => answers.map((x) => full(x, k))),
  };
}
async function scene(text, ask) {
  const j = JSON.parse(await answer(text, ask)), s = settingOf(j);
  const v = await values(text, ask);
  const half = j.maps[0] ? [j.maps[0].grid.y_mm[0], j.maps[0].grid.z_mm.at(-1)] : [200, 200];
  let points = null;
  if (j.paths.length) {
    const rows = (await table(text, ask)).trim().split("\n").filter((l) => !l.startsWith("#"));
    const head = rows[0].split(","), col = (name) => rows.slice(1).map((l) => { const x = l.split(",")[head.indexOf(name)]; return x === "" || x === undefined ? null : Number(x); });
    const [x, y, z] = ["x_mm", "y_mm", "z_mm"].map(col);
    const which = col("deciding_case");
    const d = ["x", "y", "z"].map((a) => which.map((n, i) => col(`deviation_${a}_case_${n}_um`)[i]));
    points = { xyz_mm: x.map((_, i) => [x[i], y[i], z[i]]), deviation_um: x.map((_, i) => (Number.isFinite(d[0][i]) ? d.map((c) => c[i]) : null)), columns: { in_plane_um: col("in_plane_um"), normal_um: col("normal_um"), full_um: col("full_um") } };
  }
  const b = j.volumes[0];
  if (b) {
    const out = await outOf(text, ask, "--csv", "--no-pictures");
    const rows = readFileSync(join(out, readdirSync(out).find((f) => f.endsWith(".csv"))), "utf8").trim().split("\n").filter((l) => !l.startsWith("#")).map((l) => l.split(","));
    const [xi, yi, zi, vi] = ["x_mm", "y_mm", "z_mm", "in_plane_um"].map((n) => rows[0].indexOf(n));
    points = { xyz_mm: rows.slice(1).map((r) => [r[xi], r[yi], r[zi]].map(Number)), deviation_um: [], columns: { in_plane_um: rows.slice(1).map((r) => (r[vi] === "" ? null : Number(r[vi]))) } };
  }
  const side = (k) => [0, 1, 2].map((i) => (i === k ? (b.point_counts[k] - 1) * b.step_mm : 0));
  return {
    robot: v.robot, base_mm: [0, 0, s.base === "controller" ? 450 : 0], plate: plateOf(s, half),
    sections: j.maps.length > 1 ? j.maps.map((m) => ({ label: m.name, plate: plateOf(m.setting, [m.grid.y_mm[0], m.grid.z_mm.at(-1)]) })) : [],
    points, box: b ? { corner_mm: b.origin_mm, sides_mm: [side(0), side(1), side(2)], counts: b.point_counts } : null,
  };
}
async function outOf(text, ask, ...more) {
  const folder = mkdtempSync(join(work, "p-"));
  writeFileSync(join(folder, "study.toml"), only(text, ask));
  const run = await armill(["run", "study.toml", ...more], folder);
  if (run.rc !== 0) throw { status: 422, body: { error: { kind: "invalid-input", message: run.stderr, problems: [] } } };
  return join(folder, "out");
}
async function table(text, ask) {
  const out = await outOf(text, ask);
  return readFileSync(join(out, readdirSync(out).find((f) => f.endsWith(".csv"))), "utf8");
}
async function pictures(text, ask) {
  const out = await outOf(text, ask);
  return { pictures: readdirSync(out).filter((f) => f.endsWith(".svg")).map((f) => ({ name: f.slice(0, -4), title: f.slice(0, -4), svg: readFileSync(join(out, f), "utf8") })) };
}
const study = async () => ({ file: "study.toml", folder: "mh12-groove", writable: true, version: String(disk.length), text: disk, armill: "0.1.0", ...(await check(disk)) });

const jobs = [];
function start(kind, text) {
  const job = { id: `j${jobs.length + 1}`, kind, title: `${kind} of the study`, state: "running", done: 0, of: 120, best: null, started_s_ago: 0, seconds: 0, error: null, files: [] };
  jobs.unshift(job);
  const timer = setInterval(() => {
    if (job.state !== "running") return clearInterval(timer);
    job.done += 2; job.seconds += 0.1; job.best = `${(140 - job.done / 2).toFixed(1)} µm at (1000, 0, 800) mm`;
    if (job.done >= job.of) { job.state = "done"; job.files = ["out/report.html"]; }
  }, 100);
  return job;
}

const TYPES = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
const CSP = "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; worker-src 'self' blob:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'";
async function route(method, path, body, respond) {
  const at = `${method} ${path}`;
  if (at === "GET /api/study") return study();
  if (at === "PUT /api/study") { if (body.version !== String(disk.length)) throw { status: 409, body: { error: { kind: "conflict", message: "the file on disk has changed since it was opened", problems: [] } } }; disk = body.text; return study(); }
  if (at === "POST /api/check") return check(body.text);
  if (at === "POST /api/change") { let text = body.text; for (const c of body.changes) text = set(text, body.ask, c.key, c.value); return { text, ...(await check(text)) }; }
  if (at === "POST /api/answer") return respond(await answer(body.text, body.ask), "application/json");
  if (at === "POST /api/values") return values(body.text, body.ask);
  if (at === "POST /api/pose") return pose(body);
  if (at === "POST /api/scene") return scene(body.text, body.ask);
  if (at === "POST /api/table") return respond(await table(body.text, body.ask), "text/csv");
  if (at === "POST /api/pictures") return pictures(body.text, body.ask);
  if (at === "GET /api/robots") return respond((await armill(["robots", "--json"])).stdout, "application/json");
  if (at === "GET /api/jobs") return { jobs };
  if (at === "POST /api/jobs") return { id: start(body.kind, body.text).id };
  if (at === "GET /api/files") return { files: [{ name: "study.toml", bytes: disk.length, modified_s_ago: 100 }, { name: "out/report.html", bytes: 812345, modified_s_ago: 4000 }] };
  const job = jobs.find((j) => path.startsWith(`/api/jobs/${j.id}`));
  if (job && method === "DELETE") { job.state = "cancelled"; return job; }
  if (job && !path.endsWith("/events")) return job;
  throw { status: 404, body: { error: { kind: "not-found", message: `${path} is not here`, problems: [] } } };
}
createServer(async (req, res) => {
  const url = new URL(req.url, "http://localhost");
  const chunks = []; for await (const c of req) chunks.push(c);
  res.setHeader("Content-Security-Policy", CSP);
  const respond = (text, type) => { res.setHeader("Content-Type", type); res.end(text); return undefined; };
  if (!url.pathname.startsWith("/api/")) {
    const file = join(DIST, url.pathname === "/" ? "index.html" : url.pathname);
    if (!existsSync(file) || !statSync(file).isFile()) { res.statusCode = 404; return res.end(); }
    return respond(readFileSync(file), TYPES[extname(file)] ?? "application/octet-stream");
  }
  const events = /^\/api\/jobs\/(\w+)\/events$/.exec(url.pathname);
  if (events) {
    res.setHeader("Content-Type", "text/event-stream");
    const job = jobs.find((j) => j.id === events[1]);
    const timer = setInterval(() => { res.write(`event: job\ndata: ${JSON.stringify(job)}\n\n`); if (job.state !== "running") { clearInterval(timer); res.end(); } }, 100);
    return req.on("close", () => clearInterval(timer));
  }
  try {
    const value = await route(req.method, url.pathname, chunks.length ? JSON.parse(Buffer.concat(chunks)) : {}, respond);
    if (value !== undefined) respond(JSON.stringify(value), "application/json");
  } catch (e) {
    res.statusCode = e.status ?? 500;
    respond(JSON.stringify(e.body ?? { error: { kind: "internal", message: String(e.stack ?? e), problems: [] } }), "application/json");
  }
}).listen(Number(process.argv[2] ?? 5199), "127.0.0.1", () => console.log(`http://127.0.0.1:${process.argv[2] ?? 5199}/?token=dev`));
