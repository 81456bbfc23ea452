// One field of a table: what is typed becomes a value of the file, nothing typed takes it out of the file.

import { h } from "../dom";
import { parseNumber } from "../format";
import { named, type Field, type Kind } from "./schema";

export interface Input {
  root: HTMLElement;
  refuse: (message: string, hint: string | null) => void;
}

/** The value of an input, or its error. */
type Typed = { value: unknown } | { wrong: string };

/** `taken`: the value as JSON, null where the field is empty. */
export function input(path: string, field: Field, value: unknown, taken: (value: unknown) => void): Input {
  const { name, unit } = named(field.key);
  const error = h("p", { class: "field-error", role: "alert" });
  const clear = () => {
    error.replaceChildren();
    boxes.forEach((box) => box.removeAttribute("aria-invalid"));
  };
  const refuse = (message: string, hint: string | null) => {
    boxes.forEach((box) => box.setAttribute("aria-invalid", "true"));
    error.replaceChildren(message, ...(hint ? [h("span", { class: "hint" }, hint)] : []));
  };
  const report = () => {
    const typed = read(field.kind, boxes);
    if ("wrong" in typed) return refuse(typed.wrong, null);
    clear();
    if (JSON.stringify(typed.value) !== JSON.stringify(value ?? null)) taken(typed.value);
  };
  const boxes = make(field.kind, value, `${field.key}${unit ? `, ${unit}` : ""}`);
  boxes.forEach((box, i) => {
    if (i === 0) box.id = `table-${path}`;
    box.dataset.key = `${path} ${i}`;
    // A list of several is complete when the last is left, or any of them is typed over.
    box.addEventListener("change", () => {
      if (boxes.length > 1 && boxes.some((b) => b.value.trim() === "") && boxes.some((b) => b.value.trim() !== "") && i + 1 < boxes.length) return;
      report();
    });
  });
  const root = h(
    "div",
    { class: "row", "data-path": path },
    h("label", { for: `table-${path}`, title: field.about }, name, field.needed ? h("small", {}, " needed") : null),
    h("span", { class: "entry" }, boxes, unit ? h("span", { class: "unit" }, unit) : null),
    error,
  );
  return { root, refuse };
}

type Box = HTMLInputElement | HTMLSelectElement;

function make(kind: Kind, value: unknown, label: string): Box[] {
  const plain = (text: unknown, wide: boolean, aria: string) => h("input", { type: "text", class: wide ? "wide" : "number", autocomplete: "off", spellcheck: "false", value: text === undefined || text === null ? "" : String(text), "aria-label": aria });
  switch (kind.of) {
    case "number":
      return [plain(value, false, label)];
    case "numbers": {
      if (kind.count === null || kind.count > 6) return [plain(Array.isArray(value) ? value.join(", ") : value, true, `${label}, commas between`)];
      // One number may be used for all of them.
      const values = Array.isArray(value) ? value : value === undefined || value === null ? [] : Array<unknown>(kind.count).fill(value);
      return Array.from({ length: kind.count }, (_, i) => plain(values[i], false, `${label}, ${i + 1} of ${kind.count}`));
    }
    case "flag":
    case "choice": {
      const options = kind.of === "flag" ? [{ value: "true", about: "" }, { value: "false", about: "" }] : kind.options;
      const select = h("select", { "aria-label": label }, h("option", { value: "" }, "–"), options.map((o) => h("option", { value: o.value, title: o.about }, o.value)));
      select.value = value === undefined || value === null ? "" : String(value);
      return [select];
    }
    case "text":
      return [plain(value, true, label)];
    default:
      return [plain(value === undefined || value === null ? "" : JSON.stringify(value), true, `${label}, as a list`)];
  }
}

function read(kind: Kind, boxes: Box[]): Typed {
  const texts = boxes.map((box) => box.value.trim());
  if (texts.every((text) => text === "")) return { value: null };
  const numbers = (parts: string[]): Typed => {
    const values = parts.map(parseNumber);
    const bad = values.indexOf(null);
    return bad < 0 ? { value: values } : { wrong: parts[bad] === "" ? `${parts.length} numbers belong here.` : `"${parts[bad]}" is not a number.` };
  };
  const text = texts[0]!;
  switch (kind.of) {
    case "number": {
      const value = parseNumber(text);
      return value === null ? { wrong: `"${text}" is not a number.` } : { value };
    }
    case "numbers":
      return numbers(boxes.length > 1 ? texts : text.split(/[,;]\s*|\s+/).filter(Boolean));
    case "flag":
      return { value: text === "true" };
    case "choice":
    case "text":
      return { value: text };
    default:
      try {
        const value: unknown = JSON.parse(text);
        return Array.isArray(value) ? { value } : { wrong: "A list belongs here, such as [[3, 5, 5], [0, 0, -20]]." };
      } catch {
        return { wrong: "A list belongs here, such as [[3, 5, 5], [0, 0, -20]]." };
      }
  }
}
