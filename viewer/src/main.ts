// The script of moldwarp's report.

import { about, history } from "./data";
import { make } from "./dom";
import { groups, parse, Plot, watch } from "./plots";
import { View } from "./view";
import uplotStyle from "uplot/dist/uPlot.min.css";

/** For tests, and for whoever wants to look closer with the browser's console. */
interface Handle {
  plots: Plot[];
  view: View | null;
  ready: boolean;
}

declare global {
  interface Window {
    moldwarp: Handle;
  }
}

const nonce = (document.currentScript as HTMLScriptElement | null)?.nonce ?? "";

async function start(): Promise<void> {
  const handle: Handle = { plots: [], view: null, ready: false };
  window.moldwarp = handle;
  const run = about();
  const uplot = make("style", {}, uplotStyle);
  uplot.nonce = nonce;
  // Before the page's own style, which has the last word.
  document.head.prepend(uplot);

  const place = document.getElementById("viewer");
  if (place && run.pictures) {
    try {
      handle.view = await View.open(place, run, run.pictures);
    } catch (error) {
      place.replaceChildren(
        make("p", { class: "left-out" }, `The 3D view cannot be shown: ${(error as Error).message}. `,
          "Turn on hardware acceleration, or open the report in another browser."),
      );
    }
  }

  const ground = document.getElementById("plots")!;
  const table = parse(await history());
  if (table.names.includes("time") && table.columns[0]!.length) {
    handle.plots = groups(table.names, run.units).map((g) => new Plot(table, g, () => handle.view?.time ?? null));
    ground.replaceChildren(...handle.plots.map((p) => p.element));
    watch(handle.plots);
    if (handle.view) handle.view.changed = () => handle.plots.forEach((p) => p.redraw());
  } else {
    ground.replaceChildren(
      make("p", {}, "The run has no history. It is written with history or history_interval in the scene's [output]."),
    );
  }

  for (const button of document.querySelectorAll<HTMLButtonElement>("button.show")) {
    button.addEventListener("click", () => show(handle, JSON.parse(button.dataset["show"]!)));
  }
  handle.ready = true;
}

interface What {
  plot?: string;
  field?: string;
  part?: number;
  frame?: number;
  id?: number;
}

/** What the button of an answer asks for. */
function show(handle: Handle, what: What): void {
  if (what.plot) {
    const plot = handle.plots.find((p) => p.group.name === what.plot);
    plot?.element.scrollIntoView({ block: "center" });
    plot?.element.querySelector<HTMLElement>(".ground")?.focus({ preventScroll: true });
  } else if (handle.view && what.field !== undefined) {
    document.getElementById("viewer")!.scrollIntoView({ block: "start" });
    void handle.view.show(`${what.field}/${what.part ?? 0}`, what.frame ?? null, what.id ?? null);
  }
}

void start();
