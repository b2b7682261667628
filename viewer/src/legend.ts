// What the colours mean.

import { colour, css, kind, type MapName } from "./colours";
import type { Choice } from "./choices";
import type { Pictures } from "./data";
import { make } from "./dom";
import { number, ticks } from "./format";

/** Of a range in SI units. */
export function ofRange(choice: Choice, map: MapName, low: number, high: number): Node[] {
  const { factor, unit } = choice.scale;
  const stops = Array.from({ length: 33 }, (_, i) => css(colour(map, i / 32)));
  const bar = make("div", { class: "bar" });
  bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  const marks = make("div", { class: "ticks" });
  const [a, b] = [low / factor, high / factor];
  for (const tick of ticks(a, b, 4)) {
    const mark = make("span", {}, number(Math.abs(tick) < 1e-9 * (b - a) ? 0 : tick));
    mark.style.left = `${b > a ? (100 * (tick - a)) / (b - a) : 50}%`;
    marks.append(mark);
  }
  const note = choice.field.note ? `, ${choice.field.note}` : "";
  const title = make("div", { class: "title" }, make("b", {}, choice.caption), unit ? ` in ${unit}` : "", note);
  const nodes: Node[] = [title, bar, marks];
  const [least, greatest] = choice.overall;
  const slack = 1e-3 * (greatest - least);
  if (least < low - slack || greatest > high + slack) {
    const ends = `${number(least / factor)} … ${number(greatest / factor)}${unit ? ` ${unit}` : ""}`;
    nodes.push(make("div", { class: "beyond" }, `values beyond it have the colours of its ends; all: ${ends}`));
  }
  return nodes;
}

/** Of numbers of things. */
export function ofKinds(choice: Choice, pictures: Pictures): Node[] {
  const names = choice.field.name === "body" ? pictures.bodies : pictures.states;
  const items = names.map((name, i) => {
    const swatch = make("span", { class: "swatch" });
    swatch.style.background = css(kind(choice.field.name, i));
    return make("li", {}, swatch, name);
  });
  const note = choice.field.note ? ` ${choice.field.note}` : "";
  return [make("div", { class: "title" }, make("b", {}, choice.caption), note), make("ul", { class: "kinds" }, ...items)];
}
