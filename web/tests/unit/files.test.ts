// Groups of files, and which can be previewed.

import { expect, test } from "vitest";
import { groups, previewKind } from "../../src/files/groups";

const file = (name: string) => ({ name, bytes: 1, modified_s_ago: 0 });

test("files are grouped by folder: the study first, then the results, then others", () => {
  const all = ["mine/a.csv", "out/report.html", "place/x.csv", "study.toml", "out/deep/b.csv", "path.apt"].map(file);
  expect(groups(all, "").map((g) => [g.folder, g.files.length])).toEqual([["", 2], ["out", 1], ["place", 1], ["mine", 1], ["out/deep", 1]]);
  expect(groups(all, "")[1]!.title).toBe("Results of the run: out/");
});

test("the filter has words, in any order and case", () => {
  const all = ["out/Rim.csv", "out/rim.svg", "out/plate.csv"].map(file);
  expect(groups(all, " CSV rim ").flatMap((g) => g.files.map((f) => f.name))).toEqual(["out/Rim.csv"]);
  expect(groups(all, "nothing")).toEqual([]);
});

test("what can be previewed", () => {
  expect(["a.svg", "b/report.html", "study.toml", "part.STL", "program", "map.vti"].map(previewKind)).toEqual(["picture", "report", "text", "none", "text", "none"]);
});
