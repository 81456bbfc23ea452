// The live page of armill: opens the study of the server and lays out the tabs.

import "./style/base.css";
import "./style/live.css";
import "./style/panels.css";
import "./style/tabs.css";
import { api, Refused, takeToken } from "./server";
import { fill, h } from "./dom";
import { fixed } from "./format";
import { Live } from "./live";
import { filesTab } from "./tabs/files";
import { jobsTab } from "./tabs/jobs";
import { liveTab } from "./tabs/live";
import { picturesTab } from "./tabs/pictures";
import { studyTab } from "./tabs/study";
import type { Tab } from "./tabs/tab";
import { startTheme, switchTheme, theme } from "./theme";

/** Delay without changes before the computing time is shown. */
const PAUSE_MS = 150;

const app = document.getElementById("app")!;
takeToken();
startTheme(() => undefined);

async function start(): Promise<void> {
  const opening = api.study();
  // The first paint does not wait for WebGL to start.
  await painted();
  const live = new Live();
  const tabs: Tab[] = [];
  const go = (id: string) => show(tabs.find((t) => t.id === id) ?? tabs[0]!);
  const study_tab = studyTab(live);
  const table = (name: string) => {
    go("study");
    study_tab.reveal(name);
  };
  tabs.push(liveTab(live), picturesTab(live), jobsTab(live, { go, table }), study_tab, filesTab(live));
  let current: Tab | null = null;
  const buttons = tabs.map((tab) => h("button", { type: "button", role: "tab", id: `tab-${tab.id}`, "aria-controls": `view-${tab.id}`, onclick: () => show(tab) }, tab.title));
  const nav = h("nav", { role: "tablist", "aria-label": "Views" }, buttons);
  nav.addEventListener("keydown", (e) => {
    const step = e.key === "ArrowRight" ? 1 : e.key === "ArrowLeft" ? -1 : 0;
    if (step === 0) return;
    const next = (tabs.indexOf(current!) + step + tabs.length) % tabs.length;
    show(tabs[next]!);
    buttons[next]!.focus();
  });
  for (const tab of tabs) {
    tab.root.id = `view-${tab.id}`;
    tab.root.setAttribute("role", "tabpanel");
    tab.root.setAttribute("aria-labelledby", `tab-${tab.id}`);
    tab.root.hidden = true;
  }
  const show = (tab: Tab) => {
    if (current === tab) return;
    current?.left?.();
    current = tab;
    tabs.forEach((t, i) => {
      t.root.hidden = t !== tab;
      buttons[i]!.setAttribute("aria-selected", String(t === tab));
      buttons[i]!.tabIndex = t === tab ? 0 : -1;
    });
    history.replaceState(null, "", `#${tab.id}`);
    tab.shown?.();
  };

  const title = h("p", { class: "study-title" });
  const changed = h("button", { type: "button", class: "changed", hidden: true, title: "Discard all changes since the file", onclick: () => live.study && live.use(live.study.text, live.study.analyses) }, "Unsaved · discard");
  const keep = h("button", { type: "button", class: "keep", hidden: true, title: "Save the study; comments are kept", onclick: () => live.save().catch(() => go("study")) }, "save");
  const pace = h("span", { class: "pace", role: "status" });
  const sun = h("button", { type: "button", class: "icon theme", onclick: () => switchTheme(themed) });
  const themed = () => {
    sun.textContent = theme() === "dark" ? "☀" : "☾";
    sun.setAttribute("aria-label", theme() === "dark" ? "Light colours" : "Dark colours");
    sun.title = sun.getAttribute("aria-label")!;
    live.notify("view");
  };
  startTheme(themed);
  const banner = h("div", { class: "banner", role: "alert", hidden: true });
  live.listen(["study"], () => {
    title.textContent = live.study?.title ?? live.study?.file ?? "";
    document.title = `${live.study?.title ?? "study"} – armill`;
  });
  live.listen(["study", "answer"], () => {
    changed.hidden = !live.study || live.text === live.study.text;
    keep.hidden = changed.hidden || !live.study?.writable;
  });
  // Showing the computing time costs a frame: it waits until no control is dragged.
  let timer: ReturnType<typeof setTimeout> | undefined;
  live.listen(["busy"], () => {
    content.setAttribute("aria-busy", String(live.busy));
    clearTimeout(timer);
    timer = setTimeout(() => {
      pace.textContent = live.busy ? "computing …" : live.took_ms === null ? "" : `${fixed(live.took_ms, 0)} ms`;
      pace.classList.toggle("busy", live.busy);
    }, PAUSE_MS);
  });
  live.listen(["error"], () => {
    banner.hidden = live.error === null || (live.error_at_field && current?.id === "live");
    if (live.error) fill(banner, h("b", {}, live.error.status === 0 ? "No connection. " : "Error: "), live.error.message, h("span", {}, live.answer ? " The page shows the last valid answer." : ""));
  });
  const content = h("main", {}, tabs.map((t) => t.root));
  fill(
    app,
    h("header", { class: "top" }, h("a", { class: "brand", href: "#live", onclick: (e: Event) => (e.preventDefault(), go("live")) }, "armill"), title, changed, keep, nav, pace, sun),
    banner,
    content,
  );
  go(location.hash.slice(1) || "live");
  const study = await opening;
  live.open(study);
  if (study.problems.length > 0) go("study");
}

const painted = (): Promise<void> => new Promise((done) => {
    requestAnimationFrame(() => setTimeout(done));
    setTimeout(done, 200);
  });

start().catch((error: unknown) => {
  const lost = error instanceof Refused && error.status === 401;
  fill(app, h("div", { class: "page stop" }, h("h1", {}, lost ? "This address has no valid token" : "The page could not start"), h("p", {}, lost ? "Open the address that `armill serve` printed when it started; it changes with every start." : error instanceof Error ? error.message : String(error))));
});
