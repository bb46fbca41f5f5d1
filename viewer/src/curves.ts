// Curves over time or along the beam, with a cursor.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { steady, text } from "./text";

export interface Curve {
  name: string;
  unit: string;
  values: Float64Array;
}

/** Height of a plot [px]. */
const HEIGHT = 120;

const styled = (name: string) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** A tag with attributes and content. */
export function tag<K extends keyof HTMLElementTagNameMap>(
  name: K,
  attributes: Record<string, string> = {},
  ...content: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...content);
  return made;
}

/** One or several curves over a common abscissa. */
export class Panel {
  readonly node: HTMLElement;
  private readonly plot: uPlot;
  private readonly line = tag("div", { class: "cursor" });
  private readonly values: HTMLOutputElement[];

  constructor(
    private readonly x: Float64Array,
    private readonly curves: Curve[],
    seek: ((x: number) => void) | undefined,
  ) {
    this.values = curves.map(() => tag("output", { "aria-live": "off" }));
    const head = curves.map((curve, i) => {
      const unit = curve.unit ? tag("span", { class: "unit" }, curve.unit) : "";
      const parts = seek ? [this.values[i], " ", unit] : [unit];
      return tag("span", { class: `curve curve${i}` }, tag("b", {}, curve.name), " ", ...parts);
    });
    this.node = tag("div", { class: "panel" }, tag("p", {}, ...head));
    const axis = (): uPlot.Axis => ({
      stroke: () => styled("dim"),
      grid: { stroke: () => styled("grid"), width: 1 },
      ticks: { show: false },
      font: "11px system-ui, sans-serif",
      gap: 4,
      values: (_, splits) => splits.map((value) => text(value, 6)),
    });
    const options: uPlot.Options = {
      width: 300,
      height: HEIGHT,
      padding: [6, 18, 0, 0],
      cursor: { show: false },
      legend: { show: false },
      scales: { x: { time: false } },
      axes: [
        { ...axis(), size: 22 },
        { ...axis(), size: 62, space: 28 },
      ],
      series: [
        {},
        ...curves.map((_, i) => ({ stroke: () => styled(`curve${i}`), width: 1.5, pxAlign: 0, points: { show: false } })),
      ],
    };
    const finite = (values: Float64Array) => Array.from(values, (y) => (Number.isFinite(y) ? y : null));
    const data = [Array.from(x), ...curves.map((curve) => finite(curve.values))] as uPlot.AlignedData;
    this.plot = new uPlot(options, data, this.node);
    new ResizeObserver(() => {
      const width = this.node.clientWidth;
      if (width > 0) this.plot.setSize({ width, height: HEIGHT });
    }).observe(this.node);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.plot.redraw(false));
    if (seek) this.seekable(seek);
  }

  /** Moves the cursor. */
  show(x: number) {
    const left = this.plot.valToPos(x, "x");
    this.line.style.transform = `translateX(${left}px)`;
    let [low, high] = [0, this.x.length - 1];
    while (low + 1 < high) {
      const middle = (low + high) >> 1;
      if (this.x[middle] <= x) low = middle;
      else high = middle;
    }
    const width = this.x[high] - this.x[low];
    const share = width > 0 ? Math.min(Math.max((x - this.x[low]) / width, 0), 1) : 0;
    this.curves.forEach(({ values }, i) => {
      this.values[i].value = steady(values[low] + share * (values[high] - values[low]));
    });
  }

  private seekable(seek: (x: number) => void) {
    const { over } = this.plot;
    over.append(this.line);
    over.classList.add("seekable");
    const to = (event: PointerEvent) => seek(this.plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      to(event);
    });
    over.addEventListener("pointermove", (event) => {
      if (over.hasPointerCapture(event.pointerId)) to(event);
    });
  }
}

/** Columns over time: one panel each, and which of them are shown. */
export class Columns {
  private readonly panels = new Map<string, Panel>();
  private time: number;

  constructor(
    private readonly into: HTMLElement,
    private readonly times: Float64Array,
    private readonly columns: (Curve & { shown: boolean })[],
    private readonly seek: (time: number) => void,
  ) {
    this.time = times[0];
    const boxes = columns.map((column) => {
      const box = tag("input", { type: "checkbox" });
      box.checked = column.shown;
      box.addEventListener("change", () => {
        column.shown = box.checked;
        this.arrange();
      });
      return tag("label", {}, box, column.name, " ", tag("span", { class: "unit" }, column.unit));
    });
    const chooser = tag("details", {}, tag("summary", {}, "Columns"), tag("div", { class: "columns" }, ...boxes));
    into.append(chooser, tag("div", { class: "panels" }), tag("p", { class: "abscissa" }, "time [s]"));
    this.arrange();
  }

  show(time: number) {
    this.time = time;
    for (const { name, shown } of this.columns) if (shown) this.panels.get(name)?.show(time);
  }

  private arrange() {
    const shown = this.columns.filter((column) => column.shown);
    for (const column of shown) {
      if (this.panels.has(column.name)) continue;
      this.panels.set(column.name, new Panel(this.times, [column], this.seek));
    }
    this.into.querySelector(".panels")!.replaceChildren(...shown.map(({ name }) => this.panels.get(name)!.node));
    this.show(this.time);
  }
}
