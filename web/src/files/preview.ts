// Preview of a file next to the list: a picture, the report, or the first lines of a text.

import { api } from "../server";
import { fill, h } from "../dom";
import { bytes } from "../format";
import type { StoredFile } from "../types";
import { previewKind } from "./groups";
import { downloadFile, openFile } from "./open-file";

/** Read of a text, and of a picture at most. */
const TEXT_BYTES = 64_000;
const PICTURE_BYTES = 20_000_000;

export class Preview {
  readonly root = h("section", { class: "preview", "aria-label": "Preview", tabindex: "-1" });
  private reading: AbortController | null = null;
  private url: string | null = null;

  constructor(private readonly fail: (error: unknown) => void) {
    this.clear();
  }

  clear(): void {
    this.stop();
    fill(this.root, h("p", { class: "note" }, "Choose a file to see it here."));
  }

  async show(file: StoredFile): Promise<void> {
    this.stop();
    const reading = (this.reading = new AbortController());
    const body = h("div", { class: "preview-body" }, h("p", { class: "note" }, "…"));
    fill(
      this.root,
      h("header", {}, h("h2", {}, file.name), h("button", { type: "button", class: "quiet small", onclick: () => void openFile(file.name).catch(this.fail) }, "Open"), h("button", { type: "button", class: "quiet small", onclick: () => void downloadFile(file.name).catch(this.fail) }, "Download")),
      body,
    );
    try {
      fill(body, await this.content(file, reading.signal));
    } catch (error) {
      if (!reading.signal.aborted) fill(body, h("p", { class: "note warn" }, error instanceof Error ? error.message : String(error)));
    }
  }

  private stop(): void {
    this.reading?.abort();
    if (this.url) URL.revokeObjectURL(this.url);
    this.url = null;
  }

  private async content(file: StoredFile, signal: AbortSignal): Promise<HTMLElement> {
    const kind = previewKind(file.name);
    if (kind === "picture" && file.bytes <= PICTURE_BYTES) {
      const blob = new Blob([await (await api.file(file.name, signal)).arrayBuffer()], { type: file.name.endsWith(".png") ? "image/png" : "image/svg+xml" });
      signal.throwIfAborted();
      this.url = URL.createObjectURL(blob);
      return h("img", { src: this.url, alt: file.name });
    }
    if (kind === "report") {
      const { address } = await api.ticket(file.name);
      // Its scripts do not run: the server sends it so, and the frame as well.
      return h("iframe", { src: address, title: file.name, sandbox: "" });
    }
    if (kind === "text") {
      const text = await begin(await api.file(file.name, signal));
      if (!text.includes("\0")) return h("div", {}, h("pre", { tabindex: "0", "aria-label": `Begin of ${file.name}` }, text), file.bytes > TEXT_BYTES ? h("p", { class: "note" }, `The first ${bytes(TEXT_BYTES)} of ${bytes(file.bytes)}.`) : null);
    }
    return h("p", { class: "note" }, `No preview of this type of file, ${bytes(file.bytes)}.`);
  }
}

/** The first part of a text; the rest is not requested. */
async function begin(response: Response): Promise<string> {
  const reader = response.body!.getReader();
  const decoder = new TextDecoder();
  let text = "";
  let read = 0;
  while (read < TEXT_BYTES) {
    const { done, value } = await reader.read();
    if (done) return text + decoder.decode();
    const piece = value.subarray(0, TEXT_BYTES - read);
    read += piece.length;
    text += decoder.decode(piece, { stream: true });
  }
  await reader.cancel();
  return text;
}
