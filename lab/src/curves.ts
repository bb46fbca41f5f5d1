// Curves over time or along the beam, with a cursor.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Room } from "./room";
import { steady, text, ticks } from "./text";

export interface Curve {
  name: string;
  unit: string;
  values: Float64Array;
  /** Half the width of the band of its error. */
  error?: Float64Array;
  /** The same quantity of the run that it is compared with. */
  other?: Float64Array;
}

/** Height of a plot [px]. */
const HEIGHT = 120;

export const styled = (name: string) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

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

/** What all plots have. */
export const plain = () => ({
  width: 300,
  padding: [6, 18, 0, 0] as uPlot.Padding,
  cursor: { show: false },
  legend: { show: false },
  scales: { x: { time: false }, y: { range: ranged } },
});

/** A range about values; what differs by rounding alone is drawn as a straight line. */
function ranged(_: uPlot, low: number | null, high: number | null): [number, number] {
  if (low === null || high === null) return [0, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  if (high - low > 1e-7 * size && size > 1e-290) return uPlot.rangeNum(low, high, 0.1, true) as [number, number];
  const middle = (low + high) / 2;
  const about = 1e-3 * Math.abs(middle) || 1;
  return [middle - about, middle + about];
}

export const axis = (): uPlot.Axis => ({
  stroke: () => styled("dim"),
  grid: { stroke: () => styled("grid"), width: 1 },
  ticks: { show: false },
  font: "11px system-ui, sans-serif",
  gap: 4,
  // uPlot's own never end where steps are smaller than 1e-16.
  splits: (plot, i, low, high) => ticks(low, high, Math.max(i === 0 ? plot.width / 55 : plot.height / 24, 2)),
  values: (_, splits) => splits.map((value) => text(value, 6)),
});

/** Keeps a plot as wide as its node, and in the colours of the page. */
export function sized(node: HTMLElement, plot: uPlot, height: number, signal: AbortSignal) {
  const observer = new ResizeObserver(() => {
    const width = node.clientWidth;
    if (width > 0) plot.setSize({ width, height });
  });
  observer.observe(node);
  signal.addEventListener("abort", () => observer.disconnect());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => plot.redraw(false), { signal });
}

/** Shades what lies behind the time until which a run is trusted. */
function shade(plot: uPlot, trusted: number) {
  const { left, top, width, height } = plot.bbox;
  const from = Math.max(plot.valToPos(trusted, "x", true), left);
  if (!(from < left + width)) return;
  plot.ctx.fillStyle = styled("doubt");
  plot.ctx.fillRect(from, top, left + width - from, height);
}

/** One or several curves over a common abscissa. */
export class Panel {
  readonly node: HTMLElement;
  private readonly plot: uPlot;
  private readonly line = tag("div", { class: "cursor" });
  private readonly values: HTMLOutputElement[];

  constructor(
    { signal }: Room,
    private readonly x: Float64Array,
    private readonly curves: Curve[],
    seek: ((x: number) => void) | undefined,
    trusted = Infinity,
  ) {
    this.values = curves.map(() => tag("output", { "aria-live": "off" }));
    const head = curves.map((curve, i) => {
      const unit = curve.unit ? tag("span", { class: "unit" }, curve.unit) : "";
      const parts = seek ? [this.values[i], " ", unit] : [unit];
      return tag("span", { class: `curve curve${i}` }, tag("b", {}, curve.name), " ", ...parts);
    });
    this.node = tag("div", { class: "panel" }, tag("p", {}, ...head));
    const options: uPlot.Options = {
      ...plain(),
      height: HEIGHT,
      axes: [
        { ...axis(), size: 22 },
        { ...axis(), size: 62, space: 28 },
      ],
      series: [{}],
      bands: [],
      hooks: { drawClear: [(plot) => shade(plot, trusted)] },
    };
    const data: (number | null)[][] = [Array.from(x)];
    const add = (values: Float64Array, series: uPlot.Series) => {
      data.push(Array.from(values, (y) => (Number.isFinite(y) ? y : null)));
      options.series.push({ width: 1.5, pxAlign: 0, points: { show: false }, ...series });
    };
    curves.forEach(({ values, error, other }, i) => {
      if (error) {
        const edge = (sign: number) => values.map((y, k) => y + sign * error[k]);
        for (const sign of [1, -1]) add(edge(sign), { width: 0, stroke: "transparent" });
        const last = options.series.length - 1;
        options.bands!.push({ series: [last - 1, last], fill: () => `color-mix(in srgb, ${styled(`curve${i}`)} 30%, transparent)` });
      }
      if (other) add(other, { stroke: () => styled(`curve${i + 1}`), dash: [6, 4] });
      add(values, { stroke: () => styled(`curve${i}`) });
    });
    this.plot = new uPlot(options, data as uPlot.AlignedData, this.node);
    signal.addEventListener("abort", () => this.plot.destroy());
    sized(this.node, this.plot, HEIGHT, signal);
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
    this.curves.forEach(({ values, error }, i) => {
      const at = (of: Float64Array) => steady(of[low] + share * (of[high] - of[low]));
      this.values[i].value = error && Number.isFinite(error[high]) && error[high] > 0 ? `${at(values)} ± ${text(error[high], 1)}` : at(values);
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
  private readonly nodes = tag("div", { class: "panels" });
  private time: number;

  constructor(
    private readonly room: Room,
    private readonly times: Float64Array,
    private readonly columns: (Curve & { shown: boolean })[],
    private readonly trusted: number | undefined,
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
    room.curves.append(chooser, this.nodes, tag("p", { class: "abscissa" }, "time [s]"));
    this.arrange();
  }

  /** Names of those that are shown. */
  get shown(): string[] {
    return this.columns.flatMap(({ name, shown }) => (shown ? [name] : []));
  }

  show(time: number) {
    this.time = time;
    for (const { name, shown } of this.columns) if (shown) this.panels.get(name)?.show(time);
  }

  private arrange() {
    const shown = this.columns.filter((column) => column.shown);
    for (const column of shown) {
      if (this.panels.has(column.name)) continue;
      this.panels.set(column.name, new Panel(this.room, this.times, [column], this.seek, this.trusted));
    }
    this.nodes.replaceChildren(...shown.map(({ name }) => this.panels.get(name)!.node));
    this.show(this.time);
  }
}
