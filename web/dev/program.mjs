// Puts the program of the browser next to the page without a server: compressed, and as a script for pages that are opened
// from a disk. node dev/program.mjs ARMILL_BROWSER.wasm FOLDER
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";

const [program, folder] = process.argv.slice(2);
const compressed = gzipSync(readFileSync(program), { level: 9 });
writeFileSync(join(folder, "armill.wasm.gz"), compressed);
writeFileSync(join(folder, "armill-program.js"), `armill_program = "${compressed.toString("base64")}";\n`);
