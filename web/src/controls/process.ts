// The cut or drill of a path or of holes: material, cutter, depths, feed and spindle speed. What the program or the stock
// gives in place of the study is named, and cannot be changed here.

import { h } from "../dom";
import type { Live } from "../live";
import { api } from "../server";
import type { MaterialRow, Process } from "../types";
import { Choice } from "./choice";
import { NumberField } from "./field";

const SIDES = [
  { value: "up", text: "Up-milling" },
  { value: "down", text: "Down-milling" },
  { value: "centred", text: "Centred" },
  { value: "slot", text: "Slot" },
];

export class ProcessControls {
  readonly root: HTMLElement;
  readonly all: (NumberField | Choice)[];
  private process: Process | null = null;
  private materials: MaterialRow[] = [];
  private readonly legend = h("legend", {}, "Cut");
  private readonly elsewhere = h("p", { class: "note" });
  private readonly material = new Choice("field-material", "Material", (name) => this.send(this.material, { material: name }));
  private readonly diameter = this.number("field-diameter", "Diameter", "mm", [1, 40], 0.5, "cutter diameter_mm");
  private readonly flutes = this.number("field-flutes", "Flutes", "", [1, 12], 1, "cutter flutes");
  private readonly corner = this.number("field-corner", "Corner radius", "mm", undefined, 0.5, "cutter corner_radius_mm");
  private readonly axial = this.number("field-axial", "Depth of cut", "mm", [0.1, 10], 0.1, "axial_depth_mm");
  private readonly radial = this.number("field-radial", "Width of cut", "mm", [0.1, 20], 0.1, "radial_depth_mm");
  private readonly side = new Choice("field-side", "Side", (side) => this.changeSide(side));
  private readonly feed = this.number("field-feed", "Feed", "mm/min", [50, 5000], 50, "feed_mm_per_min");
  private readonly spindle = this.number("field-spindle", "Spindle speed", "rpm", [500, 24000], 100, "spindle_rpm");

  /** `touched`: a control of these was changed. */
  constructor(private readonly live: Live, private readonly touched: (control: NumberField | Choice) => void) {
    this.all = [this.material, this.diameter, this.flutes, this.corner, this.axial, this.radial, this.side, this.feed, this.spindle];
    this.root = h("fieldset", { hidden: true }, this.legend, this.all.map((control) => control.root), this.elsewhere);
    void api.materials().then((rows) => {
      this.materials = rows;
      this.fill(this.process);
    }, () => undefined);
  }

  fill(process: Process | null): void {
    this.process = process;
    this.root.hidden = process === null;
    if (!process) return;
    const { given_elsewhere: given } = process;
    this.legend.textContent = process.key === "cut" ? "Cut" : "Drill";
    this.material.set(process.material, this.materials.map((row) => ({ value: row.name, text: row.title })));
    this.diameter.set(given.diameter === null ? process.diameter_mm : null);
    this.flutes.set(process.flutes);
    this.corner.set(given.diameter === null ? process.corner_radius_mm : null);
    this.axial.set(given.depths === null ? process.axial_depth_mm : null);
    this.radial.set(given.depths === null ? process.radial_depth_mm : null);
    this.side.set(process.side, SIDES);
    this.feed.set(given.feed === null ? process.feed_mm_per_min : null);
    this.spindle.set(given.spindle === null ? process.spindle_rpm : null);
    const named = [["Feed", given.feed], ["Spindle speed", given.spindle], [process.key === "cut" ? "Depths" : null, given.depths], ["Diameter", given.diameter]] as const;
    const words = named.filter(([what, by]) => what && by).map(([what, by]) => `${what}: given by ${by}.`);
    this.elsewhere.textContent = words.join(" ");
    this.elsewhere.hidden = words.length === 0;
  }

  private number(id: string, label: string, unit: string, range: [number, number] | undefined, step: number, key: string): NumberField {
    const of_cutter = key.startsWith("cutter ");
    const name = key.replace("cutter ", "");
    const field: NumberField = new NumberField({ id, label, unit, step, ...(range ? { range } : {}), input: (value) => this.send(field, { [of_cutter ? `${this.process!.cutter_key}${name}` : name]: value }) });
    return field;
  }

  /** A slot has the width of the cutter; every other cut needs one. */
  private changeSide(side: string): void {
    const { radial_depth_mm, diameter_mm } = this.process!;
    const width = side === "slot" ? null : (radial_depth_mm ?? diameter_mm / 2);
    this.send(this.side, width === radial_depth_mm ? { side } : { side, radial_depth_mm: width });
  }

  private send(control: NumberField | Choice, values: Record<string, unknown>): void {
    const { key, whole } = this.process!;
    this.touched(control);
    this.live.changeAll(Object.entries(values).map(([name, value]) => ({ key: `${key}.${name}`, value, whole })));
  }
}
