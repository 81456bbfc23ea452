// Opens or downloads a file of the folder by an address that is valid once: the token is in no address.

import { h } from "../dom";
import { api } from "../server";

/** Endings of files that a browser shows; others are downloaded. */
const SHOWN = ["html", "svg", "png", "json"];

const ending = (name: string): string => name.split(".").at(-1)!.toLowerCase();

export async function openFile(name: string): Promise<void> {
  if (!SHOWN.includes(ending(name))) return downloadFile(name);
  // Opened while the click is handled: later it would be blocked.
  const tab = window.open("", "_blank");
  try {
    const { address } = await api.ticket(name);
    if (!tab) return void window.open(address, "_blank", "noopener");
    tab.opener = null;
    tab.location.replace(address);
  } catch (error) {
    tab?.close();
    throw error;
  }
}

export async function downloadFile(name: string): Promise<void> {
  const { address } = await api.ticket(name);
  const link = h("a", { href: address, download: name.split("/").at(-1)! });
  document.body.append(link);
  link.click();
  link.remove();
}

/** A button that looks like a link and opens a file. */
export function fileLink(name: string, fail: (error: unknown) => void, text = name): HTMLElement {
  return h("button", { type: "button", class: "link", "data-file": name, onclick: () => void openFile(name).catch(fail) }, text);
}
