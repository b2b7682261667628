// Colour maps: an even one for sizes, a diverging one for values of both signs, and kinds.

export type MapName = "viridis" | "cool-warm";
export type Colour = [number, number, number];

/** Equal steps look equally large, also in grey and to most people who see colours otherwise. */
const VIRIDIS: Colour[] = [
  [68, 1, 84], [72, 24, 106], [71, 45, 123], [66, 64, 134], [59, 82, 139], [51, 99, 141], [44, 114, 142],
  [38, 130, 142], [33, 145, 140], [31, 160, 136], [40, 174, 128], [63, 188, 115], [94, 201, 98], [132, 212, 75],
  [173, 220, 48], [216, 226, 25], [253, 231, 37],
];

/** From blue over grey, which is zero, to red. */
const COOL_WARM: Colour[] = [
  [59, 76, 192], [98, 130, 234], [141, 176, 254], [184, 208, 249], [221, 221, 221], [245, 196, 173],
  [244, 154, 123], [222, 96, 77], [180, 4, 38],
];

export function colour(map: MapName, share: number): Colour {
  const stops = map === "viridis" ? VIRIDIS : COOL_WARM;
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const below = Math.min(Math.floor(at), stops.length - 2);
  const [a, b] = [stops[below]!, stops[below + 1]!];
  const between = (i: 0 | 1 | 2) => a[i] + (at - below) * (b[i] - a[i]);
  return [between(0), between(1), between(2)];
}

export function css([r, g, b]: Colour): string {
  return `rgb(${Math.round(r)} ${Math.round(g)} ${Math.round(b)})`;
}

/** States of a material, quiet for elastic. */
const STATES: Colour[] = [[150, 160, 172], [230, 159, 0], [213, 94, 0], [204, 121, 167], [86, 180, 233]];
/** Bodies; from the ninth on they come again. */
const BODIES: Colour[] = [
  [86, 150, 200], [214, 170, 100], [0, 158, 115], [204, 121, 167], [213, 94, 0], [240, 228, 66], [120, 120, 130],
  [0, 114, 178],
];

export function kind(field: string, number: number): Colour {
  const colours = field === "yielding" ? STATES : BODIES;
  return colours[number % colours.length]!;
}

/** 256 colours as a picture. */
export function palette(colourOf: (i: number) => Colour): Uint8Array<ArrayBuffer> {
  const pixels = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; i++) pixels.set([...colourOf(i).map(Math.round), 255], 4 * i);
  return pixels;
}
