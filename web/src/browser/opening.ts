// Opens another study on the page without a server: an example, or files of the user's disk. They stay on this machine.

import { h } from "../dom";
import type { Local } from "./local";

/** Whether a file is a study: TOML that names a robot. */
export const isStudy = (name: string, text: string): boolean => name.toLowerCase().endsWith(".toml") && /^\s*robot\s*=/m.test(text);

/** The study among these files, and the others; null if none is one. */
export async function studyAmong(files: Iterable<File>): Promise<{ study: File; others: File[] } | null> {
  const all = [...files];
  const named = all.filter(({ name }) => name.toLowerCase().endsWith(".toml")).sort((a, b) => Number(b.name === "study.toml") - Number(a.name === "study.toml"));
  for (const study of named) if (isStudy(study.name, await study.text())) return { study, others: all.filter((file) => file !== study) };
  return null;
}

/** Shows the folder of this browser from the begin. */
function reload(): void {
  location.replace(`${location.pathname}#live`);
  location.reload();
}

/** Opens the study among these files; whether there is one. */
export async function openStudy(local: Local, files: Iterable<File>): Promise<boolean> {
  const found = await studyAmong(files);
  if (found) {
    await local.takeStudy(found.study, found.others);
    reload();
  }
  return found !== null;
}

/** The button in the header, and its dialog. */
export function openingDialog(local: Local): { button: HTMLButtonElement; root: HTMLDialogElement } {
  const list = h("ul", { class: "examples" });
  const problem = h("p", { class: "note warn", role: "alert", hidden: true });
  const fail = (error: unknown) => {
    problem.hidden = false;
    problem.textContent = error instanceof Error ? error.message : String(error);
  };
  const pick = h("input", { type: "file", multiple: true, id: "open-files", class: "visually-hidden" });
  pick.addEventListener("change", () => {
    const files = [...(pick.files ?? [])];
    pick.value = "";
    void openStudy(local, files).then((opened) => opened || fail(new Error("None of these files is a study: a .toml file that names a robot. Robots and paths are added in Files, or dropped on the page.")), fail);
  });
  const root: HTMLDialogElement = h(
    "dialog",
    { class: "file-dialog", "aria-labelledby": "open-name" },
    h("h2", { id: "open-name" }, "Open a study"),
    h("p", {}, h("label", { for: "open-files", class: "link" }, "Choose study.toml"), " and the files that it names, or drop them on the page. They are read on this machine and sent nowhere."),
    pick,
    h("h3", {}, "Examples"),
    list,
    problem,
    h("p", { class: "note" }, "What this page has now is replaced: download it first if it is not saved elsewhere."),
    h("div", { class: "dialog-buttons" }, h("button", { type: "button", class: "quiet", onclick: () => root.close() }, "Cancel")),
  );
  const open = async () => {
    problem.hidden = true;
    root.showModal();
    const examples = await local.examples();
    const take = (name: string) => void local.takeExample(name).then(reload, fail);
    list.replaceChildren(...examples.map(({ name, title }) => h("li", {}, h("button", { type: "button", class: "link", "data-example": name, onclick: () => take(name) }, title), h("span", { class: "note" }, name))));
  };
  const button = h("button", { type: "button", class: "quiet small open-study", onclick: () => void open().catch(fail) }, "Open …");
  return { button, root };
}
