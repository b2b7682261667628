// The histories as curves.

import uPlot from "uplot";
import { button, make, save, style } from "./dom";
import { number } from "./format";

/** Curves that stand in one picture. */
interface Group {
  name: string;
  unit: string;
  columns: number[];
}

interface Table {
  names: string[];
  /** One array a column. */
  columns: Float64Array[];
}

/** Told apart by most people who see colours otherwise, on light and on dark ground. */
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6bb1", "#7f7f7f", "#b3a100"];
/** Columns of the run itself. */
const OF_RUN = ["time", "stage", "stage_time", "step"];
const COMPONENTS = ["x", "y", "z", "xx", "yy", "zz", "xy", "yz", "zx"];
/** Of no part of the balance, or too small beside the others to be seen. */
const BESIDE = ["energy.kinetic_grid", "energy.residual"];

export function parse(csv: string): Table {
  const lines = csv.split("\n").filter((l) => l.trim() && !l.startsWith("#"));
  const names = (lines.shift() ?? "").split(",").map((n) => n.replace(/^"|"$/g, ""));
  const columns = names.map(() => new Float64Array(lines.length));
  lines.forEach((line, row) => line.split(",").forEach((cell, i) => (columns[i]![row] = Number(cell === "NaN" ? NaN : cell))));
  return { names, columns };
}

/** The vectors, tensors and contacts that columns belong to. */
export function groups(names: string[], units: Record<string, string>): Group[] {
  const all = new Map<string, Group>();
  names.forEach((name, column) => {
    if (OF_RUN.includes(name)) return;
    const words = name.split(".");
    const last = words.at(-1)!;
    const counted = words[0] === "contact" && ["sticking", "sliding", "open"].includes(last);
    const of =
      words[0] === "energy" ? "energy" : counted || COMPONENTS.includes(last) ? words.slice(0, -1).join(".") : name;
    const unit = counted ? "nodes" : (units[name] ?? "");
    const key = `${of} ${unit}`;
    const group = all.get(key) ?? { name: of, unit, columns: [] };
    group.columns.push(column);
    all.set(key, group);
  });
  return [...all.values()].sort((a, b) => rank(a) - rank(b));
}

/** Energies and the length of steps come last. */
function rank(group: Group): number {
  return group.name === "dt" ? 2 : group.name === "energy" ? 1 : 0;
}

export class Plot {
  readonly element: HTMLElement;
  private readonly ground = make("div", { class: "ground", tabindex: "0", role: "img" });
  private chart: uPlot | null = null;
  private readonly data: uPlot.AlignedData;
  private readonly labels: string[];
  private index = 0;

  constructor(
    private readonly table: Table,
    readonly group: Group,
    private readonly marks: () => number | null,
  ) {
    const time = table.columns[table.names.indexOf("time")]!;
    const columns = group.columns.map((c) => table.columns[c]!);
    this.data = [time, ...columns] as unknown as uPlot.AlignedData;
    this.labels = group.columns.map((c) => table.names[c]!.slice(table.names[c] === group.name ? 0 : group.name.length + 1));
    this.ground.setAttribute("aria-label", `Curves of ${group.name} over time; left and right arrows read values`);
    this.ground.addEventListener("keydown", (event) => this.key(event));
    const tools = make(
      "div",
      { class: "tools" },
      button("Whole", "Show all of it again (Escape)", () => this.reset()),
      button("PNG", "Save the picture", () => this.png()),
      button("CSV", "Save the values", () => save(`${group.name}.csv`, new Blob([this.csv()], { type: "text/csv" }))),
    );
    this.element = make(
      "figure",
      { class: "plot", "data-plot": group.name },
      make("figcaption", {}, make("b", {}, group.name), group.unit ? ` in ${group.unit}` : "", tools),
      this.ground,
    );
  }

  get points(): number {
    return this.data[0].length;
  }

  get curves(): number {
    return this.data.length - 1;
  }

  /** From when to when it is shown, s. */
  get shown(): [number, number] {
    const { min, max } = this.chart!.scales["x"]!;
    return [min!, max!];
  }

  /** Draws it, or draws it anew in other colours or of another width. */
  draw(): void {
    this.chart?.destroy();
    const [ink, faint] = [style("--ink"), style("--line")];
    const axis: uPlot.Axis = {
      stroke: ink,
      grid: { stroke: faint, width: 1 },
      ticks: { stroke: faint, width: 1 },
      font: "12px system-ui, sans-serif",
    };
    const still = (c: Float64Array) => c.every((v) => v === 0);
    this.chart = new uPlot(
      {
        width: this.ground.clientWidth || 600,
        height: 260,
        scales: { x: { time: false } },
        cursor: { drag: { x: true, y: true, uni: 30 }, focus: { prox: 20 } },
        focus: { alpha: 0.35 },
        axes: [
          { ...axis, label: "time in s", labelSize: 20, size: 34, labelFont: "12px system-ui, sans-serif" },
          {
            ...axis,
            size: 74,
            values: (_, all) => all.map((v) => (v === null ? "" : number(v))),
          },
        ],
        series: [
          { label: "t / s", value: (_, v) => (v === null ? "–" : number(v)) },
          ...this.group.columns.map((column, i): uPlot.Series => ({
            label: this.labels[i]!,
            stroke: COLOURS[i % COLOURS.length]!,
            width: 1.5,
            dash: i >= COLOURS.length ? [6, 4] : undefined!,
            // What stays zero would only hide the rest of the legend.
            show:
              this.group.name !== "energy" ||
              !(still(this.table.columns[column]!) || BESIDE.includes(this.table.names[column]!)),
            value: (_, v) => (v === null ? "–" : number(v)),
            points: { show: this.points < 60 },
          })),
        ],
        hooks: { draw: [(chart) => this.mark(chart)] },
      },
      this.data,
      this.ground,
    );
  }

  /** The time of the frame that the 3D view shows. */
  private mark(chart: uPlot): void {
    const time = this.marks();
    if (time === null) return;
    const x = chart.valToPos(time, "x", true);
    const { left, top, width, height } = chart.bbox;
    if (x < left || x > left + width) return;
    const context = chart.ctx;
    context.save();
    context.strokeStyle = style("--ink");
    context.globalAlpha = 0.5;
    context.setLineDash([4, 4]);
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, top + height);
    context.stroke();
    context.restore();
  }

  redraw(): void {
    this.chart?.redraw(false);
  }

  reset(): void {
    this.chart?.setData(this.data, true);
  }

  private key(event: KeyboardEvent): void {
    const chart = this.chart;
    if (!chart) return;
    const last = this.points - 1;
    const step = event.shiftKey ? Math.max(1, Math.round(last / 50)) : 1;
    if (event.key === "ArrowRight") this.index = Math.min(last, this.index + step);
    else if (event.key === "ArrowLeft") this.index = Math.max(0, this.index - step);
    else if (event.key === "Home") this.index = 0;
    else if (event.key === "End") this.index = last;
    else if (event.key === "Escape") this.reset();
    else return;
    event.preventDefault();
    chart.setCursor({ left: chart.valToPos(this.data[0][this.index]!, "x"), top: 0 });
  }

  csv(): string {
    const names = ["time", ...this.group.columns.map((c) => this.table.names[c]!)];
    const rows = Array.from({ length: this.points }, (_, i) => this.data.map((column) => column[i]).join(","));
    return [names.join(","), ...rows].join("\n") + "\n";
  }

  /** The curves with their title and names, on the page's ground. */
  private png(): void {
    const source = this.chart?.ctx.canvas;
    if (!source) return;
    const ratio = devicePixelRatio || 1;
    const canvas = make("canvas", { width: String(source.width), height: String(source.height + 50 * ratio) });
    const context = canvas.getContext("2d")!;
    context.fillStyle = style("--paper");
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(source, 0, 25 * ratio);
    context.font = `${13 * ratio}px system-ui, sans-serif`;
    context.fillStyle = style("--ink");
    context.fillText(`${this.group.name}${this.group.unit ? ` in ${this.group.unit}` : ""}`, 8 * ratio, 17 * ratio);
    let x = 8 * ratio;
    this.chart!.series.slice(1).forEach((series, i) => {
      if (!series.show) return;
      context.fillStyle = COLOURS[i % COLOURS.length]!;
      const text = this.labels[i]!;
      context.fillText(text, x, canvas.height - 8 * ratio);
      x += context.measureText(text).width + 14 * ratio;
    });
    canvas.toBlob((blob) => blob && save(`${this.group.name}.png`, blob));
  }
}

/** Draws each when it comes into sight, all before they are printed, and all anew when the page changes its
 * colours or its width. */
export function watch(plots: Plot[]): void {
  const drawn = new Set<Plot>();
  const draw = (plot: Plot) => {
    drawn.add(plot);
    plot.draw();
  };
  const seen = new IntersectionObserver(
    (entries) => {
      for (const entry of entries) {
        const plot = plots.find((p) => p.element === entry.target)!;
        if (entry.isIntersecting && !drawn.has(plot)) draw(plot);
      }
    },
    { rootMargin: "400px" },
  );
  plots.forEach((plot) => seen.observe(plot.element));
  const again = () => drawn.forEach((plot) => plot.draw());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth !== width) again();
    width = innerWidth;
  });
  addEventListener("beforeprint", () => plots.forEach(draw));
  addEventListener("afterprint", again);
}
