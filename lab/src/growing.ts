// Curves of a run that is not done yet.
import uPlot from "uplot";
import { axis, plain, styled, tag } from "./curves";
import { array, type Stored } from "./data";

/** Columns that are drawn. */
const MOST = 3;
const HEIGHT = 96;
/** A run that takes less is not drawn while it grows [ms]. */
const SOON = 700;

export class Growing {
  private readonly data = new Map<string, number[]>();
  private plots = new Map<string, uPlot>();
  private since = 0;

  constructor(private readonly into: HTMLElement) {}

  /** Another run begins, or none. */
  clear() {
    for (const plot of this.plots.values()) plot.destroy();
    this.plots.clear();
    this.data.clear();
    this.into.replaceChildren();
    this.into.hidden = true;
    this.since = performance.now();
  }

  /** Adds rows of a run that ends at a time. */
  add(rows: Record<string, Stored>, end: number) {
    for (const name of Object.keys(rows).slice(0, MOST + 1)) {
      const values = this.data.get(name) ?? [];
      for (const value of array(rows, name)!) values.push(value);
      this.data.set(name, values);
    }
    if (performance.now() - this.since < SOON) return;
    this.into.hidden = false;
    const times = this.data.get("time") ?? [];
    for (const [name, values] of this.data) {
      if (name === "time") continue;
      const plot = this.plots.get(name) ?? this.plot(name, end);
      plot.setData([times, values.slice(0, times.length)]);
    }
  }

  private plot(name: string, end: number): uPlot {
    const node = tag("div", { class: "panel" }, tag("p", {}, tag("b", {}, name)));
    this.into.append(node);
    const options: uPlot.Options = {
      ...plain(),
      width: Math.max(node.clientWidth, 120),
      height: HEIGHT,
      axes: [
        { ...axis(), size: 22 },
        { ...axis(), size: 62 },
      ],
      series: [{}, { stroke: () => styled("curve0"), width: 1.5, pxAlign: 0, points: { show: false } }],
    };
    options.scales!.x!.range = [0, end];
    const made = new uPlot(options, [[], []], node);
    this.plots.set(name, made);
    return made;
  }
}
