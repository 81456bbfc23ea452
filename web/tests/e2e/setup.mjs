// A real Chromium against a real server: `armill serve` on a copy of the paper's study, in a folder of its own.
// Env ARMILL_BIN: the armill binary, with the page in it. Env CHROMIUM: the browser, Debian's if left out. Env ARMILL_PAGE: a
// folder with a page that is shown in place of that in the binary, so that a change of the page needs no new binary.

import { spawn } from "node:child_process";
import { createRequire } from "node:module";
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { chromium } from "playwright-core";

export const STUDY = new URL("../../../studies/mh12-groove/study.toml", import.meta.url).pathname;
const FLAGS = ["--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--enable-unsafe-swiftshader"];

export const EXAMPLES = new URL("../../../studies/", import.meta.url).pathname;

/** Starts `armill serve` on a folder. */
async function started(folder) {
  const binary = process.env.ARMILL_BIN;
  if (!binary) throw new Error("ARMILL_BIN names no armill binary");
  const child = spawn(binary, ["serve", folder, "--no-open"], { stdio: ["ignore", "pipe", "inherit"] });
  const url = await new Promise((done, fail) => {
    createInterface({ input: child.stdout }).once("line", done);
    child.once("exit", (code) => fail(new Error(`armill serve ended with ${code}`)));
  });
  // A test that fails does not stop its server: that must not keep this process from ending.
  const kill = () => child.kill("SIGKILL");
  process.once("exit", kill);
  child.unref();
  child.stdout.unref();
  const end = () =>
    new Promise((done) => {
      child.ref();
      process.removeListener("exit", kill);
      child.removeAllListeners("exit");
      child.once("exit", done);
      child.kill("SIGTERM");
    });
  return { url, pid: child.pid, end };
}

/** `edit`: what the study is to be instead; `example`: the study that is copied with its files. */
export async function serve(edit = (text) => text, example = "mh12-groove") {
  const folder = mkdtempSync(join(tmpdir(), "armill-e2e-"));
  cpSync(join(EXAMPLES, example), folder, { recursive: true });
  writeFileSync(join(folder, "study.toml"), edit(readFileSync(join(EXAMPLES, example, "study.toml"), "utf8")));
  const server = { folder, ...(await started(folder)) };
  server.stop = async () => {
    const code = await server.end();
    rmSync(folder, { recursive: true, force: true });
    return code;
  };
  return server;
}

/** Starts a server that was ended again, on the same folder; its new address. */
export async function restart(server) {
  const { url, pid, end } = await started(server.folder);
  Object.assign(server, { pid, end });
  return url;
}

/** After this a test gives up, ms: nothing takes so long, also on a busy machine. */
export const PATIENCE = 300_000;

export const launch = () => chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });

/** Requests to the server by a program. */
export function client(url) {
  const at = new URL(url);
  const token = at.searchParams.get("token");
  return async (method, path, body) => {
    const response = await fetch(new URL(path, at), {
      method,
      headers: { Authorization: `Bearer ${token}`, "Content-Type": "application/json" },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
    if (!response.ok) throw new Error(`${method} ${path}: ${response.status} ${await response.text()}`);
    return response.json();
  };
}

/** A page on the server, with whatever the browser complained about. */
export async function open(browser, url, { width = 1280, height = 800, dark = false, scale = 1, answers = true } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", deviceScaleFactor: scale });
  context.setDefaultTimeout(PATIENCE);
  const page = await context.newPage();
  page.complaints = [];
  page.on("pageerror", (error) => page.complaints.push(String(error)));
  page.on("console", (message) => {
    const expected = /GPU stall|status of 4\d\d|GL Driver|ERR_CONNECTION_REFUSED|ERR_CONNECTION_RESET|ERR_EMPTY_RESPONSE/.test(message.text());
    if (message.type() === "error" && !expected) page.complaints.push(message.text());
  });
  page.on("request", (request) => {
    const to = new URL(request.url());
    if (to.protocol.startsWith("http") && to.host !== new URL(url).host) page.complaints.push(`requested ${to.href}`);
  });
  const own = process.env.ARMILL_PAGE;
  if (own) await page.route((to) => !/^\/(api|open)\//.test(to.pathname), (route) => route.fulfill({ path: join(own, new URL(route.request().url()).pathname.replace(/\/$/, "/index.html")) }));
  await page.goto(url);
  if (answers) await settled(page);
  return page;
}

/** The newest answer and the pose are on the screen. */
export async function settled(page) {
  await page.waitForTimeout(60);
  await page.waitForFunction(
    () => /\d ms/.test(document.querySelector(".pace")?.textContent ?? "") && document.querySelector("main")?.getAttribute("aria-busy") !== "true" && document.querySelector(".right")?.getAttribute("aria-busy") !== "true",
  );
  await drawn(page);
}

/** The scene is drawn as it is now: what the pointer is over is found. */
export const drawn = (page) => page.waitForFunction(() => document.querySelector(".stage")?.dataset.picture !== "waits");

/** The scene is drawn in its final resolution. */
export const still = (page) => page.waitForFunction(() => document.querySelector(".stage").dataset.picture === "still");

/** Waits until this is true; it is asked again and again. */
export async function until(isTrue) {
  for (const end = Date.now() + PATIENCE; !(await isTrue()); await new Promise((done) => setTimeout(done, 20))) if (Date.now() > end) throw new Error(`not within five minutes: ${isTrue}`);
}

/** A micrometre value as the page writes it. */
export function um(value) {
  const text = Math.abs(value).toFixed(Math.abs(value) < 99.95 ? 1 : 0);
  return (value < 0 && Number(text) !== 0 ? "−" : "") + text;
}

/** Mean difference of two pictures, 0 to 1, at a quarter of their size: fonts may be drawn a little otherwise. */
export async function difference(page, a, b) {
  return page.evaluate(
    async ([first, second]) => {
      const pixels = async (data) => {
        const image = new Image();
        image.src = `data:image/png;base64,${data}`;
        await image.decode();
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [image.width / 4, image.height / 4];
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0, canvas.width, canvas.height);
        return context.getImageData(0, 0, canvas.width, canvas.height).data;
      };
      const [p, q] = [await pixels(first), await pixels(second)];
      if (p.length !== q.length) return 1;
      return p.reduce((sum, v, i) => sum + Math.abs(v - q[i]), 0) / p.length / 255;
    },
    [a.toString("base64"), b.toString("base64")],
  );
}

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** What axe finds serious or critical in the page, or in this part of it. */
export async function serious(page, part = "body") {
  await page.evaluate(axe);
  return page.evaluate(async (part) => {
    const { violations } = await window.axe.run(part, { resultTypes: ["violations"] });
    return violations.filter(({ impact }) => ["serious", "critical"].includes(impact)).map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" | ")}`);
  }, part);
}

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".json": "application/json", ".css": "text/css", ".svg": "image/svg+xml", ".png": "image/png", ".gz": "application/gzip" };

/** Serves the page without a server, as any web server does: files alone. Env ARMILL_SITE: its folder; the documentation is in the
 * folder above. */
export async function site(headers = {}, part = ".") {
  if (!process.env.ARMILL_SITE) throw new Error("ARMILL_SITE names no page without a server: `cargo xtask site` makes it");
  const folder = join(process.env.ARMILL_SITE, part);
  const requested = [];
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, "http://site");
    requested.push(`${request.method} ${pathname}`);
    const file = join(folder, pathname.endsWith("/") ? `${pathname}index.html` : pathname);
    if (!existsSync(file)) return response.writeHead(404).end();
    return response.writeHead(200, { "Content-Type": TYPES[extname(file)] ?? "application/octet-stream", ...headers }).end(readFileSync(file));
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { url: `http://127.0.0.1:${server.address().port}/`, folder: resolve(folder), requested, stop: () => (server.closeAllConnections(), server.close()) };
}
