// What particles can be coloured by.

import type { Bounds, Field, Pictures } from "./data";
import { scale, type Scale } from "./format";

export interface Choice {
  /** In the menu, such as `stress/2`. */
  key: string;
  caption: string;
  field: Field;
  /** The field's place in the frames' lists. */
  index: number;
  /** The place among the field's ranges. */
  part: number;
  whole: boolean;
  component: number;
  kinds: boolean;
  /** Over all frames and particles, in SI units. */
  overall: Bounds;
  scale: Scale;
  /** Whether values of both signs are common, so that zero is what they are measured from. */
  signed: boolean;
}

const AXES = ["x", "y", "z"];
const TENSOR = ["xx", "yy", "zz", "xy", "yz", "zx"];

export function choices(pictures: Pictures): Choice[] {
  return pictures.fields.flatMap((field, index) => {
    const kinds = field.one === null;
    const names = field.components === 3 ? ["", ...AXES] : field.components === 6 ? TENSOR : [""];
    return names.flatMap((name, part) => {
      const overall = pictures.overall[field.name]?.[part];
      if (!overall) return [];
      const whole = field.components === 3 && part === 0;
      const size = Math.max(Math.abs(overall[0]), Math.abs(overall[1]));
      return {
        key: `${field.name}/${part}`,
        caption: name ? `${field.title} ${name}` : field.title,
        field,
        index,
        part,
        whole,
        component: field.components === 3 ? Math.max(0, part - 1) : part,
        kinds,
        overall,
        scale: scale(size, field.unit),
        signed: Math.min(-overall[2], overall[3]) > 0.1 * Math.max(-overall[2], overall[3]) && !whole && !kinds,
      };
    });
  });
}
