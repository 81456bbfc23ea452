// Choice of the table of load tests for the identification, among the files of the folder.

import { api } from "../server";
import { fill, h } from "../dom";

export function testsDialog(chosen: (name: string) => void): { root: HTMLDialogElement; open: () => Promise<void> } {
  const select = h("select", { id: "tests-file" });
  const go = h("button", { type: "submit", class: "primary" }, "Start");
  const none = h("p", { class: "note" }, "The folder of the study has no .csv file yet: drop the table of tests in Files first.");
  const root: HTMLDialogElement = h(
    "dialog",
    { class: "file-dialog", "aria-labelledby": "tests-name" },
    h(
      "form",
      { method: "dialog", onsubmit: () => chosen(select.value) },
      h("h2", { id: "tests-name" }, "Table of load tests"),
      h("label", { for: "tests-file", class: "visually-hidden" }, "File"),
      select,
      none,
      h("div", { class: "dialog-buttons" }, h("button", { type: "button", class: "quiet", onclick: () => root.close() }, "Cancel"), go),
    ),
  );
  const open = async () => {
    const { files } = await api.files();
    const tables = files.filter((f) => f.name.endsWith(".csv") && !f.name.includes("/"));
    fill(select, ...tables.map((f) => h("option", { value: f.name }, f.name)));
    select.hidden = go.disabled = tables.length === 0;
    none.hidden = tables.length > 0;
    root.showModal();
  };
  return { root, open };
}
