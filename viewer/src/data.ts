// What the page holds: the run in words and packed arrays.

/** [least, greatest, and the same without the outermost hundredth on each side]. */
export type Bounds = [number, number, number, number];

export interface Range {
  least: number;
  greatest: number;
  inner: [number, number];
}

export interface Field {
  name: string;
  title: string;
  unit: string;
  note: string;
  components: 1 | 3 | 6;
  /** What 1 stands for; null for numbers of things, which are kept as they are. */
  one: number | null;
  /** Bits after the leading one. */
  bits: number | null;
}

export interface Frame {
  number: number;
  time: number;
  particles: number;
  /** Which origins displacements count from. */
  origin: number;
  /** A byte for each particle that is drawn; null if all are there. */
  present: number | null;
  fields: number[];
  ranges: Record<string, Range[]>;
  /** How far the mesh's surface has moved; null if it has not. */
  mesh: number | null;
}

export interface Mesh {
  low: number[];
  size: number[];
  count: number;
  nodes: number;
  triangles: number;
  one: number;
  left_out?: number;
}

export interface Pictures {
  frames: Frame[];
  fields: Field[];
  count: number;
  ids: number;
  origins: { low: number[]; size: number[]; sets: number[] };
  sizes: { one: number; blob: number };
  low: number[];
  high: number[];
  overall: Record<string, Bounds[]>;
  bodies: string[];
  states: string[];
  mesh: Mesh | null;
}

export type Part = { kind: "half"; axis: number } | { kind: "sector"; axis: number; angle: number };

export interface About {
  case: string | null;
  up: number[];
  part: Part | null;
  stages: string[];
  units: Record<string, string>;
  pictures?: Pictures;
}

function content(id: string): string {
  return document.getElementById(id)?.textContent ?? "";
}

export function about(): About {
  return JSON.parse(content("about")) as About;
}

function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(text: string): Promise<Uint8Array<ArrayBuffer>> {
  const stream = new Blob([fromBase64(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The bytes of a blob. */
export function bytes(blob: number): Promise<Uint8Array<ArrayBuffer>> {
  return inflate(content(`blob-${blob}`));
}

/** `history.csv`. */
export async function history(): Promise<string> {
  const text = content("history");
  return text ? new TextDecoder().decode(await inflate(text)) : "";
}

/** Numbers whose first bytes stand before all second ones, component by component, put together by
 * particle. */
function joined(planes: Uint8Array, components: number): Uint16Array<ArrayBuffer> {
  const total = planes.length / 2;
  const count = total / components;
  const codes = new Uint16Array(total);
  for (let c = 0; c < components; c++) {
    let from = c * count;
    for (let i = c; i < total; i += components, from++) {
      codes[i] = (planes[from]! << 8) | planes[total + from]!;
    }
  }
  return codes;
}

/** Unpacked arrays, the last used ones kept. */
export class Store {
  private readonly kept = new Map<string, Promise<Uint16Array<ArrayBuffer>>>();
  constructor(private readonly most: number) {}

  /** The codes of a blob, `components` beside each other for each particle or node. */
  codes(blob: number, components: number): Promise<Uint16Array<ArrayBuffer>> {
    const key = `${blob}/${components}`;
    const known = this.kept.get(key);
    const codes = known ?? bytes(blob).then((b) => joined(b, components));
    this.kept.delete(key);
    this.kept.set(key, codes);
    for (const oldest of this.kept.keys()) {
      if (this.kept.size <= this.most) break;
      this.kept.delete(oldest);
    }
    return codes;
  }
}

let table: Float32Array | undefined;

/** The value of a half float. */
export function half(code: number): number {
  if (!table) {
    table = new Float32Array(65536);
    for (let i = 0; i < 65536; i++) {
      const exponent = (i >> 10) & 31;
      const mantissa = i & 1023;
      const size =
        exponent === 31 ? NaN : exponent ? (1 + mantissa / 1024) * 2 ** (exponent - 15) : mantissa * 2 ** -24;
      table[i] = i & 0x8000 ? -size : size;
    }
  }
  return table[code]!;
}
