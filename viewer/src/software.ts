// Draws on the processor alone: where the browser has no graphics processor it can use, this is several times
// as fast as the WebGL that it offers instead.

import { Camera } from "./camera";
import { half } from "./data";
import { LEAST, MOST, turned, weights, type Picture, type Renderer, type Shown } from "./picture";
import { matrix, multiply, type M4 } from "./space";

/** Steps of a disc's radius, in pixels, and of its shading. */
const STEP = 0.5;
const SHADES = 16;

/** The pixels of a ball of some radius: places beside its middle, and how light each is. */
interface Stamp {
  x: Int8Array;
  y: Int8Array;
  shade: Uint8Array;
}

function stamp(radius: number): Stamp {
  const reach = Math.floor(radius);
  const [x, y, shade]: number[][] = [[], [], []];
  for (let j = -reach; j <= reach; j++) {
    for (let i = -reach; i <= reach; i++) {
      const square = (i * i + j * j) / (radius * radius);
      if (square > 1) continue;
      const depth = Math.sqrt(1 - square);
      const light = radius > 1.5 ? 0.52 + 0.5 * ((-0.35 * i - 0.4 * j) / radius + 0.8 * depth) : 0.8;
      x!.push(i);
      y!.push(j);
      shade!.push(Math.round((SHADES - 1) * Math.min(Math.max(light, 0.3), 1.05) / 1.05));
    }
  }
  return { x: Int8Array.from(x!), y: Int8Array.from(y!), shade: Uint8Array.from(shade!) };
}

export class Software implements Renderer {
  private readonly context: CanvasRenderingContext2D;
  private readonly stamps: Stamp[] = [];
  private image = new ImageData(1, 1);
  /** Distances of what is seen in each pixel, and its colour and shade. */
  private depth = new Float32Array(1);
  private seen = new Uint16Array(1);
  private origins = new Uint16Array();
  private moved = new Uint16Array();
  private place = { low: [0, 0, 0], extent: [1, 1, 1], one: 1 };
  private sizes = new Float32Array();
  /** Where the particles are, for so many times their displacements. */
  private places: { magnified: number; all: Float32Array } | null = null;
  private shown: Shown | null = null;
  /** Numbers of the colours, by copy; one for all where it does not matter. */
  private colours: Uint8Array[] = [];
  private mesh: { start: Float32Array; now: Float32Array; one: number; edges: Uint32Array; outline: Uint32Array } | null = null;

  constructor(private readonly canvas: HTMLCanvasElement) {
    // Kept in memory, where it is written, and not with a graphics processor.
    this.context = canvas.getContext("2d", { alpha: false, willReadFrequently: true })!;
    for (let r = 0; r <= MOST / 2; r += STEP) this.stamps.push(stamp(Math.max(r, LEAST / 2)));
  }

  setOrigins(codes: Uint16Array<ArrayBuffer>, low: number[], extent: number[]): void {
    this.origins = codes;
    this.place = { ...this.place, low, extent };
    this.places = null;
  }

  setMoved(codes: Uint16Array<ArrayBuffer>, one: number): void {
    this.moved = codes;
    this.place.one = one;
    this.places = null;
  }

  setSizes(sizes: Float32Array<ArrayBuffer>): void {
    this.sizes = sizes;
  }

  setShown(shown: Shown): void {
    this.shown = shown;
    this.colours = [];
  }

  setColours(shown: Shown): void {
    this.setShown(shown);
  }

  setMesh(
    nodes: Uint16Array<ArrayBuffer>,
    low: number[],
    extent: number[],
    one: number,
    edges: Uint32Array<ArrayBuffer>,
    outline: Uint32Array<ArrayBuffer>,
  ): void {
    const start = Float32Array.from(nodes, (code, i) => low[i % 3]! + (extent[i % 3]! * code) / 65535);
    this.mesh = { start, now: start, one, edges, outline };
  }

  setMeshMoved(codes: Uint16Array<ArrayBuffer> | null): void {
    const { mesh } = this;
    if (mesh) mesh.now = codes ? mesh.start.map((x, i) => x + mesh.one * half(codes[i]!)) : mesh.start;
  }

  finish(): void {}

  draw(picture: Picture): void {
    const { width, height } = this.canvas;
    if (this.image.width !== width || this.image.height !== height) {
      this.image = new ImageData(width, height);
      this.depth = new Float32Array(width * height);
      this.seen = new Uint16Array(width * height);
    }
    this.depth.fill(Infinity);
    this.seen.fill(0);
    const { shown } = this;
    if (shown) {
      const places = this.positions(picture.magnified);
      const pixels = Camera.pixels(height) * picture.blown;
      picture.copies.forEach((copy, i) => {
        const view = multiply(picture.view, matrix(copy));
        this.balls(places, view, turned(picture.clip, copy), pixels, this.colour(shown, picture, i));
      });
    }
    this.paint(picture, shown);
    if (this.mesh) this.lines(picture, this.mesh);
    this.context.putImageData(this.image, 0, 0);
  }

  private positions(magnified: number): Float32Array {
    if (this.places?.magnified !== magnified) {
      const { origins, moved, place } = this;
      const all = new Float32Array(origins.length);
      for (let d = 0; d < 3; d++) {
        const [low, step, one] = [place.low[d]!, place.extent[d]! / 65535, magnified * place.one];
        for (let i = d; i < all.length; i += 3) all[i] = low + step * origins[i]! + one * half(moved[i]!);
      }
      this.places = { magnified, all };
    }
    return this.places.all;
  }

  /** Numbers of the particles' colours in a copy: components differ from copy to copy. */
  private colour(shown: Shown, picture: Picture, copy: number): Uint8Array {
    const which = shown.components === 1 || shown.whole ? 0 : copy;
    const known = this.colours[which];
    if (known) return known;
    const { codes, components: n } = shown;
    const count = codes.length / n;
    const colours = new Uint8Array(count);
    const [first, second] = weights(shown, picture.copies[which]!);
    const by = [...first, ...second];
    const [low, high] = shown.range;
    const scale = high > low ? 255 / (high - low) : 0;
    for (let i = 0, at = 0; i < count; i++, at += n) {
      let value = 0;
      if (shown.kinds) value = codes[at]!;
      else if (shown.whole) value = Math.hypot(half(codes[at]!), half(codes[at + 1]!), half(codes[at + 2]!));
      else for (let c = 0; c < n; c++) value += by[c]! * half(codes[at + c]!);
      colours[i] = Math.min(Math.max(Math.round((value - low) * scale), 0), 255);
    }
    this.colours[which] = colours;
    return colours;
  }

  private balls(places: Float32Array, m: M4, [a, b, c, d]: Picture["clip"], pixels: number, colours: Uint8Array): void {
    const { sizes, depth, seen, stamps } = this;
    const { width, height } = this.canvas;
    const [m0, m4, m8, m12] = [m[0]!, m[4]!, m[8]!, m[12]!];
    const [m1, m5, m9, m13] = [m[1]!, m[5]!, m[9]!, m[13]!];
    const [m3, m7, m11, m15] = [m[3]!, m[7]!, m[11]!, m[15]!];
    const largest = stamps.length - 1;
    for (let i = 0, k = 0; i < sizes.length; i++, k += 3) {
      const size = sizes[i]!;
      const x = places[k]!;
      const y = places[k + 1]!;
      const z = places[k + 2]!;
      if (size <= 0 || a * x + b * y + c * z > d) continue;
      const w = m3 * x + m7 * y + m11 * z + m15;
      if (w <= 0) continue;
      const px = Math.floor((0.5 + (0.5 * (m0 * x + m4 * y + m8 * z + m12)) / w) * width);
      const py = Math.floor((0.5 - (0.5 * (m1 * x + m5 * y + m9 * z + m13)) / w) * height);
      const radius = (0.5 * pixels * size) / w;
      const { x: xs, y: ys, shade } = stamps[Math.min(Math.round(radius / STEP), largest)]!;
      const colour = (colours[i]! << 5) | 16;
      const reach = ys[ys.length - 1]!;
      if (px >= reach && py >= reach && px < width - reach && py < height - reach) {
        const middle = py * width + px;
        for (let s = 0; s < xs.length; s++) {
          const at = middle + ys[s]! * width + xs[s]!;
          if (w < depth[at]!) {
            depth[at] = w;
            seen[at] = colour | shade[s]!;
          }
        }
      } else if (px > -reach && py > -reach && px < width + reach && py < height + reach) {
        for (let s = 0; s < xs.length; s++) {
          const [u, v] = [px + xs[s]!, py + ys[s]!];
          const at = v * width + u;
          if (u >= 0 && v >= 0 && u < width && v < height && w < depth[at]!) {
            depth[at] = w;
            seen[at] = colour | shade[s]!;
          }
        }
      }
    }
  }

  /** Colours for what is seen: 256 of them, each in all its shades. */
  private paint(picture: Picture, shown: Shown | null): void {
    const pixel = (r: number, g: number, b: number) => (255 << 24) | (b << 16) | (g << 8) | r;
    const ink = new Uint32Array(1 << 13);
    const [r, g, b] = picture.background.map((x) => Math.round(255 * x));
    ink.fill(pixel(r!, g!, b!));
    for (let colour = 0; shown && colour < 256; colour++) {
      for (let shade = 0; shade < SHADES; shade++) {
        const light = (1.05 * shade) / (SHADES - 1);
        const part = (d: number) => Math.min(255, Math.round(light * shown.palette[4 * colour + d]!));
        ink[(colour << 5) | 16 | shade] = pixel(part(0), part(1), part(2));
      }
    }
    const out = new Uint32Array(this.image.data.buffer);
    const { seen } = this;
    for (let i = 0; i < out.length; i++) out[i] = ink[seen[i]!]!;
  }

  private lines(picture: Picture, mesh: NonNullable<Software["mesh"]>): void {
    const { width, height } = this.canvas;
    const m = picture.view;
    const count = mesh.now.length / 3;
    const at = new Float32Array(mesh.now.length);
    for (let n = 0; n < count; n++) {
      const [x, y, z] = [mesh.now[3 * n]!, mesh.now[3 * n + 1]!, mesh.now[3 * n + 2]!];
      const row = (r: number) => m[r]! * x + m[4 + r]! * y + m[8 + r]! * z + m[12 + r]!;
      const w = row(3);
      at[3 * n] = (0.5 + (0.5 * row(0)) / w) * width;
      at[3 * n + 1] = (0.5 - (0.5 * row(1)) / w) * height;
      at[3 * n + 2] = w;
    }
    const ink = picture.ink.map((x) => 255 * x);
    const draw = (pairs: Uint32Array, alpha: number) => {
      for (let e = 0; alpha > 0 && e < pairs.length; e += 2) this.line(at, 3 * pairs[e]!, 3 * pairs[e + 1]!, ink, alpha);
    };
    draw(mesh.edges, picture.edges);
    draw(mesh.outline, picture.outline ? 0.55 : 0);
  }

  /** Pixel by pixel, where nothing nearer is seen. */
  private line(at: Float32Array, from: number, to: number, ink: number[], alpha: number): void {
    const { width, height } = this.canvas;
    const { data } = this.image;
    const [x, y, w] = [at[from]!, at[from + 1]!, at[from + 2]!];
    const [dx, dy, dw] = [at[to]! - x, at[to + 1]! - y, at[to + 2]! - w];
    // Behind the eye there is nothing to be drawn.
    if (w <= 0 || w + dw <= 0) return;
    const steps = Math.ceil(Math.max(Math.abs(dx), Math.abs(dy), 1));
    if (steps > 20_000) return;
    for (let s = 0; s <= steps; s++) {
      const t = s / steps;
      const [u, v] = [Math.floor(x + t * dx), Math.floor(y + t * dy)];
      if (u < 0 || v < 0 || u >= width || v >= height) continue;
      const i = v * width + u;
      if (w + t * dw > this.depth[i]! * 1.001) continue;
      for (let d = 0; d < 3; d++) data[4 * i + d] = data[4 * i + d]! + alpha * (ink[d]! - data[4 * i + d]!);
    }
  }
}

/** Whether to draw here: where the browser has no graphics processor that it can use. `#webgl` and `#software`
 * at the end of the page's address choose. */
export function bySoftware(): boolean {
  if (location.hash === "#webgl") return false;
  if (location.hash === "#software") return true;
  const trial = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
  const named = trial?.getExtension("WEBGL_debug_renderer_info");
  const name: string = named ? trial!.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  trial?.getExtension("WEBGL_lose_context")?.loseContext();
  return !trial || /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
