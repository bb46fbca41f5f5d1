// A run in motion.
import { Vector3 } from "three";
import { numbers, type read } from "./data";
import { Columns } from "./curves";
import { Player } from "./player";
import { extent, instant, largest, pose, scene, sections, type Instant, type Part, type Section } from "./scene";
import { Stage, type View } from "./stage";
import { nice, steady, text } from "./text";
import { button, choice, toggle } from "./tools";

/** Pieces of the beam between neighbouring stations. */
const PIECES = 3;
/** Angle of rotation [rad] that a piece of the path of the tip covers. */
const TURN = 0.1;
/** Playing takes between these times [s], where the run does not. */
const LASTS = [4, 20];
/** A deflection over length that is well seen: smaller ones are drawn larger. */
const SEEN = 0.05;

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

/** How many seconds of the run a second shows. */
function speed(span: number): number {
  const [least, most] = LASTS;
  if (span === 0) return 1;
  return span < least ? nice(span / least) : span > most ? 2 * nice(span / most) : 1;
}

export function motion(results: ReturnType<typeof read>) {
  const space = scene(results.scene);
  const { times, parts } = space;
  const still: Section = { position: new Vector3(), turned: pose(parts[0], { from: 0, to: 0, share: 0 }).turned.identity() };
  const canvas = element<HTMLCanvasElement>("canvas");
  const stage = new Stage(canvas, element("scale"), space);
  const beams = parts.filter((part) => part.beam);
  const straight = beams.length > 0 && beams.every((part) => part.beam!.straight);
  // Tips of beams, or bodies where there is no beam.
  const followed = (beams.length > 0 ? beams : parts).slice(0, 12);
  const columns = results.curves!.columns.map((column) => ({ ...column, values: numbers(column.values) }));
  // Where none is of the usual ones, the first few.
  if (!columns.some((column) => column.shown)) for (const column of columns.slice(0, 3)) column.shown = true;
  const recorded = numbers(results.curves!.times);
  const revolutions = turns() / (2 * Math.PI);
  // Beyond half a revolution between frames nobody sees which way it turns.
  let [factor, rotating, path] = [suggested(), revolutions > 0.5, true];

  /** The largest angle [rad] by which the first part or its hub turns between neighbouring times. */
  function turns(): number {
    const angle = columns.find((column) => column.name === "hub.angle")?.values;
    const hub = (time: number) => {
      const { from, to, share } = instant(recorded, time);
      return angle ? angle[from] + share * (angle[to] - angle[from]) : 0;
    };
    let most = 0;
    for (let i = 1; i < times.length; i++) {
      const [before, now] = [i - 1, i].map((k) => pose(parts[0], { from: k, to: k, share: 0 }).turned);
      most = Math.max(most, before.angleTo(now), Math.abs(hub(times[i]) - hub(times[i - 1])));
    }
    return most;
  }

  /** The factor that makes small deflections visible; with obstacles there is none, for gaps are not drawn larger. */
  function suggested(): number {
    if (space.outlines.length > 0 || !straight) return 1;
    const over = Math.max(...parts.map(({ beam }) => (beam ? largest(beam.displacements) : 0))) / stage.size;
    return over > 0 && over < SEEN / 4 ? nice(SEEN / over) : 1;
  }

  /** The axes of the first part, at the centre of its hub. */
  function frame(at: Instant): Section {
    if (!rotating) return still;
    const root = pose(parts[0], at);
    const hub = new Vector3(parts[0].beam?.hub ?? 0, 0, 0).applyQuaternion(root.turned);
    return { position: root.position.sub(hub), turned: root.turned };
  }

  const shapes = (at: Instant) => parts.map((part) => (part.beam ? sections(part, at, factor, PIECES) : undefined));

  function outline(points: Float64Array, at: Instant): Vector3[] {
    const count = points.length / times.length;
    return Array.from({ length: count / 3 }, (_, k) => {
      const vertex = (i: number) => new Vector3().fromArray(points, count * i + 3 * k);
      return vertex(at.from).lerp(vertex(at.to), at.share);
    });
  }

  const pieces = Math.min(Math.max(Math.ceil((2 * Math.PI * revolutions) / TURN), 2), 16);
  const instants = Array.from({ length: pieces * (times.length - 1) + 1 }, (_, k): Instant => {
    const from = Math.min(Math.floor(k / pieces), times.length - 1);
    return { from, to: Math.min(from + 1, times.length - 1), share: (k % pieces) / pieces };
  });

  /** A point as it is seen from the frame of reference. */
  const seen = (point: Vector3, { position, turned }: Section) =>
    point.clone().sub(position).applyQuaternion(turned.clone().conjugate());

  /** The paths of what is followed. */
  function trace() {
    const end = (part: Part, at: Instant) => (part.beam ? sections(part, at, factor, 1).at(-1)! : pose(part, at));
    const trail = (part: Part) => instants.map((at) => seen(end(part, at).position, frame(at)));
    stage.trace(path ? followed.map(trail) : []);
  }

  function fit() {
    const every = Math.max(1, Math.floor(instants.length / 150));
    const points = instants.filter((_, k) => k % every === 0).flatMap((at) => {
      const now = frame(at);
      const places = parts.flatMap((part) => extent(part, at, factor));
      const closed = space.outlines.filter(({ points }) => points.length / times.length > 6);
      places.push(...closed.flatMap(({ points }) => outline(points, at)));
      places.push(now.position);
      return places.map((point) => seen(point, now));
    });
    const hub = Math.max(0, ...parts.map((part) => part.beam?.hub ?? 0));
    if (hub > 0) for (const x of [-hub, hub]) points.push(new Vector3(x, x, 0));
    stage.fit(points);
  }

  function draw(time: number) {
    const at = instant(times, time);
    const outlines = space.outlines.map(({ points }) => outline(points, at));
    stage.place({ poses: parts.map((part) => pose(part, at)), sections: shapes(at), outlines, frame: frame(at) });
    stage.follow(Math.floor(pieces * (at.from + at.share)) + 1);
    stage.render();
  }

  const [start, end] = [times[0], times[times.length - 1]];
  element("subtitle").textContent =
    `${results.name}, ${text(start)} to ${text(end)} s, ${times.length === 1 ? "1 frame" : `${times.length} frames`}, Flexion ${results.version}`;
  let player: Player | undefined;
  const curves = new Columns(element("curves"), recorded, columns, (time) => {
    player?.play(false);
    player?.seek(time);
  });
  const note = () => {
    const larger = factor === 1 ? "" : `Deflections are drawn ${text(factor)} times as large.`;
    const fast = `The hub turns by up to ${text(revolutions, 2)} revolutions between frames: see it in its own frame.`;
    const parts = [results.caution ? `${results.caution}.` : "", revolutions > 0.5 ? fast : "", larger];
    element("note").textContent = parts.join(" ").trim();
  };
  const again = () => {
    trace();
    note();
    fit();
    draw(player?.time ?? start);
  };
  button("Fit", "f", fit);
  if (!space.planar) {
    const views: [string, View][] = [["space", "space"], ["x, y", "xy"], ["x, z", "xz"], ["y, z", "yz"]];
    choice<View>("View", views, "space", (view) => {
      stage.turn(view);
      fit();
    });
  }
  const named = parts[0].beam?.hub === undefined ? `Frame of ${parts[0].name}` : "Rotating frame";
  toggle(named, "r", rotating, (on) => {
    rotating = on;
    again();
  });
  toggle(beams.length > 0 ? "Tip path" : "Paths", "p", path, (on) => {
    path = on;
    trace();
    draw(player!.time);
  });
  if (straight) {
    const factors = [...new Set([1, 2, 5, 10, 20, 50, 100, 1000, factor])].sort((a, b) => a - b);
    choice("Deflection", factors.map((x): [string, number] => [`${text(x)} ×`, x]), factor, (x) => {
      factor = x;
      again();
    });
  }
  player = new Player(times, (time) => `${steady(time)} s`, (time) => {
    draw(time);
    curves.show(time);
  }, speed(end - start));
  let fitted = false;
  canvas.addEventListener("resized", () => {
    if (fitted) draw(player!.time);
    else fit();
    fitted = true;
  });
  again();
}
