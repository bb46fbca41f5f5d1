// Curves over time or along the beam, with a cursor.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { recoloured, styled } from "./colours";
import type { Room } from "./room";
import { labels, steady, text, ticks } from "./text";

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
  // uPlot's own range is empty where values differ by less than 1e-6.
  const margin = 0.1 * (high - low);
  if (high - low > 1e-7 * size && size > 1e-290) {
    return [low >= 0 ? Math.max(low - margin, 0) : low - margin, high <= 0 ? Math.min(high + margin, 0) : high + margin];
  }
  const middle = (low + high) / 2;
  const about = 1e-3 * Math.abs(middle) || 1;
  return [middle - about, middle + about];
}

const FONT = "11px system-ui, sans-serif";

export const axis = (): uPlot.Axis => ({
  stroke: () => styled("dim"),
  grid: { stroke: () => styled("grid"), width: 1 },
  ticks: { show: false },
  font: FONT,
  gap: 4,
  // uPlot's own never end where steps are smaller than 1e-16.
  splits: (plot, i, low, high) => ticks(low, high, Math.max(i === 0 ? plot.width / 55 : plot.height / 24, 2)),
  values: (_, splits) => labels(splits),
});

const measure = document.createElement("canvas").getContext("2d")!;

/** The width of an axis: so much, or what its longest label takes. */
export const wide = (least: number) => (_: uPlot, values: string[] | null) => {
  measure.font = FONT;
  return Math.max(least, 14 + Math.max(0, ...(values ?? []).map((value) => measure.measureText(value ?? "").width)));
};

/** Keeps a plot as wide as its node, and in the colours of the page. */
export function sized(node: HTMLElement, plot: uPlot, height: number, signal: AbortSignal) {
  const observer = new ResizeObserver(() => {
    const width = node.clientWidth;
    if (width > 0) plot.setSize({ width, height });
  });
  observer.observe(node);
  signal.addEventListener("abort", () => observer.disconnect());
  recoloured(() => plot.redraw(false), signal);
}

/** Shades what lies behind the time until which a run is trusted. */
function shade(plot: uPlot, trusted: number) {
  const { left, top, width, height } = plot.bbox;
  const from = Math.max(plot.valToPos(trusted, "x", true), left);
  if (!(from < left + width)) return;
  plot.ctx.fillStyle = styled("doubt");
  plot.ctx.fillRect(from, top, left + width - from, height);
}

/** Values and edges of bands of curves, in the order of the series. */
function lists(x: Float64Array, curves: Curve[]): uPlot.AlignedData {
  const numbers = (values: Float64Array) => Array.from(values, (y) => (Number.isFinite(y) ? y : null));
  const series = curves.flatMap(({ values, error, other }) => {
    const edges = error ? [1, -1].map((sign) => values.map((y, k) => y + sign * error[k])) : [];
    return [...edges, ...(other ? [other] : []), values];
  });
  return [Array.from(x), ...series.map(numbers)];
}

/** Whether curves are drawn with the same lines and bands. */
const alike = (one: Curve[], other: Curve[]) =>
  one.length === other.length &&
  one.every(({ name, unit, error, other: beside }, i) => {
    const next = other[i];
    return name === next.name && unit === next.unit && !error === !next.error && !beside === !next.other;
  });

/** One or several curves over a common abscissa. */
export class Panel {
  readonly node: HTMLElement;
  private readonly plot: uPlot;
  private readonly line = tag("div", { class: "cursor" });
  private readonly values: HTMLOutputElement[];
  private readonly ending = new AbortController();

  constructor(
    { signal }: Room,
    private x: Float64Array,
    private curves: Curve[],
    seek: ((x: number) => void) | undefined,
    private trusted = Infinity,
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
        { ...axis(), size: wide(62), space: 28 },
      ],
      series: [{}],
      bands: [],
      hooks: { drawClear: [(plot) => shade(plot, this.trusted)] },
    };
    const add = (series: uPlot.Series) => options.series.push({ width: 1.5, pxAlign: 0, points: { show: false }, ...series });
    curves.forEach(({ error, other }, i) => {
      if (error) {
        for (let edge = 0; edge < 2; edge++) add({ width: 0, stroke: "transparent" });
        const last = options.series.length - 1;
        options.bands!.push({ series: [last - 1, last], fill: () => `color-mix(in srgb, ${styled(`curve${i}`)} 30%, transparent)` });
      }
      if (other) add({ stroke: () => styled(`curve${i + 1}`), dash: [6, 4] });
      add({ stroke: () => styled(`curve${i}`) });
    });
    this.plot = new uPlot(options, lists(x, curves), this.node);
    signal.addEventListener("abort", () => this.ending.abort());
    this.ending.signal.addEventListener("abort", () => this.plot.destroy());
    sized(this.node, this.plot, HEIGHT, this.ending.signal);
    if (seek) this.seekable(seek);
  }

  /** Takes it away. */
  end() {
    this.ending.abort();
  }

  /** Draws other curves in the place of these, if they have the same lines and bands. */
  take(x: Float64Array, curves: Curve[], trusted = Infinity): boolean {
    if (!alike(this.curves, curves)) return false;
    [this.x, this.curves, this.trusted] = [x, curves, trusted];
    this.plot.setData(lists(x, curves));
    return true;
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
    private times: Float64Array,
    private columns: (Curve & { shown: boolean })[],
    private trusted: number | undefined,
    private readonly seek: (time: number) => void,
  ) {
    this.time = times[0];
    const boxes = columns.map((column, i) => {
      const box = tag("input", { type: "checkbox" });
      box.checked = column.shown;
      box.addEventListener("change", () => {
        this.columns[i].shown = box.checked;
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

  /** Draws columns of the same names in the place of these; whether they are. */
  take(times: Float64Array, columns: (Curve & { shown: boolean })[], trusted: number | undefined): boolean {
    const named = (list: Curve[]) => list.map(({ name, unit }) => `${name} ${unit}`).join("\n");
    if (named(columns) !== named(this.columns)) return false;
    [this.times, this.columns, this.trusted] = [times, columns, trusted];
    for (const column of columns) {
      const panel = this.panels.get(column.name);
      if (!panel || (column.shown && panel.take(times, [column], trusted))) continue;
      panel.end();
      this.panels.delete(column.name);
    }
    this.arrange();
    return true;
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
    const nodes = shown.map(({ name }) => this.panels.get(name)!.node);
    if (nodes.length !== this.nodes.childElementCount || nodes.some((node, i) => node !== this.nodes.children[i])) this.nodes.replaceChildren(...nodes);
    this.show(this.time);
  }
}
