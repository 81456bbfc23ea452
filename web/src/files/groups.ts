// Files in groups: those of the study, then a group for each folder.

import type { StoredFile } from "../types";

export interface Group {
  /** The folder, "" for that of the study itself. */
  folder: string;
  title: string;
  files: StoredFile[];
}

/** What the folders of armill contain. */
const TITLES: Record<string, string> = { "": "Study and inputs", out: "Results of the run", place: "Placement", posture: "Posture", identify: "Compliance identification" };

/** The files whose name has every word of the filter, by folder. */
export function groups(files: StoredFile[], filter: string): Group[] {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  const found = new Map<string, StoredFile[]>();
  for (const file of files) {
    if (!words.every((word) => file.name.toLowerCase().includes(word))) continue;
    const folder = file.name.split("/").slice(0, -1).join("/");
    found.set(folder, [...(found.get(folder) ?? []), file]);
  }
  const order = (folder: string) => [...Object.keys(TITLES), folder].indexOf(folder);
  return [...found].map(([folder, own]) => ({ folder, title: title(folder), files: own })).sort((a, b) => order(a.folder) - order(b.folder) || a.folder.localeCompare(b.folder));
}

function title(folder: string): string {
  const known = TITLES[folder];
  return folder === "" ? known! : known ? `${known}: ${folder}/` : `${folder}/`;
}

export type PreviewKind = "picture" | "report" | "text" | "none";

/** How the page can show a file before it is opened. */
export function previewKind(name: string): PreviewKind {
  const ending = /\.([^.]+)$/.exec(name.toLowerCase())?.[1] ?? "";
  if (["svg", "png"].includes(ending)) return "picture";
  if (ending === "html") return "report";
  // Binary formats that armill reads or writes.
  return ["stl", "vti", "vtu", "vts", "vtp", "parquet", "zip", "gz", "pdf", "jpg", "npy", "npz", "bin"].includes(ending) ? "none" : "text";
}
