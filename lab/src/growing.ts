// Curves of a run that is not done yet.
import uPlot from "uplot";
import { styled } from "./colours";
import { axis, plain, tag, wide } from "./curves";
import { array, type Stored } from "./data";

/** Columns that are drawn. */
const MOST = 3;
const HEIGHT = 96;
/** Points of a curve: of more, every second is left out. */
const POINTS = 1000;
/** Time between two pictures [ms]. */
const PAUSE = 150;
/** A run that takes less is not drawn while it grows [ms]. */
const SOON = 700;

export class Growing {
  private readonly data = new Map<string, number[]>();
  private plots = new Map<string, uPlot>();
  private since = 0;
  private drawn = 0;
  /** Rows between two that are kept, and the number of the next row. */
  private every = 1;
  private row = 0;

  constructor(private readonly into: HTMLElement) {}

  /** Another run begins, or none. */
  clear() {
    for (const plot of this.plots.values()) plot.destroy();
    this.plots.clear();
    this.data.clear();
    this.into.replaceChildren();
    this.into.hidden = true;
    this.since = performance.now();
    [this.every, this.row] = [1, 0];
  }

  /** Adds rows of a run that ends at a time. */
  add(rows: Record<string, Stored>, end: number) {
    const names = Object.keys(rows).slice(0, MOST + 1);
    const columns = names.map((name) => array(rows, name)!);
    for (let i = 0; i < columns[0].length; i++, this.row++) {
      if (this.row % this.every !== 0) continue;
      names.forEach((name, k) => {
        if (!this.data.has(name)) this.data.set(name, []);
        this.data.get(name)!.push(columns[k][i]);
      });
      if (this.data.get(names[0])!.length < POINTS) continue;
      this.every *= 2;
      for (const [name, values] of this.data) this.data.set(name, values.filter((_, k) => k % 2 === 0));
    }
    const now = performance.now();
    if (now - this.since < SOON || now - this.drawn < PAUSE) return;
    this.drawn = now;
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
        { ...axis(), size: wide(62) },
      ],
      series: [{}, { stroke: () => styled("curve0"), width: 1.5, pxAlign: 0, points: { show: false } }],
    };
    options.scales!.x!.range = [0, end];
    const made = new uPlot(options, [[], []], node);
    this.plots.set(name, made);
    return made;
  }
}
