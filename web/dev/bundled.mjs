// The packages that go into the page, one a line, for the lists of licences of `cargo xtask dist`:
// name|version|licence|repository|folder. Those that only build or test the page are left out.
import { readFileSync } from "node:fs";

const read = (path) => JSON.parse(readFileSync(new URL(`../${path}`, import.meta.url), "utf8"));

for (const [folder, told] of Object.entries(read("package-lock.json").packages)) {
  if (folder === "" || told.dev) continue;
  const { name, version, license, repository } = read(`${folder}/package.json`);
  const from = (repository?.url ?? repository ?? "").replace(/^git\+/, "").replace(/\.git$/, "");
  console.log([name, version, license, from, folder].join("|"));
}
