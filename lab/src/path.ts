// The path of equilibria: the load factor over a displacement, with the states where stability is lost.
import { tag } from "./curves";
import { array, type Stored } from "./data";
import type { Reply } from "./engine";
import { stated } from "./table";
import { labels, text, ticks } from "./text";

/** A path with its columns. */
interface Path {
  columns: { name: string; unit: string; values: Float64Array }[];
  factors: Float64Array;
  unstable: Float64Array;
  /** Numbers of the points where stability changes, and what they are. */
  critical: { index: number; name: string }[];
}

/** The path in a reply: its principal columns. */
function found({ results, columns, summary }: Reply): Path {
  const { curves } = results as { curves: Record<string, Stored> };
  const factors = array(curves, "load_factor")!;
  const critical = (summary?.critical ?? []) as { "load-factor": number; critical: string }[];
  const principal = (columns ?? []).filter(({ role }) => role === "primary");
  return {
    columns: principal.slice(0, 6).map(({ name, unit }) => ({ name, unit, values: array(curves, name)! })),
    factors,
    unstable: array(curves, "unstable") ?? new Float64Array(factors.length),
    critical: critical.map((state) => ({ index: factors.indexOf(state["load-factor"]), name: state.critical })).filter(({ index }) => index >= 0),
  };
}

const [WIDTH, HEIGHT, LEFT, ABOVE, BELOW] = [360, 270, 56, 22, 38];
const SVG = "http://www.w3.org/2000/svg";

function shape(name: string, attributes: Record<string, string | number>, words = ""): SVGElement {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  made.textContent = words;
  return made;
}

/** Diagrams of the principal columns, unstable parts dashed, and the values at the end. */
export function path(reply: Reply): HTMLElement {
  const of = found(reply);
  // What does not move, but for rounding, says nothing.
  const size = (values: Float64Array) => Math.max(...values.map(Math.abs));
  const moving = of.columns.filter(({ values }) => Math.max(...values) - Math.min(...values) > 1e-12 * size(values));
  const drawn = moving.slice(0, 4).map((column) => one(column, of));
  const listed = of.critical.map(({ index, name }) => tag("li", {}, `${name} at load factor ${text(of.factors[index], 6)}`));
  const note = "The load factor multiplies all loads. Dashed: the equilibrium is not stable.";
  return tag("div", { class: "paths" }, tag("div", { class: "figures" }, ...drawn), tag("ul", {}, ...listed), tag("p", { class: "caption" }, note), last(reply));
}

/** Values of the last equilibrium with their errors. */
function last({ summary }: Reply): HTMLElement {
  const of = summary?.last as { columns: Record<string, number>; error: Record<string, number> | null; stability: string } | undefined;
  const rows = Object.entries(of?.columns ?? {}).map(([name, value]) =>
    tag("tr", {}, tag("th", { scope: "row" }, name), tag("td", {}, stated(value, of?.error?.[name]))),
  );
  const head = tag("tr", {}, tag("th", { scope: "col" }, "quantity"), tag("th", { scope: "col" }, `last equilibrium${of?.stability ? `, ${of.stability}` : ""}`));
  return tag("table", { class: "values" }, tag("thead", {}, head), tag("tbody", {}, ...rows));
}

function one({ name, unit, values: across }: Path["columns"][number], { factors, unstable, critical }: Path): HTMLElement {
  const range = (of: Float64Array): [number, number] => {
    const [low, high] = [Math.min(...of), Math.max(...of)];
    const room = high > low ? 0.05 * (high - low) : Math.abs(high) || 1;
    return [low - room, high + room];
  };
  const [[x0, x1], [y0, y1]] = [range(across), range(factors)];
  const x = (value: number) => LEFT + ((WIDTH - LEFT - 8) * (value - x0)) / (x1 - x0);
  const y = (value: number) => HEIGHT - BELOW - ((HEIGHT - BELOW - ABOVE) * (value - y0)) / (y1 - y0);
  const label = `Load factor over ${name}`;
  const svg = shape("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": label, class: "path" });
  const below = labels(ticks(x0, x1));
  for (const [k, value] of ticks(x0, x1).entries()) {
    svg.append(shape("line", { x1: x(value), x2: x(value), y1: ABOVE, y2: HEIGHT - BELOW, class: "grid" }));
    svg.append(shape("text", { x: x(value), y: HEIGHT - BELOW + 14, "text-anchor": "middle" }, below[k]));
  }
  for (const value of ticks(y0, y1)) {
    svg.append(shape("line", { x1: LEFT, x2: WIDTH - 8, y1: y(value), y2: y(value), class: "grid" }));
    svg.append(shape("text", { x: LEFT - 5, y: y(value) + 4, "text-anchor": "end" }, text(value, 3)));
  }
  svg.append(shape("text", { x: (LEFT + WIDTH) / 2, y: HEIGHT - 6, "text-anchor": "middle", class: "name" }, unit ? `${name} [${unit}]` : name));
  svg.append(shape("text", { x: 4, y: 12, class: "name" }, "load factor"));
  // Pieces of one stability each.
  const stable = (k: number) => !(unstable[k] > 0);
  for (let from = 0; from + 1 < factors.length; ) {
    let to = from + 1;
    while (to + 1 < factors.length && stable(to + 1) === stable(from + 1)) to++;
    const points = Array.from({ length: to - from + 1 }, (_, k) => `${x(across[from + k]).toFixed(2)},${y(factors[from + k]).toFixed(2)}`);
    svg.append(shape("polyline", { points: points.join(" "), class: stable(from + 1) ? "stable" : "unstable" }));
    from = to;
  }
  for (const { index } of critical) {
    svg.append(shape("circle", { cx: x(across[index]), cy: y(factors[index]), r: 4, class: "critical" }));
  }
  svg.append(shape("circle", { cx: x(across.at(-1)!), cy: y(factors.at(-1)!), r: 3, class: "last" }));
  return tag("figure", {}, svg);
}
