// The server under load: `npm run load [seconds]`. Env ARMILL_BIN: a release build of armill.
//
// 200 connections send 1000 requests a second in total: the study, the robot library, the page, a file that is not there,
// and one time in a hundred what is in a text. Meanwhile 20 clients send a byte a second, and 20 listen to a job and go away
// in the middle, again and again. The server's memory is read every second. Told are what came out, how long it took,
// and how the memory went; the exit code is 1 where an answer was wrong or late, the rate was not held, or memory grew.

import { readFileSync } from "node:fs";
import http from "node:http";
import net from "node:net";
import { client, serve } from "./e2e/setup.mjs";

const SECONDS = Number(process.argv[2] ?? 60);
const RATE = 1000;
const CONNECTIONS = 200;
const SLOW = 20;
const LISTENERS = 20;
/** Growth that is no growth, MiB: arenas of threads that were not there before. */
const GROWTH = 16;
/** An answer that takes longer was forgotten by the server: it waited for others to go away. */
const LATE_MS = 3000;

const server = await serve();
const at = new URL(server.url);
const token = at.searchParams.get("token");
const agent = new http.Agent({ keepAlive: true, maxSockets: CONNECTIONS });
const memory = () => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${server.pid}/status`, "utf8"))[1]) / 1024;
const threads = () => Number(/Threads:\s+(\d+)/.exec(readFileSync(`/proc/${server.pid}/status`, "utf8"))[1]);
const share = (list, part) => [...list].sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(part * list.length))];

function request(method, path, body, headers = {}) {
  return new Promise((done) => {
    const begun = performance.now();
    const text = body === undefined ? undefined : JSON.stringify(body);
    const all = { Authorization: `Bearer ${token}`, ...(text ? { "Content-Type": "application/json", "Content-Length": Buffer.byteLength(text) } : {}), ...headers };
    const requests = http.request({ host: at.hostname, port: at.port, method, path, headers: all, agent }, (answer) => {
      answer.resume();
      answer.on("end", () => done({ status: answer.statusCode, ms: performance.now() - begun }));
    });
    requests.on("error", (error) => done({ status: error.code ?? String(error), ms: performance.now() - begun }));
    requests.end(text);
  });
}

const study = await client(server.url)("GET", "/api/study");
const kinds = [
  ["GET", "/api/study", undefined, 200],
  ["GET", "/api/robots", undefined, 200],
  ["GET", `/?token=${token}`, undefined, 200],
  ["GET", "/api/files/nothing-of-this-name.csv", undefined, 404],
  ["GET", "/api/schema", undefined, 200],
];
// The request of the page at every keystroke.
const checked = ["POST", "/api/check", { text: study.text }, 200];

// Clients that never come to an end.
const slow = Array.from({ length: SLOW }, () => {
  let socket;
  const begin = () => {
    socket = net.connect(Number(at.port), at.hostname, () => socket.write("POST /api/check HTTP/1.1\r\n"));
    socket.on("error", () => {});
    socket.on("close", () => setTimeout(begin, 500).unref());
    socket.unref();
  };
  begin();
  const drip = setInterval(() => socket.writable && socket.write("x"), 1000);
  return () => {
    clearInterval(drip);
    socket.removeAllListeners("close");
    socket.destroy();
  };
});

// Clients that listen to a job and go away in the middle of an event.
const job = await client(server.url)("POST", "/api/jobs", { kind: "run", text: study.text });
let listening = true;
let broken = 0;
async function listen() {
  while (listening) {
    await new Promise((done) => {
      const socket = net.connect(Number(at.port), at.hostname, () =>
        socket.write(`GET /api/jobs/${job.id}/events HTTP/1.1\r\nHost: ${at.host}\r\nAuthorization: Bearer ${token}\r\n\r\n`),
      );
      socket.on("data", () => socket.destroy());
      socket.on("error", () => {});
      socket.on("close", done);
      setTimeout(() => socket.destroy(), 300);
    });
    broken++;
    await new Promise((done) => setTimeout(done, 50));
  }
}
const listeners = Array.from({ length: LISTENERS }, listen);

const times = [];
const wrong = new Map();
const resident = [];
let sent = 0;
let open = 0;
const begun = performance.now();
await new Promise((done) => {
  const tick = setInterval(() => {
    const due = Math.min(SECONDS, (performance.now() - begun) / 1000) * RATE;
    for (; sent < due; sent++) {
      const [method, path, body, expected] = sent % 100 === 99 ? checked : kinds[sent % kinds.length];
      open++;
      request(method, path, body).then(({ status, ms }) => {
        open--;
        times.push(ms);
        if (status !== expected) wrong.set(`${method} ${path.split("?")[0]}: ${status}`, (wrong.get(`${method} ${path.split("?")[0]}: ${status}`) ?? 0) + 1);
      });
    }
    if (resident.length < (performance.now() - begun) / 1000) resident.push(memory());
    if (performance.now() - begun > SECONDS * 1000 && open === 0) {
      clearInterval(tick);
      done();
    }
  }, 5);
});
const seconds = (performance.now() - begun) / 1000;
listening = false;
await Promise.all(listeners);
for (const stop of slow) stop();
const threadsThen = threads();
agent.destroy();
const code = await server.stop();

const quarter = Math.max(1, Math.floor(resident.length / 4));
const mean = (list) => list.reduce((sum, value) => sum + value, 0) / list.length;
const [early, late] = [mean(resident.slice(quarter, 2 * quarter)), mean(resident.slice(-quarter))];
console.log(`${times.length} answers in ${seconds.toFixed(1)} s: ${(times.length / seconds).toFixed(0)} a second over ${CONNECTIONS} connections`);
console.log(`median ${share(times, 0.5).toFixed(1)} ms, 99 % within ${share(times, 0.99).toFixed(1)} ms, longest ${share(times, 1).toFixed(1)} ms`);
console.log(`${broken} event streams broken off, ${SLOW} slow clients, ${threadsThen} threads`);
console.log(`memory ${resident[0].toFixed(1)} MiB at first, ${early.toFixed(1)} MiB in the second quarter, ${late.toFixed(1)} MiB in the last`);
for (const [what, count] of wrong) console.log(`wrong: ${count} x ${what}`);
const held = times.length / seconds > 0.95 * RATE;
if (!held) console.log("the rate was not held");
if (late - early > GROWTH) console.log("memory grew");
const forgotten = share(times, 1) > LATE_MS;
if (forgotten) console.log("an answer was late");
process.exitCode = wrong.size > 0 || forgotten || !held || late - early > GROWTH || code !== 0 ? 1 : 0;
