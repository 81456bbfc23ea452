// The pictures of the analysis, for download as SVG and PNG, and their numbers as CSV.

import { api } from "../server";
import { fill, h } from "../dom";
import { download, plainName } from "../download";
import type { Live } from "../live";
import { Newest } from "../newest";
import type { Picture } from "../types";
import type { Tab } from "./tab";

export function picturesTab(live: Live): Tab {
  const list = h("div", { class: "gallery" });
  const status = h("p", { class: "note", role: "status" });
  const csv = h("button", { type: "button", class: "quiet", onclick: () => void saveTable(plainName(live.analysis ?? "study"), false) }, "Table as CSV");
  const title = h("h1", {});
  const large = h("dialog", { class: "large", onclick: () => large.close() });
  const root = h("div", { class: "page" }, h("header", { class: "page-head" }, title, csv), status, list, large);
  let urls: string[] = [];
  let drawn = "";
  let visible = false;

  const saveTable = async (name: string, measured: boolean) => {
    try {
      download(`${name}.csv`, await api.table(live.text, live.analysis, measured));
    } catch (error) {
      status.textContent = error instanceof Error ? error.message : String(error);
    }
  };
  const savePng = async (picture: Picture, image: HTMLImageElement) => {
    let blob: Blob;
    try {
      blob = await api.png(live.text, live.analysis, picture.name);
    } catch {
      blob = await rendered(image);
    }
    download(`${picture.name}.png`, blob);
  };
  const card = (picture: Picture) => {
    const url = URL.createObjectURL(new Blob([picture.svg], { type: "image/svg+xml" }));
    urls.push(url);
    const image = h("img", { src: url, alt: picture.title, ...sizeOf(picture.svg) });
    return h(
      "figure",
      { class: "picture" },
      h("button", { type: "button", class: "paper", title: "Larger", onclick: () => (fill(large, h("img", { src: url, alt: picture.title })), large.showModal()) }, image),
      h(
        "figcaption",
        {},
        h("span", {}, picture.title),
        h("button", { type: "button", class: "quiet small", onclick: () => download(`${picture.name}.svg`, new Blob([picture.svg], { type: "image/svg+xml" })) }, "SVG"),
        h("button", { type: "button", class: "quiet small", onclick: () => void savePng(picture, image) }, "PNG"),
        h("button", { type: "button", class: "quiet small", title: picture.measured ? "The curves of the budget, one row per angle" : "The points of the analysis in this picture", onclick: () => void saveTable(picture.name, picture.measured) }, "CSV"),
      ),
    );
  };
  const work = new Newest<{ text: string; analysis: string | null }, Picture[]>({
    work: async ({ text, analysis }, signal) => (await api.pictures(text, analysis, signal)).pictures,
    done: (pictures) => {
      urls.forEach((url) => URL.revokeObjectURL(url));
      urls = [];
      status.textContent = pictures.length === 0 ? "This analysis has no pictures." : "";
      fill(list, ...pictures.map(card));
    },
    failed: (error) => {
      drawn = "";
      status.textContent = error instanceof Error ? error.message : String(error);
    },
  });
  const refresh = () => {
    title.textContent = live.analysis ?? "Pictures";
    const key = `${live.analysis}\n${live.text}`;
    if (!visible || key === drawn || live.text === "") return;
    drawn = key;
    status.textContent = "Drawing …";
    work.submit({ text: live.text, analysis: live.analysis });
  };
  live.listen(["answer"], refresh);
  return { id: "pictures", title: "Pictures", root, shown: () => ((visible = true), refresh()), left: () => void (visible = false) };
}

/** Width and height of the picture, so that the layout does not change when it is loaded. */
function sizeOf(svg: string): { width?: number; height?: number } {
  const box = /viewBox="[\d.-]+ [\d.-]+ ([\d.]+) ([\d.]+)"/.exec(svg);
  return box ? { width: Math.round(Number(box[1])), height: Math.round(Number(box[2])) } : {};
}

async function rendered(image: HTMLImageElement): Promise<Blob> {
  const canvas = h("canvas", { width: image.naturalWidth * 2, height: image.naturalHeight * 2 });
  const context = canvas.getContext("2d")!;
  context.fillStyle = "#fff";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((done, fail) => canvas.toBlob((blob) => (blob ? done(blob) : fail(new Error("the picture could not be drawn")))));
}
