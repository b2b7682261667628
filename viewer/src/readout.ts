// The values of a particle.

import { half, type Pictures } from "./data";
import { make } from "./dom";
import { number, scale } from "./format";
import type { V3 } from "./space";

export interface Picked {
  slot: number;
  id: number;
  /** m, in the computed part. */
  at: V3;
  /** Whether it is there in this frame. */
  there: boolean;
}

const NAMES = { 1: [""], 3: ["x", "y", "z"], 6: ["xx", "yy", "zz", "xy", "yz", "zx"] } as const;

export function readout(picked: Picked, pictures: Pictures, arrays: Uint16Array[]): Node[] {
  const title = make("div", { class: "title" }, make("b", {}, `Particle ${picked.id}`));
  if (!picked.there) return [title, make("p", {}, "It is not there at this time.")];
  const rows = [row("Position", "m", picked.at.map(three), ["x", "y", "z"])];
  pictures.fields.forEach((field, f) => {
    const codes = [...arrays[f]!.subarray(field.components * picked.slot, field.components * (picked.slot + 1))];
    if (field.one === null) {
      const names = field.name === "body" ? pictures.bodies : pictures.states;
      rows.push(row(field.title, "", codes.map((c) => names[c] ?? String(c)), NAMES[1]));
      return;
    }
    const values = codes.map((code) => half(code) * field.one!);
    const s = scale(Math.max(...values.map(Math.abs)), field.unit);
    rows.push(row(field.title, s.unit, values.map((v) => three(v / s.factor)), NAMES[field.components]));
  });
  const bits = Math.min(...pictures.fields.map((f) => f.bits ?? 10));
  const error = number(100 * 2 ** (-bits - 1));
  return [
    title,
    make("table", {}, make("tbody", {}, ...rows)),
    make("p", { class: "hint" }, `Values to ${error} %; of a part of a body those of the computed part.`),
  ];
}

/** As many digits as the page keeps. */
function three(x: number): string {
  return number(Number(x.toPrecision(3)));
}

function row(title: string, unit: string, values: string[], names: readonly string[]): HTMLElement {
  const text = values.map((v, i) => (names[i] ? `${names[i]} ${v}` : v)).join(", ");
  return make("tr", {}, make("th", { scope: "row" }, title), make("td", {}, unit ? `${text} ${unit}` : text));
}
