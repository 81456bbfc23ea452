// The live page of armill: opens the study of the server and lays out the tabs.

import "./style/base.css";
import "./style/live.css";
import "./style/panels.css";
import "./style/timeline.css";
import "./style/spin-map.css";
import "./style/tabs.css";
import "./style/changes.css";
import { Local } from "./browser/local";
import { openingDialog, openStudy } from "./browser/opening";
import { Kept } from "./changes/kept";
import { undoKeys } from "./changes/keys";
import { linkOf, stateOf } from "./changes/link";
import { Notices } from "./changes/notices";
import { Pin } from "./changes/pin";
import { tokenOfOthers } from "./changes/tabs";
import { offerClass } from "./controls/assume";
import { answerLocally, api, Refused, robotRows, takeToken, takeTokenOf, tokenNow } from "./server";
import { fill, h, s } from "./dom";
import { fixed } from "./format";
import { download } from "./download";
import { takeDrops } from "./files/drop";
import { JobStore } from "./jobs/store";
import { Live } from "./live";
import { problemSentence } from "./problem-words";
import { filesTab } from "./tabs/files";
import { jobsTab } from "./tabs/jobs";
import { liveTab } from "./tabs/live";
import { picturesTab } from "./tabs/pictures";
import { studyTab } from "./tabs/study";
import type { Tab } from "./tabs/tab";
import type { RobotRow } from "./types";
import { startTheme, switchTheme, theme } from "./theme";

/** Delay without changes before the computing time is shown. */
const PAUSE_MS = 150;

const app = document.getElementById("app")!;
takeToken();
startTheme(() => undefined);

async function start(): Promise<void> {
  const local = document.querySelector("meta[name=armill-program]") ? await startLocally() : null;
  if (!local && tokenNow() === "") takeTokenOf(await tokenOfOthers(), true);
  const linked = stateOf(location.hash);
  const opening = api.study();
  // The first paint does not wait for WebGL to start.
  await painted();
  const live = new Live();
  const notices = new Notices();
  const pin = new Pin(live);
  const others = h("span", { class: "others", hidden: true, title: "Tabs of this browser that show this study" });
  const kept = new Kept(live, notices, (count) => {
    others.hidden = count === 0;
    others.textContent = `${count + 1} tabs`;
  });
  const tabs: Tab[] = [];
  const go = (id: string) => show(tabs.find((t) => t.id === id) ?? tabs[0]!);
  const study_tab = studyTab(live, () => kept.save());
  const table = (name: string) => {
    go("study");
    study_tab.reveal(name);
  };
  const jobs = new JobStore((error) => notices.show("jobs", error instanceof Error ? error.message : String(error), [], true));
  tabs.push(liveTab(live, jobs), picturesTab(live), jobsTab(live, jobs, { go, table }), study_tab, filesTab(live));
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
    showError();
  };

  const title = h("p", { class: "study-title" });
  const assumed = h("span", { class: "assumed", hidden: true }, "Compliances assumed");
  const changed = h("button", { type: "button", class: "changed", hidden: true, title: "Discard all changes since the file", onclick: () => live.discard() }, "Unsaved · discard");
  const keep = h("button", { type: "button", class: "keep", hidden: true, title: "Save the study; comments are kept", onclick: () => void kept.save() }, "save");
  const undo = h("button", { type: "button", class: "icon", "aria-label": "Undo", title: "Undo (Ctrl+Z)", disabled: true, onclick: () => live.undo() }, "↶");
  const redo = h("button", { type: "button", class: "icon", "aria-label": "Redo", title: "Redo (Ctrl+Y)", disabled: true, onclick: () => live.redo() }, "↷");
  const link = async () => {
    const state = await linkOf({ text: live.text, analysis: live.analysis, tab: current?.id ?? "live" });
    if (state === null) return notices.show("link", "This study is too long for a link.", [], true);
    const address = new URL(state, location.href).href;
    await navigator.clipboard.writeText(address).then(
      () => notices.show("link", "The link to this state is copied. It opens in this browser while a tab with this study is open; it contains the text of the study, and no token.", [], true),
      () => notices.show("link", `Copy this link: ${address}`, [], true),
    );
  };
  const share = h("button", { type: "button", class: "icon share", "aria-label": "Copy a link to this state", title: "Copy a link to this state: text and analysis, without the token", onclick: () => void link() }, s("svg", { viewBox: "0 0 16 16", width: 16, height: 16, "aria-hidden": "true" }, s("path", { d: "M6.5 9.5 9.5 6.5M7 5l1.6-1.6a2.8 2.8 0 0 1 4 4L11 9M9 11l-1.6 1.6a2.8 2.8 0 0 1-4-4L5 7", fill: "none", stroke: "currentColor", "stroke-width": 1.5, "stroke-linecap": "round" })));
  undoKeys(live, () => kept.save());
  const opening_dialog = local && openingDialog(local);
  // What is saved on this page is kept by the browser alone: a file is for the user to keep.
  const to_disk = local && h("button", { type: "button", class: "quiet small", title: "Download the study as it is shown", onclick: () => download("study.toml", new Blob([live.text], { type: "application/toml" })) }, "Download");
  takeDrops({ live, notices, asStudy: async (files) => local !== null && openStudy(local, files) });
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
  live.listen(["answer"], () => {
    assumed.hidden = !live.answer?.robot.compliance_assumed;
    assumed.title = live.answer?.warnings.find((warning) => warning.includes("assumed")) ?? "Assumed by the study, not measured";
  });
  live.listen(["study", "answer", "text"], () => {
    changed.hidden = !live.unsaved;
    keep.hidden = changed.hidden || !live.study?.writable;
    undo.disabled = !live.history.canUndo && live.settled;
    redo.disabled = !live.history.canRedo;
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
  let robots: RobotRow[] = [];
  void robotRows().then((rows) => (robots = rows), () => undefined);
  const showError = () => {
    const { error } = live;
    // Study shows the problems of its text itself.
    banner.hidden = error === null || error.status === 0 || error.status === 401 || (current?.id === "study" && error.problems.length > 0);
    if (!error || banner.hidden) return;
    const { problems } = error;
    // A problem in another file than the study is named with its place.
    const place = (file = "", at = 0) => (file === "" || file === live.study?.file ? "" : `${file.split("/").at(-1)}, line ${at}: `);
    const line = ({ message, hint, file, line: at }: { message: string; hint: string | null; file?: string; line?: number }) => [place(file, at) + problemSentence(message), offerClass(message, live, robots) ?? (hint ? h("span", { class: "hint" }, hint) : null)];
    const more = problems.length > 3 ? [h("li", {}, `and ${problems.length - 3} more`)] : [];
    fill(
      banner,
      problems.length > 1 ? [h("b", {}, `${problems.length} problems`), h("ul", {}, problems.slice(0, 3).map((p) => h("li", {}, line(p))), more)] : h("p", {}, h("b", {}, "Error: "), line(problems[0] ?? error)),
      h("p", { class: "note" }, live.answer ? "The page shows the last valid answer. " : "", problems.length > 0 ? h("button", { type: "button", class: "link", "data-key": "study", onclick: () => go("study") }, "Open in Study") : null),
    );
  };
  live.listen(["error"], showError);
  const content = h("main", {}, tabs.map((t) => t.root));
  fill(
    app,
    h("header", { class: "top" }, h("a", { class: "brand", href: "#live", onclick: (e: Event) => (e.preventDefault(), go("live")) }, "armill"), title, assumed, changed, keep, opening_dialog?.button, to_disk, h("span", { class: "steps" }, undo, redo, share, pin.button), others, nav, pace, sun),
    notices.root,
    pin.root,
    h("div", { class: "banner-place" }, banner),
    content,
    opening_dialog?.root,
  );
  go(location.hash.slice(1).split("&")[0] || "live");
  const study = await opening;
  jobs.rememberOf(study.identity);
  await kept.open(study);
  const state = await linked;
  if (state && (state.text !== live.text || state.analysis !== live.analysis)) {
    const use = () => {
      live.use(state.text, live.analyses);
      if (state.analysis !== null) live.choose(state.analysis);
      notices.hide("linked");
    };
    notices.show("linked", "The address contains another state of the study.", [{ text: "Show it", run: use }], true);
  }
  if (study.is_fallback) notices.show("example", `This folder has no study: the page shows the example “${study.title ?? study.file}”. It can be changed, but not saved; \`armill new DIR\` makes a study of your own.`, [], true);
  if (study.problems.length > 0) go("study");
}

/** Answers requests in the page itself: the page has no server. */
async function startLocally(): Promise<Local> {
  const local = await Local.start();
  answerLocally((method, path, body, signal) => local.answer(method, path, body, signal));
  Object.assign(globalThis, { armill: { request: local.request.bind(local) } });
  return local;
}

const painted = (): Promise<void> => new Promise((done) => {
    requestAnimationFrame(() => setTimeout(done));
    setTimeout(done, 200);
  });

start().catch((error: unknown) => {
  const lost = error instanceof Refused && error.status === 401;
  fill(app, h("div", { class: "page stop" }, h("h1", {}, lost ? "This address has no valid token" : "The page could not start"), h("p", {}, lost ? "Open the address that `armill serve` printed when it started; it changes with every start." : error instanceof Error ? error.message : String(error))));
});
