// The ground in 3D: what is shown, and the controls for it.

import { Camera } from "./camera";
import { choices, type Choice } from "./choices";
import { colour, kind, palette, type MapName } from "./colours";
import { bytes, half, Store, type About, type Frame, type Pictures } from "./data";
import { button, labelled, make, menu, save, style } from "./dom";
import { edges } from "./edges";
import { number } from "./format";
import { Graphics } from "./graphics";
import { attach } from "./input";
import { ofKinds, ofRange } from "./legend";
import type { Renderer } from "./picture";
import { readout, type Picked } from "./readout";
import { bySoftware, Software } from "./software";
import { apply, copies, direction, dot, length, sub, times, type Extent, type V3 } from "./space";

/** More copies of particles are not drawn unless they are asked for. */
const MANY = 250_000;
/** Values of the slider for the clipping plane. */
const CLIPS = 200;

type RangeKind = "inner" | "all" | "frame" | "manual";

export class View {
  /** Called when another frame is shown. */
  changed: () => void = () => {};
  private readonly renderer: Renderer;
  private readonly software: boolean;
  private readonly camera: Camera;
  private readonly canvas = make("canvas", { tabindex: "0", role: "img" });
  private readonly legend = make("div", { class: "legend", "aria-live": "polite" });
  private readonly picked = make("div", { class: "picked", "aria-live": "polite" });
  private readonly triad = make("div", { class: "triad", "aria-hidden": "true" });
  private readonly print = make("img", { class: "print-only", alt: "The ground as shown when this was printed" });
  private readonly slider = make("input", { type: "range", id: "frame", min: "0", step: "1", "aria-label": "Frame" });
  private readonly clock = make("output", { for: "frame", id: "clock" });
  private readonly player: HTMLButtonElement;
  private readonly all: Choice[];
  private readonly fieldMenu: HTMLSelectElement;
  private readonly rangeMenu: HTMLSelectElement;
  private readonly lowest = make("input", { type: "number", step: "any", "aria-label": "Lowest value of the colours" });
  private readonly highest = make("input", { type: "number", step: "any", "aria-label": "Highest value of the colours" });
  private readonly store = new Store(24);
  private readonly size: number;
  private sizes = new Float32Array();
  private ids = new Uint32Array();
  private choice: Choice;
  private map: MapName | "auto" = "auto";
  private rangeKind: RangeKind = "all";
  private frame = 0;
  private extent: Extent = "part";
  private edges = 0.12;
  private outline = true;
  private magnified = 1;
  private blown = 0.85;
  private clipAxis: number | null = null;
  private clipAt = CLIPS / 2;
  private clipOther = false;
  private marked: number | null = null;
  private playing = 0;
  private dirty = false;
  private loading = Promise.resolve();

  private constructor(private readonly run: About, private readonly pictures: Pictures) {
    this.software = bySoftware();
    this.renderer = this.software ? new Software(this.canvas) : new Graphics(this.canvas);
    this.camera = new Camera(run.up as V3);
    this.all = choices(pictures);
    this.choice = this.all[0]!;
    this.size = length(sub(pictures.high as V3, pictures.low as V3)) || 1;
    this.frame = pictures.frames.length - 1;
    this.slider.max = String(this.frame);
    this.slider.value = String(this.frame);
    this.player = button("▶ Play", "Play all frames (space)", () => this.play());
    this.fieldMenu = menu("field", "Colour by", this.fields(), (key) => void this.setField(key));
    this.rangeMenu = menu(
      "range",
      "Range of the colours",
      [
        ["inner", "all frames, without extremes"],
        ["all", "all frames"],
        ["frame", "this frame"],
        ["manual", "by hand"],
      ],
      (value) => this.setRange(value as RangeKind),
    );
    if (run.part) this.extent = this.bearable(run.part.kind === "sector" ? "open" : "part");
  }

  static async open(place: HTMLElement, run: About, pictures: Pictures): Promise<View> {
    const view = new View(run, pictures);
    await view.load();
    place.replaceChildren(...view.layout());
    view.canvas.setAttribute("aria-label", "The particles in 3D. Arrows turn, plus and minus zoom, shift and arrows move");
    attach(view.canvas, {
      turn: (x, y) => view.turn(x, y),
      pan: (x, y) => view.move(() => view.camera.pan(x, y)),
      zoom: (factor) => view.move(() => view.camera.zoom(factor)),
      pick: (x, y) => void view.pick(x, y),
      key: (key) => view.key(key),
    });
    new ResizeObserver(() => view.resize()).observe(view.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => view.redraw());
    addEventListener("beforeprint", () => view.beforePrint());
    view.resize();
    view.corner();
    await view.setField(view.choice.key);
    return view;
  }

  /** Of the frame that is shown, s. */
  get time(): number {
    return this.current.time;
  }

  private get current(): Frame {
    return this.pictures.frames[this.frame]!;
  }

  private bearable(extent: Extent): Extent {
    return copies(this.run.part, extent).length * this.pictures.count > MANY ? "part" : extent;
  }

  private fields(): { group: string; entries: [string, string][] }[] {
    const groups = new Map<string, [string, string][]>();
    for (const choice of this.all) {
      const entries = groups.get(choice.field.title) ?? [];
      const caption = choice.whole ? `${choice.caption}, length` : choice.caption;
      entries.push([choice.key, caption]);
      groups.set(choice.field.title, entries);
    }
    return [...groups].map(([group, entries]) => ({ group, entries }));
  }

  /** What never changes. */
  private async load(): Promise<void> {
    const { pictures } = this;
    const sizes = await this.store.codes(pictures.sizes.blob, 1);
    this.sizes = Float32Array.from(sizes, (code) => half(code) * pictures.sizes.one);
    // A lone particle has no neighbours to be measured by.
    const usual = this.size / 40;
    this.sizes = this.sizes.map((size) => (size > 0 ? size : usual));
    this.ids = new Uint32Array((await bytes(pictures.ids)).buffer);
    const mesh = pictures.mesh;
    if (mesh && !mesh.left_out) {
      const nodes = await this.store.codes(mesh.nodes, 3);
      const triangles = new Uint32Array((await bytes(mesh.triangles)).buffer);
      const place = (n: number): V3 =>
        [0, 1, 2].map((d) => mesh.low[d]! + (mesh.size[d]! * nodes[3 * n + d]!) / 65535) as V3;
      this.renderer.setMesh(nodes, mesh.low, mesh.size, mesh.one, ...edges(triangles, place));
    }
    await this.loadFrame();
  }

  private async loadFrame(): Promise<void> {
    const { pictures, current, choice } = this;
    const { origins, mesh } = pictures;
    const moved = pictures.fields.findIndex((f) => f.name === "displacement");
    const [start, way, shown, mask, surface] = await Promise.all([
      this.store.codes(origins.sets[current.origin]!, 3),
      this.store.codes(current.fields[moved]!, 3),
      this.store.codes(current.fields[choice.index]!, choice.field.components),
      current.present === null ? null : bytes(current.present),
      mesh && current.mesh !== null ? this.store.codes(current.mesh, 3) : null,
    ]);
    // Another frame may have been asked for meanwhile.
    if (current !== this.current || choice !== this.choice) return;
    this.renderer.setOrigins(start, origins.low, origins.size);
    this.renderer.setMoved(way, pictures.fields[moved]!.one!);
    this.renderer.setSizes(mask ? this.sizes.map((size, i) => (mask[i] ? size : 0)) : this.sizes);
    if (mesh && !mesh.left_out) this.renderer.setMeshMoved(surface, mesh.count);
    this.renderer.setShown(this.shown(shown));
    this.updateClock();
    this.redraw();
  }

  private shown(codes: Uint16Array<ArrayBuffer>) {
    const { choice } = this;
    const [low, high] = this.range();
    const one = choice.field.one ?? 1;
    return {
      codes,
      components: choice.field.components,
      kinds: choice.kinds,
      whole: choice.whole,
      component: choice.component,
      range: (choice.kinds ? [0, 255] : [low / one, high / one]) as [number, number],
      palette: palette((i) => (choice.kinds ? kind(choice.field.name, i) : colour(this.mapName, i / 255))),
    };
  }

  private get mapName(): MapName {
    if (this.map !== "auto") return this.map;
    return this.choice.signed ? "cool-warm" : "viridis";
  }

  /** What the colours span, in SI units. */
  private range(): [number, number] {
    const { choice } = this;
    if (this.rangeKind === "manual") {
      const [low, high] = [Number(this.lowest.value), Number(this.highest.value)];
      if (Number.isFinite(low) && high > low) return [low * choice.scale.factor, high * choice.scale.factor];
    }
    const here = this.current.ranges[choice.field.name]?.[choice.part];
    let [low, high] = [choice.overall[0], choice.overall[1]];
    if (this.rangeKind === "inner") [low, high] = [choice.overall[2], choice.overall[3]];
    if (this.rangeKind === "frame" && here) [low, high] = [here.least, here.greatest];
    if (choice.signed && this.mapName === "cool-warm") {
      const most = Math.max(Math.abs(low), Math.abs(high));
      return [-most, most];
    }
    return [low, high];
  }

  private updateLegend(): void {
    const { choice } = this;
    const [low, high] = this.range();
    const nodes = choice.kinds ? ofKinds(choice, this.pictures) : ofRange(choice, this.mapName, low, high);
    this.legend.replaceChildren(...nodes);
    if (this.rangeKind !== "manual") {
      const shown = (x: number) => String(Number((x / choice.scale.factor).toPrecision(4)));
      this.lowest.value = shown(low);
      this.highest.value = shown(high);
    }
  }

  private updateClock(): void {
    const { current, pictures } = this;
    const last = pictures.frames.length - 1;
    this.clock.textContent = `t = ${number(current.time)} s · frame ${this.frame} of ${last}`;
    this.slider.setAttribute("aria-valuetext", `${number(current.time)} seconds`);
    this.updateLegend();
    this.updatePicked();
    this.changed();
  }

  async setField(key: string): Promise<void> {
    const choice = this.all.find((c) => c.key === key);
    if (!choice) return;
    this.choice = choice;
    this.fieldMenu.value = key;
    const [least, greatest, low, high] = choice.overall;
    // A few particles with great values would leave one colour to all others.
    const extremes = greatest - least > 2.5 * (high - low) && high > low;
    if (this.rangeKind !== "frame") this.rangeKind = extremes ? "inner" : "all";
    this.rangeMenu.value = this.rangeKind;
    for (const control of [this.rangeMenu, this.lowest, this.highest]) control.parentElement!.hidden = choice.kinds;
    await this.loadFrame();
  }

  private setRange(range: RangeKind): void {
    this.rangeKind = range;
    this.rangeMenu.value = range;
    this.recolour();
  }

  private recolour(): void {
    void this.store.codes(this.current.fields[this.choice.index]!, this.choice.field.components).then((codes) => {
      this.renderer.setColours(this.shown(codes));
      this.updateLegend();
      this.redraw();
    });
  }

  /** Shows a frame by its place among those that are there; one after the other. */
  setFrame(frame: number): Promise<void> {
    const last = this.pictures.frames.length - 1;
    this.frame = Math.min(Math.max(frame, 0), last);
    this.slider.value = String(this.frame);
    this.loading = this.loading.then(() => this.loadFrame());
    return this.loading;
  }

  /** Shows a field in the frame nearest to the run's frame of this number, and marks a particle. */
  async show(key: string, number: number | null, id: number | null): Promise<void> {
    this.stop();
    if (number !== null) {
      const away = (f: Frame) => Math.abs(f.number - number);
      const nearest = this.pictures.frames.reduce((best, f, i, all) => (away(f) < away(all[best]!) ? i : best), 0);
      this.frame = nearest;
      this.slider.value = String(nearest);
    }
    this.marked = id === null ? null : this.ids.indexOf(id);
    if (this.marked !== null && this.marked < 0) this.marked = null;
    await this.setField(key);
  }

  private play(): void {
    if (this.playing) return this.stop();
    this.player.textContent = "⏸ Pause";
    if (this.frame === this.pictures.frames.length - 1) this.frame = -1;
    const each = Math.min(Math.max(6000 / this.pictures.frames.length, 60), 400);
    const token = ++this.token;
    this.playing = token;
    const next = async () => {
      if (this.playing !== token) return;
      const begun = performance.now();
      await this.setFrame(this.frame + 1);
      if (this.frame === this.pictures.frames.length - 1) return this.stop();
      setTimeout(() => void next(), Math.max(0, each - (performance.now() - begun)));
    };
    void next();
  }

  private token = 0;

  private stop(): void {
    this.playing = 0;
    this.player.textContent = "▶ Play";
  }

  private key(key: string): boolean {
    if (key === " ") this.play();
    else if (key === "[" || key === "PageUp") void this.setFrame(this.frame - 1);
    else if (key === "]" || key === "PageDown") void this.setFrame(this.frame + 1);
    else if (key === "0" || key === "Home") this.corner();
    else return false;
    return true;
  }

  turn(x: number, y: number): void {
    this.move(() => this.camera.orbit(x, y));
  }

  private move(change: () => void): void {
    change();
    this.redraw();
  }

  /** The box of all that is shown. */
  private box(): [V3, V3] {
    const { low, high } = this.pictures as unknown as { low: V3; high: V3 };
    const corners = copies(this.run.part, this.extent).flatMap((copy) =>
      Array.from({ length: 8 }, (_, c) => apply(copy, [0, 1, 2].map((d) => (c & (1 << d) ? high[d]! : low[d]!)) as V3)),
    );
    const end = (of: (...values: number[]) => number) =>
      [0, 1, 2].map((d) => of(...corners.map((corner) => corner[d]!))) as V3;
    // Corners of a sector's box reach farther than the sector when they are turned.
    return [end(Math.min), end(Math.max)];
  }

  private see(along: V3, rise: number): void {
    this.camera.lookAlong(along, rise);
    this.camera.see(...this.box(), this.canvas.width / this.canvas.height);
    this.redraw();
  }

  /** Where everything is seen at once, planes of symmetry from outside. */
  private corner(): void {
    const part = this.run.part;
    let along: V3 = [0.5, 0.8, 0];
    if (part?.kind === "half") {
      along = [0, 0, 0];
      along[part.axis] = this.outside(part.axis);
      along[(part.axis + 1) % 3] += 0.45;
    } else if (part?.kind === "sector") {
      // Into the open quarter, or onto the face at θ = 0.
      const open = copies(part, this.extent).length * part.angle;
      along = this.extent === "part" ? times(direction(part.axis, part.angle / 2 + Math.PI / 2), 1) : times(direction(part.axis, (open + 2 * Math.PI) / 2), -1);
      if (this.extent === "whole") along = [0.5, 0.8, 0];
    }
    this.see(along, 0.4);
  }

  /** The direction from the plane of symmetry into the part. */
  private outside(axis: number): number {
    return this.pictures.high[axis]! + this.pictures.low[axis]! >= 0 ? 1 : -1;
  }

  private clip(): [number, number, number, number] {
    if (this.clipAxis === null) return [0, 0, 0, 1];
    const [low, high] = this.box();
    const a = this.clipAxis;
    const at = low[a]! + (this.clipAt / CLIPS) * (high[a]! - low[a]!);
    const normal: V3 = [0, 0, 0];
    normal[a] = this.clipOther ? -1 : 1;
    return [...normal, normal[a]! * at];
  }

  private resize(): void {
    // More pixels cost the processor more than they are worth.
    const ratio = Math.min(devicePixelRatio || 1, this.software ? 1 : 2);
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    this.redraw();
  }

  private redraw(): void {
    if (this.dirty) return;
    this.dirty = true;
    requestAnimationFrame(() => {
      this.dirty = false;
      this.draw();
    });
  }

  private colourOf(name: string): V3 {
    const hex = style(name).replace("#", "");
    return [0, 2, 4].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255) as V3;
  }

  private aspect(): number {
    return this.canvas.width / this.canvas.height;
  }

  /** Draws at once. */
  draw(): void {
    this.renderer.draw({
      view: this.camera.matrix(this.aspect(), this.size),
      copies: copies(this.run.part, this.extent),
      magnified: this.magnified,
      blown: this.blown,
      clip: this.clip(),
      background: this.colourOf("--ground"),
      ink: this.colourOf("--mesh"),
      edges: this.edges,
      outline: this.outline,
    });
    this.drawTriad();
    this.placeMark();
  }

  /** Draws and waits for it: for measuring. */
  drawAndWait(): void {
    this.draw();
    this.renderer.finish();
  }

  private drawTriad(): void {
    const [right, up] = this.camera.axes();
    const colours = ["#d55e00", "#009e73", "#0072b2"];
    const line = (d: number) => {
      const axis: V3 = [0, 0, 0];
      axis[d] = 1;
      const [x, y] = [26 * dot(axis, right), -26 * dot(axis, up)];
      const end = `<line x2="${x}" y2="${y}" stroke="${colours[d]}" stroke-width="2"/>`;
      return `${end}<text x="${1.35 * x}" y="${1.35 * y}">${"xyz"[d]}</text>`;
    };
    this.triad.innerHTML = `<svg viewBox="-42 -42 84 84">${[0, 1, 2].map(line).join("")}</svg>`;
  }

  /** Place of a drawn particle in the computed part, m, as it is drawn. */
  private place(slot: number, origins: Uint16Array, moved: Uint16Array, one: number): V3 {
    const { low, size } = this.pictures.origins;
    return [0, 1, 2].map(
      (d) => low[d]! + (size[d]! * origins[3 * slot + d]!) / 65535 + this.magnified * one * half(moved[3 * slot + d]!),
    ) as V3;
  }

  private async arrays(): Promise<{ origins: Uint16Array; moved: Uint16Array; one: number; mask: Uint8Array | null }> {
    const { pictures, current } = this;
    const index = pictures.fields.findIndex((f) => f.name === "displacement");
    const [origins, moved] = await Promise.all([
      this.store.codes(pictures.origins.sets[current.origin]!, 3),
      this.store.codes(current.fields[index]!, 3),
    ]);
    const mask = current.present === null ? null : await bytes(current.present);
    return { origins, moved, one: pictures.fields[index]!.one!, mask };
  }

  /** Marks the particle that is seen at a place of the canvas, in CSS pixels. */
  async pick(x: number, y: number): Promise<void> {
    const { origins, moved, one, mask } = await this.arrays();
    const ratio = this.canvas.width / this.canvas.clientWidth;
    const view = this.camera.matrix(this.aspect(), this.size);
    const clip = this.clip();
    const wide = Camera.pixels(this.canvas.height) * this.blown;
    let best: { slot: number; depth: number } | null = null;
    for (const copy of copies(this.run.part, this.extent)) {
      for (let slot = 0; slot < this.pictures.count; slot++) {
        if (mask && !mask[slot]) continue;
        const at = apply(copy, this.place(slot, origins, moved, one));
        if (dot([clip[0], clip[1], clip[2]], at) > clip[3]) continue;
        const row = (r: number) => view[r]! * at[0] + view[4 + r]! * at[1] + view[8 + r]! * at[2] + view[12 + r]!;
        const depth = row(3);
        if (depth <= 0) continue;
        const px = (0.5 + (0.5 * row(0)) / depth) * this.canvas.width - x * ratio;
        const py = (0.5 - (0.5 * row(1)) / depth) * this.canvas.height - y * ratio;
        const radius = Math.max(3 * ratio, (0.5 * wide * this.sizes[slot]!) / depth);
        if (px * px + py * py < radius * radius && (!best || depth < best.depth)) best = { slot, depth };
      }
    }
    this.marked = best?.slot ?? null;
    this.updatePicked();
    this.redraw();
  }

  private readonly ring = make("div", { class: "ring", hidden: "" });
  private markedAt: V3 | null = null;

  private updatePicked(): void {
    const slot = this.marked;
    const frame = this.current;
    if (slot === null) {
      this.markedAt = null;
      this.picked.replaceChildren(make("p", { class: "hint" }, "Click a particle to read its values."));
      return;
    }
    void (async () => {
      const { origins, moved, one, mask } = await this.arrays();
      const values = await Promise.all(
        this.pictures.fields.map((field, i) => this.store.codes(frame.fields[i]!, field.components)),
      );
      if (frame !== this.current || slot !== this.marked) return;
      const there = !mask || mask[slot] === 1;
      const magnified = this.magnified;
      this.magnified = 1;
      const at = this.place(slot, origins, moved, one);
      this.magnified = magnified;
      this.markedAt = there ? this.place(slot, origins, moved, one) : null;
      const picked: Picked = { slot, id: this.ids[slot]!, at, there };
      this.picked.replaceChildren(...readout(picked, this.pictures, values));
      this.placeMark();
    })();
  }

  /** Puts a ring round the marked particle, as the computed part has it. */
  private placeMark(): void {
    this.ring.hidden = this.markedAt === null;
    if (!this.markedAt) return;
    const view = this.camera.matrix(this.aspect(), this.size);
    const at = this.markedAt;
    const row = (r: number) => view[r]! * at[0] + view[4 + r]! * at[1] + view[8 + r]! * at[2] + view[12 + r]!;
    this.ring.style.left = `${(50 + (50 * row(0)) / row(3)).toFixed(2)}%`;
    this.ring.style.top = `${(50 - (50 * row(1)) / row(3)).toFixed(2)}%`;
  }

  private beforePrint(): void {
    this.draw();
    this.print.src = this.canvas.toDataURL("image/png");
    addEventListener("afterprint", () => this.redraw(), { once: true });
  }

  /** The picture with its legend. */
  private shoot(): void {
    this.draw();
    const { canvas } = this;
    const ratio = canvas.width / canvas.clientWidth;
    const below = 74 * ratio;
    const whole = make("canvas", { width: String(canvas.width), height: String(canvas.height + below) });
    const context = whole.getContext("2d")!;
    context.fillStyle = style("--paper");
    context.fillRect(0, 0, whole.width, whole.height);
    context.drawImage(canvas, 0, 0);
    const { choice } = this;
    context.fillStyle = style("--ink");
    context.font = `${14 * ratio}px system-ui, sans-serif`;
    const unit = choice.scale.unit ? ` in ${choice.scale.unit}` : "";
    context.fillText(`${choice.caption}${unit}, t = ${number(this.time)} s`, 10 * ratio, canvas.height + 20 * ratio);
    const wide = Math.min(420 * ratio, whole.width - 20 * ratio);
    const [low, high] = this.range();
    const names = choice.field.name === "body" ? this.pictures.bodies : this.pictures.states;
    for (let i = 0; i < 256 && !choice.kinds; i++) {
      const [r, g, b] = colour(this.mapName, i / 255);
      context.fillStyle = `rgb(${r} ${g} ${b})`;
      context.fillRect(10 * ratio + (i * wide) / 256, canvas.height + 30 * ratio, wide / 256 + 1, 14 * ratio);
    }
    context.font = `${12 * ratio}px system-ui, sans-serif`;
    if (choice.kinds) {
      let x = 10 * ratio;
      names.forEach((name, i) => {
        const [r, g, b] = kind(choice.field.name, i);
        context.fillStyle = `rgb(${r} ${g} ${b})`;
        context.fillText(`● ${name}`, x, canvas.height + 44 * ratio);
        x += context.measureText(`● ${name}   `).width;
      });
    } else {
      context.fillStyle = style("--ink");
      context.fillText(number(low / choice.scale.factor), 10 * ratio, canvas.height + 62 * ratio);
      context.textAlign = "right";
      context.fillText(number(high / choice.scale.factor), 10 * ratio + wide, canvas.height + 62 * ratio);
    }
    const name = `${this.run.case ?? "run"}-${choice.field.name}-${this.current.number}.png`;
    whole.toBlob((blob) => blob && save(name, blob));
  }

  private layout(): Node[] {
    const { run } = this;
    this.slider.addEventListener("input", () => {
      this.stop();
      void this.setFrame(Number(this.slider.value));
    });
    for (const input of [this.lowest, this.highest]) input.addEventListener("input", () => this.setRange("manual"));
    const maps = menu(
      "map",
      "Colour map",
      [["auto", "automatic"], ["viridis", "viridis"], ["cool-warm", "cool–warm"]],
      (value) => {
        this.map = value as MapName | "auto";
        this.recolour();
      },
    );
    const colours = make(
      "div",
      { class: "row" },
      labelled("Colour by", this.fieldMenu),
      labelled("Range", this.rangeMenu),
      labelled("from", this.lowest),
      labelled("to", this.highest),
      labelled("Colours", maps),
    );
    const time = make("div", { class: "row time" }, this.player, this.slider, this.clock);
    if (this.pictures.frames.length < 2) {
      this.slider.disabled = true;
      this.player.disabled = true;
    }
    const axes = make("div", { class: "row" });
    const presets: [string, () => void][] = [
      ["Corner", () => this.corner()],
      ["Along x", () => this.see([1, 0, 0], 0)],
      ["Along y", () => this.see([0, 1, 0], 0)],
      ["Along z", () => this.see([0.001, 1, 0], Math.PI / 2)],
    ];
    if (Math.abs(run.up[2]!) < 0.9) presets.pop();
    axes.append(
      make("span", { class: "group", role: "group", "aria-label": "Look" }, "Look ", ...presets.map(([c, f]) => button(c, `Look so: ${c}`, f))),
    );
    if (run.part) {
      const entries: [string, string][] = [["part", `computed ${run.part.kind}`]];
      if (run.part.kind === "sector") entries.push(["open", "cut open"]);
      entries.push(["whole", "whole body"]);
      const extent = menu("extent", "How much of the body", entries, (value) => {
        this.extent = value as Extent;
        this.corner();
      });
      extent.value = this.extent;
      axes.append(labelled("Show", extent));
    }
    const mesh = this.pictures.mesh;
    if (mesh && !mesh.left_out) {
      const meshes = menu("mesh", "Mesh", [["edges", "surface"], ["outline", "outline"], ["none", "none"]], (value) => {
        this.edges = value === "edges" ? 0.12 : 0;
        this.outline = value !== "none";
        this.redraw();
      });
      axes.append(labelled("Mesh", meshes));
    }
    axes.append(...this.clipControls(), ...this.sizeControls(), button("Save picture", "Save what is seen, with its legend", () => this.shoot()));
    const stage = make("div", { class: "stage" }, this.canvas, this.ring, this.triad);
    return [
      colours,
      stage,
      this.print,
      time,
      make("div", { class: "below" }, this.legend, this.picked),
      axes,
      make(
        "p",
        { class: "hint no-print" },
        "Drag to turn, shift and drag to move, Ctrl and wheel to zoom; on a touch screen one finger turns, two move and zoom. ",
        "With the picture in focus: arrows, shift and arrows, + and −, [ and ] for frames, space to play, 0 for the view at the start.",
      ),
    ];
  }

  private clipControls(): Node[] {
    const at = make("input", { type: "range", min: "0", max: String(CLIPS), value: String(this.clipAt), "aria-label": "Place of the cut" });
    const other = make("input", { type: "checkbox", "aria-label": "Take away the other side" });
    at.disabled = other.disabled = true;
    const axis = menu("clip", "Cut across", [["", "not"], ["0", "x"], ["1", "y"], ["2", "z"]], (value) => {
      this.clipAxis = value === "" ? null : Number(value);
      at.disabled = other.disabled = this.clipAxis === null;
      this.redraw();
    });
    at.addEventListener("input", () => {
      this.clipAt = Number(at.value);
      this.redraw();
    });
    other.addEventListener("change", () => {
      this.clipOther = other.checked;
      this.redraw();
    });
    return [make("span", { class: "group" }, labelled("Cut", axis), at, labelled("other side", other))];
  }

  private sizeControls(): Node[] {
    const magnify = menu(
      "magnify",
      "Displacements drawn",
      [["1", "as they are"], ["0", "not"], ["10", "× 10"], ["100", "× 100"], ["1000", "× 1000"]],
      (value) => {
        this.magnified = Number(value);
        this.updatePicked();
        this.redraw();
      },
    );
    const blown = menu("blown", "Size of particles", [["0.85", "full"], ["0.5", "smaller"], ["0.25", "dots"], ["1.2", "larger"]], (value) => {
      this.blown = Number(value);
      this.redraw();
    });
    return [labelled("Displacements", magnify), labelled("Particles", blown)];
  }

  /** For tests: what is shown. */
  get state() {
    return {
      software: this.software,
      field: this.choice.key,
      frame: this.frame,
      frames: this.pictures.frames.length,
      count: this.pictures.count,
      copies: copies(this.run.part, this.extent).length,
      picked: this.marked === null ? null : this.ids[this.marked]!,
    };
  }
}



