// The files of the study folder: view, download, and add robots, paths and measurements by dropping them.

import { api, fileAddress, Refused } from "../server";
import { fill, h } from "../dom";
import { ago, bytes } from "../format";
import type { Live } from "../live";
import type { StoredFile } from "../types";
import type { Tab } from "./tab";

export function filesTab(live: Live): Tab {
  const rows = h("tbody");
  const report = h("div", { class: "report-line" });
  const said = h("ul", { class: "said", role: "status" });
  const pick = h("input", { type: "file", multiple: true, id: "pick", class: "visually-hidden" });
  const zone = h("div", { class: "drop" }, h("p", {}, h("b", {}, "Drop a file here"), " or ", h("label", { for: "pick", class: "link" }, "choose one"), ". It is saved in the folder of the study."), h("p", { class: "note" }, "Robots (.urdf, .toml), tool paths (G-code, APT, CSV, robot programs), force records, ball-bar runs, profiles."), pick);
  const say = (text: string, hint = "", act: Node | null = null) => said.prepend(h("li", {}, text, hint ? h("span", { class: "hint" }, hint) : null, act));

  const refresh = async () => {
    try {
      const { files } = await api.files();
      const found = files.find((f) => f.name === "out/report.html");
      fill(report, found ? [h("a", { class: "primary button", href: fileAddress(found.name), target: "_blank", rel: "noopener" }, "Open the report"), h("a", { class: "quiet button", href: fileAddress(found.name), download: "report.html" }, "Download it"), h("span", { class: "note" }, `made ${ago(found.modified_s_ago)}`)] : h("span", { class: "note" }, "No report yet: “Run the study” in Jobs writes one."));
      fill(rows, ...files.map(row));
      zone.hidden = live.study?.writable === false;
    } catch (error) {
      say(error instanceof Error ? error.message : String(error));
    }
  };
  const row = (file: StoredFile) =>
    h("tr", {}, h("td", {}, h("a", { href: fileAddress(file.name), target: "_blank", rel: "noopener" }, file.name)), h("td", {}, bytes(file.bytes)), h("td", {}, ago(file.modified_s_ago)), h("td", {}, h("a", { href: fileAddress(file.name), download: file.name.split("/").at(-1)!, "aria-label": `Download ${file.name}` }, "Download")));
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
    h("table", { class: "files-table" }, h("thead", {}, h("tr", {}, ["Name", "Size", "Changed", ""].map((t) => h("th", { scope: "col" }, t)))), rows),
  );
  return { id: "files", title: "Files", root, shown: () => void refresh() };
}
