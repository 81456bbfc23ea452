// Files dropped anywhere on the page: they go into the folder of the study; a robot becomes the robot of the study.

import type { Notices } from "../changes/notices";
import { api, Refused } from "../server";
import type { Live } from "../live";

interface Drop {
  live: Live;
  notices: Notices;
  /** Takes them where they are a study of their own; whether they were. */
  asStudy: (files: File[]) => Promise<boolean>;
}

export function takeDrops({ live, notices, asStudy }: Drop): void {
  const isOwn = (event: DragEvent) => (event.target as Element | null)?.closest?.(".drop") != null;
  const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
  addEventListener("dragover", (event) => {
    if (hasFiles(event) && !isOwn(event)) event.preventDefault();
  });
  addEventListener("drop", (event) => {
    if (!hasFiles(event) || isOwn(event)) return;
    event.preventDefault();
    const files = [...(event.dataTransfer?.files ?? [])];
    void take(files).catch((error: unknown) => say(error));
  });
  // A robot that cannot be evaluated does not become that of the study: the error says why.
  let robot: string | null = null;
  live.listen(["answer", "error"], () => {
    if (robot !== null && live.error === null && live.settled) notices.show("dropped", `${robot} is now the robot of the study.`, [{ text: "Undo", run: () => (live.undo(), notices.hide("dropped")) }], true);
    robot = null;
  });
  const say = (error: unknown) => notices.show("dropped", error instanceof Error ? error.message : String(error), [], true);

  async function take(files: File[]): Promise<void> {
    if (await asStudy(files)) return;
    if (live.study?.writable === false) return say(new Error("This study takes no files: `armill new DIR` makes one that does."));
    for (const file of files) await bring(file, false);
  }

  async function bring(file: File, replace: boolean): Promise<void> {
    try {
      const { name, kind, hint } = await api.put(file.name, file, replace);
      if (kind !== "robot") return notices.show("dropped", `${name} is in the folder of the study: ${kind === "unknown" ? hint : `${kind}. In the study: ${hint}`}`, [], true);
      notices.show("dropped", `${name} is in the folder of the study.`, [], true);
      robot = name;
      live.changeTogether({ robot: name }, true);
    } catch (error) {
      const exists = error instanceof Refused && error.kind === "conflict";
      notices.show("dropped", `${file.name}: ${error instanceof Error ? error.message : String(error)}`, exists ? [{ text: "Replace it", run: () => bring(file, true) }] : [], true);
    }
  }
}
