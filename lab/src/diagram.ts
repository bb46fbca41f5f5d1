// The Campbell diagram: frequencies over the speed of rotation; a click chooses the speed.
import uPlot from "uplot";
import { styled } from "./colours";
import { axis, plain, sized, tag, wide } from "./curves";
import { array, type Stored } from "./data";
import type { Reply } from "./engine";
import type { Room } from "./room";
import { inRadians, text } from "./text";

export interface Campbell {
  unit: string;
  "speed-unit": string;
  speeds: Float64Array;
  modes: { frequency: Float64Array; moves: string }[];
}

/** The diagram in a reply. */
export function campbell({ results, summary, moves }: Reply): Campbell {
  const { curves } = results as { curves: Record<string, Stored> };
  const names = Object.keys(curves).filter((name) => /^mode\d+\.frequency$/.test(name));
  names.sort((a, b) => Number.parseInt(a.slice(4)) - Number.parseInt(b.slice(4)));
  return {
    unit: String(summary?.unit ?? ""),
    "speed-unit": String(summary?.["speed-unit"] ?? ""),
    speeds: array(curves, "speed")!,
    modes: names.map((name, k) => ({ frequency: array(curves, name)!, moves: moves?.[k] ?? "" })),
  };
}

const HEIGHT = 300;

/** Draws the diagram, with a line at a speed, if that is known. */
export function diagram(found: Campbell, room: Room, speed: number | undefined, choose: (speed: number) => void): HTMLElement {
  const { speeds } = found;
  const frequencies = found.modes.map(({ frequency }) => frequency);
  const top = (of: Float64Array) => Math.max(0, ...of.filter(Number.isFinite));
  const whole = 1.05 * Math.max(...frequencies.map(top), 1e-12);
  // A speed in its unit as a frequency in its own.
  const factor = inRadians(found["speed-unit"]) / inRadians(found.unit);
  const rays = [1, 2, 3, 4];
  // The lines kΩ and the two lowest modes are seen first, the others by a button.
  const lower = 1.15 * Math.max(4 * factor * speeds[speeds.length - 1], ...frequencies.slice(0, 2).map(top));
  let most = lower < 0.8 * whole ? lower : whole;
  const node = tag("div", { class: "campbell" });
  const line = tag("div", { class: "cursor" });
  const colour = (k: number) => styled(`curve${k % 6}`);
  const options: uPlot.Options = {
    ...plain(),
    height: HEIGHT,
    scales: { x: { time: false }, y: { range: () => [0, most] } },
    axes: [
      { ...axis(), size: 34, label: `speed [${found["speed-unit"]}]`, labelSize: 14, labelFont: "11px system-ui, sans-serif" },
      { ...axis(), size: wide(58), space: 28, label: `frequency [${found.unit}]`, labelSize: 14, labelFont: "11px system-ui, sans-serif" },
    ],
    series: [
      {},
      ...rays.map((): uPlot.Series => ({ stroke: () => styled("faint"), width: 1, pxAlign: 0, dash: [4, 4], points: { show: false } })),
      ...frequencies.map((_, k): uPlot.Series => ({ stroke: () => colour(k), width: 1.75, pxAlign: 0, points: { show: false } })),
    ],
    hooks: { draw: [(plot) => labels(plot)] },
  };
  const data = [
    Array.from(speeds),
    ...rays.map((k) => Array.from(speeds, (x) => k * factor * x)),
    ...frequencies.map((of) => Array.from(of, (y) => (Number.isFinite(y) ? y : null))),
  ];

  /** Names of the lines kΩ and numbers of the modes at their right ends: colours alone tell nobody. */
  function labels(plot: uPlot) {
    const { ctx } = plot;
    ctx.save();
    ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.textAlign = "right";
    const write = (values: (number | null)[], name: string, ink: string, share = 1) => {
      const last = Math.round(share * values.findLastIndex((y) => y !== null && y <= most));
      if (last < 1) return;
      ctx.fillStyle = ink;
      const [x, y] = [plot.valToPos(speeds[last], "x", true), plot.valToPos(values[last]!, "y", true)];
      ctx.fillText(name, x - 3 * devicePixelRatio, Math.max(y - 4 * devicePixelRatio, plot.bbox.top + 10 * devicePixelRatio));
    };
    rays.forEach((k, i) => write(data[1 + i], `${k}Ω`, styled("dim"), 0.7));
    found.modes.forEach(({ moves }, k) => write(data[1 + rays.length + k], `${k + 1} ${moves}`, colour(k)));
    ctx.restore();
  }

  const every = tag("button", { type: "button", "aria-pressed": "false" }, `All ${frequencies.length} modes`);
  every.hidden = most === whole;
  every.addEventListener("click", () => {
    most = most === whole ? lower : whole;
    every.setAttribute("aria-pressed", String(most === whole));
    plot.redraw(true, true);
  });
  const plot = new uPlot(options, data as uPlot.AlignedData, node);
  room.signal.addEventListener("abort", () => plot.destroy());
  const { over } = plot;
  over.append(line);
  over.classList.add("seekable");
  over.tabIndex = 0;
  over.setAttribute("role", "slider");
  over.setAttribute("aria-label", `Speed of rotation [${found["speed-unit"]}]`);
  const [low, high] = [speeds[0], speeds[speeds.length - 1]];
  const limit = (x: number) => Math.min(Math.max(x, low), high);
  const mark = (x: number) => {
    line.style.transform = `translateX(${plot.valToPos(limit(x), "x")}px)`;
    for (const [name, value] of Object.entries({ valuemin: low, valuemax: high, valuenow: limit(x) })) {
      over.setAttribute(`aria-${name}`, String(value));
    }
    over.setAttribute("aria-valuetext", `${text(limit(x), 3)} ${found["speed-unit"]}`);
  };
  over.addEventListener("click", (event) => {
    const x = limit(plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
    mark(x);
    choose(Number(x.toPrecision(3)));
  });
  over.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    const x = limit((speed ?? low) + (by * (high - low)) / 50);
    mark(x);
    choose(Number(x.toPrecision(3)));
  });
  sized(node, plot, HEIGHT, room.signal);
  line.hidden = speed === undefined;
  new ResizeObserver(() => mark(speed ?? low)).observe(over);
  const about = `Click in the diagram to see the modes at that speed. Dashed lines kΩ: where a curve crosses one, k impulses a revolution excite that mode.`;
  return tag("div", {}, node, every, tag("p", { class: "caption" }, about));
}
