// Ctrl+Z, Ctrl+Y or Ctrl+Shift+Z, and Ctrl+S (on a Mac with Cmd) everywhere on the page.

import type { Live } from "../live";

export function undoKeys(live: Live, save: () => Promise<void>): void {
  document.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || event.isComposing) return;
    const key = event.key.toLowerCase();
    const act = key === "z" ? (event.shiftKey ? () => live.redo() : () => live.undo()) : key === "y" && !event.shiftKey ? () => live.redo() : key === "s" && !event.shiftKey ? save : null;
    if (!act || ((key === "z" || key === "y") && undoesItself(event.target))) return;
    event.preventDefault();
    if (key !== "s" || (live.unsaved && live.study?.writable)) void act();
  });
}

/** An input whose text is not a change of the study (yet): its own undo applies. */
function undoesItself(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLInputElement || target instanceof HTMLTextAreaElement)) return false;
  if (target.closest("dialog, [data-own-undo]")) return true;
  return target.closest(".fields") !== null && target.value !== target.defaultValue;
}
