// For work on the page: `armill serve` with the page of this folder before it, so that armill need not be built anew.
// ARMILL_BIN=path/of/armill node dev/server.mjs [STUDY]; `npx vite build --watch` beside it rebuilds dist.

import { spawn } from "node:child_process";
import { readFile } from "node:fs/promises";
import { createServer, request } from "node:http";
import { extname, join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

const DIST = fileURLToPath(new URL("../dist/", import.meta.url));
const FILES = { "/": "index.html", "/index.html": "index.html", "/app.js": "app.js", "/app.css": "app.css", "/vendor.js": "vendor.js" };
const TYPES = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css" };

/** The page of `dist` before the server at `url`; the address to open instead, and how to end it. */
async function before(url) {
  const target = new URL(url);
  const server = createServer(async (asked, answer) => {
    const path = new URL(asked.url, target).pathname;
    if (!path.startsWith("/api/")) {
      const name = FILES[path];
      // The server's own answer for its first page has the headers that any page of it gets.
      const { headers } = await fetch(target.origin);
      answer.setHeader("Content-Security-Policy", headers.get("content-security-policy") ?? "");
      if (!name) return answer.writeHead(404).end();
      return answer.setHeader("Content-Type", TYPES[extname(name)]).end(await readFile(join(DIST, name)));
    }
    const headers = { ...asked.headers, host: target.host };
    if (headers.origin) headers.origin = target.origin;
    const passed = request({ host: target.hostname, port: target.port, method: asked.method, path: asked.url, headers }, (got) => {
      answer.writeHead(got.statusCode, got.headers);
      got.pipe(answer);
    });
    passed.on("error", () => answer.destroy());
    answer.on("close", () => passed.destroy());
    asked.pipe(passed);
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const here = new URL(url);
  here.port = String(server.address().port);
  return { url: here.href, stop: () => (server.closeAllConnections(), server.close()) };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const armill = spawn(process.env.ARMILL_BIN ?? "armill", ["serve", ...process.argv.slice(2), "--no-open"], { stdio: ["ignore", "pipe", "inherit"] });
  createInterface({ input: armill.stdout }).once("line", async (line) => console.log((await before(line)).url));
  for (const end of ["SIGINT", "SIGTERM"]) process.on(end, () => armill.kill("SIGTERM"));
  armill.on("exit", (code) => process.exit(code ?? 1));
}
