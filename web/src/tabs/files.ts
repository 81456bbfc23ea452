// The files of the study folder, in groups: filter, preview, download, and add robots, paths and measurements by dropping them.

import { api, Refused } from "../server";
import { fill, h, type Child } from "../dom";
import { groups, type Group } from "../files/groups";
import { downloadFile, openFile } from "../files/open-file";
import { Preview } from "../files/preview";
import { ago, bytes } from "../format";
import type { Live } from "../live";
import type { StoredFile } from "../types";
import type { Tab } from "./tab";

/** Files of a group that are listed unless the filter has found them; the others follow on request. */
const MOST_ROWS = 200;

export function filesTab(live: Live): Tab {
  let files: StoredFile[] = [];
  let chosen: string | null = null;
  const closed = new Set<string>();
  const whole = new Set<string>();
  const list = h("div", { class: "file-groups" });
  const count = h("span", { class: "note", role: "status" });
  const report = h("div", { class: "report-line" });
  const said = h("ul", { class: "said", role: "status" });
  const filter = h("input", { type: "search", id: "files-filter", class: "wide", placeholder: "Filter, such as: csv rim", "aria-label": "Filter files by name", autocomplete: "off", spellcheck: "false", "data-own-undo": "" });
  const pick = h("input", { type: "file", multiple: true, id: "pick", class: "visually-hidden" });
  const zone = h("div", { class: "drop" }, h("p", {}, h("b", {}, "Drop a file here"), " or ", h("label", { for: "pick", class: "link" }, "choose one"), ". It is saved in the folder of the study."), h("p", { class: "note" }, "Robots (.urdf, .toml), tool paths (G-code, APT, CSV, robot programs), force records, ball-bar runs, profiles."), pick);
  const say = (text: string, hint = "", act: Node | null = null) => said.prepend(h("li", {}, text, hint ? h("span", { class: "hint" }, hint) : null, act));
  const fail = (error: unknown) => say(error instanceof Error ? error.message : String(error));
  const preview = new Preview(fail);

  const refresh = async () => {
    try {
      files = (await api.files()).files;
      const found = files.find((f) => f.name === "out/report.html");
      fill(report, found ? [h("button", { type: "button", class: "primary", onclick: () => void openFile(found.name).catch(fail) }, "Open the report"), h("button", { type: "button", class: "quiet", onclick: () => void downloadFile(found.name).catch(fail) }, "Download it"), h("span", { class: "note" }, `made ${ago(found.modified_s_ago)}`)] : h("span", { class: "note" }, "No report yet: “Run the study” in Jobs writes one."));
      zone.hidden = live.study?.writable === false;
      if (chosen !== null && !files.some((f) => f.name === chosen)) {
        chosen = null;
        preview.clear();
      }
      draw();
    } catch (error) {
      fail(error);
    }
  };
  const draw = () => {
    const shown = groups(files, filter.value);
    const matches = shown.reduce((sum, group) => sum + group.files.length, 0);
    count.textContent = filter.value.trim() === "" ? `${files.length} files` : `${matches} of ${files.length} files`;
    fill(list, ...shown.map(group), matches === 0 ? h("p", { class: "empty" }, files.length === 0 ? "No files yet." : "No file matches the filter.") : null);
  };
  const group = ({ folder, title, files: own }: Group): Child => {
    // What a filter has found is shown.
    const open = filter.value.trim() !== "" || !closed.has(folder);
    const limited = own.length > MOST_ROWS && !whole.has(folder);
    const rest = () => {
      whole.add(folder);
      draw();
    };
    const root = h(
      "details",
      { class: "file-group", open, "data-folder": folder },
      h("summary", { "data-key": `group ${folder}` }, h("h2", {}, title), h("span", { class: "note" }, String(own.length))),
      h("table", { class: "files-table" }, h("thead", {}, h("tr", {}, ["Name", "Size", "Changed", ""].map((t) => h("th", { scope: "col" }, t)))), h("tbody", {}, own.slice(0, limited ? MOST_ROWS : own.length).map(row))),
      limited ? h("button", { type: "button", class: "link", onclick: rest }, `Show all ${own.length}`) : null,
    );
    root.addEventListener("toggle", () => {
      if (filter.value.trim() === "") root.open ? closed.delete(folder) : closed.add(folder);
    });
    return root;
  };
  const row = (file: StoredFile) =>
    h(
      "tr",
      { class: file.name === chosen ? "chosen" : null },
      h("td", {}, h("button", { type: "button", class: "link", "data-key": `file ${file.name}`, "data-file": file.name, "aria-pressed": String(file.name === chosen), title: file.name, onclick: () => choose(file) }, file.name.split("/").at(-1)!)),
      h("td", {}, bytes(file.bytes)),
      h("td", {}, ago(file.modified_s_ago)),
      h("td", {}, h("button", { type: "button", class: "link", "aria-label": `Download ${file.name}`, onclick: () => void downloadFile(file.name).catch(fail) }, "Download")),
    );
  const choose = (file: StoredFile) => {
    chosen = file.name;
    draw();
    void preview.show(file);
  };
  const bring = async (file: File, replace = false) => {
    try {
      const kept = await api.put(file.name, file, replace);
      say(`${kept.name}, ${bytes(kept.bytes)}: ${kept.kind === "unknown" ? "saved; its type is not known" : kept.kind}.`, kept.hint);
      await refresh();
    } catch (error) {
      const there = error instanceof Refused && error.kind === "conflict";
      say(`${file.name}: ${error instanceof Error ? error.message : String(error)}`, "", there ? h("button", { type: "button", class: "link", onclick: () => void bring(file, true) }, "Replace it") : null);
    }
  };
  filter.addEventListener("input", draw);
  pick.addEventListener("change", () => {
    for (const file of pick.files ?? []) void bring(file);
    pick.value = "";
  });
  zone.addEventListener("dragover", (e) => {
    e.preventDefault();
    zone.classList.add("over");
  });
  zone.addEventListener("dragleave", () => zone.classList.remove("over"));
  zone.addEventListener("drop", (e) => {
    e.preventDefault();
    zone.classList.remove("over");
    for (const file of e.dataTransfer?.files ?? []) void bring(file);
  });
  const root = h(
    "div",
    { class: "page" },
    h("header", { class: "page-head" }, h("h1", {}, "Files of the study"), report),
    zone,
    said,
    h("div", { class: "file-tools" }, filter, count),
    h("div", { class: "file-panes" }, list, preview.root),
  );
  return { id: "files", title: "Files", root, shown: () => void refresh() };
}
