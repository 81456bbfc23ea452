// A panel: a collapsible heading, and a body that is updated when its values change.

import { h, renew, type Child } from "../dom";

export interface Panel {
  root: HTMLElement;
  body: HTMLElement;
  show: (...children: Child[]) => void;
}

export function panel(id: string, title: string, open = true, note = ""): Panel {
  const body = h("div", { class: "panel-body" });
  const root = h(
    "details",
    { class: "panel", id: `panel-${id}`, open: remembered(id) ?? open },
    h("summary", {}, h("h2", {}, title), note ? h("span", { class: "panel-note" }, note) : null),
    body,
  );
  root.addEventListener("toggle", () => localStorage.setItem(`armill-panel-${id}`, String((root as HTMLDetailsElement).open)));
  return { root, body, show: (...children) => renew(body, ...children) };
}

function remembered(id: string): boolean | null {
  const stored = localStorage.getItem(`armill-panel-${id}`);
  return stored === null ? null : stored === "true";
}
