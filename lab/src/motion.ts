// A run in motion.
import { Quaternion, Vector3 } from "three";
import { numbers, type Results } from "./data";
import { Columns } from "./curves";
import { Player } from "./player";
import type { Drawn, Kept, Room } from "./room";
import { between, end, extent, instant, largest, pose, scene, sections, type Acting, type Instant, type Part, type Section } from "./scene";
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

/** How many seconds of the run a second shows. */
function speed(span: number): number {
  const [least, most] = LASTS;
  if (span === 0) return 1;
  return span < least ? nice(span / least) : span > most ? 2 * nice(span / most) : 1;
}

/** Where a point is drawn. */
type Drawing = (point: Vector3) => Vector3;

/** A time, what is carried between the recorded ones, and where points are drawn. */
interface Moment {
  at: Instant;
  carried: ReturnType<typeof between>;
  drawn: Drawing;
}

/** What is drawn of a run. */
type Run = ReturnType<typeof read>;

/** Takes results up; `other` is a run that they are compared with. */
function read(results: Results, other?: Results) {
  const space = scene(results.scene);
  const { times, parts } = space;
  const table = results.curves!;
  const recorded = numbers(table.times);

  /** Half-widths of a band, of one number until the time until which it is trusted. */
  function banded(error: string | number | null | undefined): Float64Array | undefined {
    if (typeof error === "string") return numbers(error);
    return error ? recorded.map((time) => (time <= (table.trusted ?? Infinity) ? error : NaN)) : undefined;
  }

  /** A column of the other run, at the times of this one. */
  function compared(name: string): Float64Array | undefined {
    const column = other?.curves?.columns.find((column) => column.name === name);
    if (!column) return undefined;
    const [times, values] = [numbers(other!.curves!.times), numbers(column.values)];
    return recorded.map((time) => {
      if (time > times[times.length - 1]) return NaN;
      const { from, to, share } = instant(times, time);
      return values[from] + share * (values[to] - values[from]);
    });
  }

  const columns = table.columns.map((column) => ({
    ...column,
    values: numbers(column.values),
    error: banded(column.error),
    other: compared(column.name),
  }));
  const beams = parts.filter((part) => part.beam);
  const revolutions = turns(parts[0], times, recorded, columns.find((column) => column.name === "hub.angle")?.values) / (2 * Math.PI);
  const pieces = Math.min(Math.max(Math.ceil((2 * Math.PI * revolutions) / TURN), 2), 16);
  const instants = Array.from({ length: pieces * (times.length - 1) + 1 }, (_, k): Instant => {
    const from = Math.min(Math.floor(k / pieces), times.length - 1);
    return { from, to: Math.min(from + 1, times.length - 1), share: (k % pieces) / pieces };
  });
  const strongest = (all: { values: Float64Array }[]) => all.reduce((most, { values }) => Math.max(most, longest(values)), 0);
  return {
    results,
    space,
    recorded,
    columns,
    trusted: table.trusted ?? undefined,
    beams,
    straight: beams.length > 0 && beams.every((part) => part.beam!.straight),
    // Tips of beams, or bodies where there is no beam.
    followed: (beams.length > 0 ? beams : parts).slice(0, 12),
    pinned: other && Object.keys(other.scene).length > 0 ? scene(other.scene) : undefined,
    revolutions,
    pieces,
    instants,
    /** The largest [N] or [N·m] of each kind. */
    strongest: space.acting.map(strongest),
    /** The largest force per length [N/m]. */
    densest: strongest(space.along),
  };
}

/** The longest of vectors that stand behind their places. */
function longest(values: Float64Array): number {
  let most = 0;
  for (let i = 3; i < values.length; i += 6) most = Math.max(most, Math.hypot(values[i], values[i + 1], values[i + 2]));
  return most;
}

/** The largest angle [rad] by which a part or its hub turns between neighbouring times. */
function turns(part: Part, times: Float64Array, recorded: Float64Array, angle?: Float64Array): number {
  const hub = (time: number) => {
    if (!angle) return 0;
    const { from, to, share } = instant(recorded, time);
    return angle[from] + share * (angle[to] - angle[from]);
  };
  let most = 0;
  for (let i = 1; i < times.length; i++) {
    const [before, now] = [i - 1, i].map((k) => pose(part, { from: k, to: k, share: 0 }).turned);
    most = Math.max(most, before.angleTo(now), Math.abs(hub(times[i]) - hub(times[i - 1])));
  }
  return most;
}

/** Whether runs are of the same parts at the same times: what is drawn of one can show the other. */
function alike(one: Run, other: Run): boolean {
  const form = ({ space: { times, parts, outlines, acting, along, planar }, straight }: Run) => [
    times.length,
    times[0],
    times[times.length - 1],
    planar,
    straight,
    ...parts.flatMap(({ name, beam, box }) => [name, ...(beam ? [beam.hub, ...beam.stations, ...beam.section] : box!)]),
    ...outlines.flatMap(({ name, points }) => [name, points.length]),
    ...acting.flatMap((of) => [of.length, ...of.map(({ name }) => name)]),
    ...along.flatMap(({ name, points }) => [name, points]),
  ];
  const [a, b] = [form(one), form(other)];
  return a.length === b.length && a.every((entry, i) => entry === b[i]);
}

/** Shows the columns that were shown before; where none is of the usual ones, the first few. */
function choose({ columns }: Run, before?: string[]) {
  if (before?.some((name) => columns.some((column) => column.name === name))) {
    for (const column of columns) column.shown = before.includes(column.name);
  }
  if (!columns.some((column) => column.shown)) for (const column of columns.slice(0, 3)) column.shown = true;
}

/** Draws a run; `other` is one that it is compared with, `kept` what is to be as it was in an answer before. */
export function motion(results: Results, room: Room, kept?: Kept, other?: Results): Drawn {
  let run = read(results, other);
  const still: Section = { position: new Vector3(), turned: new Quaternion() };
  const stage = new Stage(room, run.space);
  choose(run, kept?.shown);
  // Beyond half a revolution between frames nobody sees which way it turns.
  let factor = kept?.factor ?? suggested();
  let rotating = kept?.rotating ?? run.revolutions > 0.5;
  let path = kept?.path ?? true;
  let transmitted = kept?.transmitted ?? true;

  /** A place and the vector behind it among six numbers of every time, as it is drawn with the largest as long as `most`. */
  function arrow(values: Float64Array, { at, carried, drawn }: Moment, [index, count]: [number, number], most: number): [Vector3, Vector3] {
    const entry = (time: number, i: number) => new Vector3().fromArray(values, 6 * (count * time + index) + i);
    const [place, along] = [0, 3].map((i) => carried(entry(at.from, i), entry(at.to, i), i === 3));
    return [drawn(place), along.multiplyScalar(most)];
  }

  /** Whether a vector is long enough to be seen. */
  const isSeen = ([, along]: [Vector3, Vector3]) => along.length() > 1e-2 * stage.arrow;

  /** Places of forces or couples, and vectors as long as they are large. */
  function arrows(all: Acting[], strongest: number, moment: Moment): [Vector3, Vector3][] {
    return all.map(({ values }) => arrow(values, moment, [0, 1], stage.arrow / (strongest || 1))).filter(isSeen);
  }

  /** The same of forces per length, which are half as long. */
  function rows(moment: Moment): [Vector3, Vector3][][] {
    return run.space.along.map(({ points, values }) => {
      const row = Array.from({ length: points }, (_, k) => arrow(values, moment, [k, points], stage.arrow / (2 * run.densest)));
      return row.some(isSeen) ? row : [];
    });
  }

  /** Where points are drawn: moved as the nearest section is, where deflections are drawn larger. */
  function drawing(at: Instant): Drawing {
    if (factor === 1) return (point) => point;
    const moved = run.beams.flatMap((part) => {
      const larger = sections(part, at, factor, 1);
      return sections(part, at, 1, 1).map(({ position }, k) => ({ position, by: larger[k].position.sub(position) }));
    });
    const [first, ...others] = moved;
    return (point) => {
      const nearer = (a: typeof first, b: typeof first) => (b.position.distanceTo(point) < a.position.distanceTo(point) ? b : a);
      return first ? point.add(others.reduce(nearer, first).by) : point;
    };
  }

  /** The beams of the other run. */
  function others(time: number): Vector3[][] {
    if (!run.pinned) return [];
    const at = instant(run.pinned.times, time);
    const drawn = run.pinned.parts.filter((part) => part.beam);
    return drawn.map((part) => sections(part, at, factor, PIECES).map((section) => section.position));
  }

  /** The factor that makes small deflections visible; with obstacles there is none, for gaps are not drawn larger. */
  function suggested(): number {
    if (run.space.outlines.length > 0 || !run.straight) return 1;
    const over = Math.max(...run.space.parts.map(({ beam }) => (beam ? largest(beam.displacements) : 0))) / stage.size;
    // What is rounding is not drawn larger.
    return over > 1e-9 && over < SEEN / 4 ? nice(SEEN / over) : 1;
  }

  /** The axes of the first part, at the centre of its hub. */
  function frame(at: Instant): Section {
    if (!rotating) return still;
    const [first] = run.space.parts;
    const root = pose(first, at);
    const hub = new Vector3(first.beam?.hub ?? 0, 0, 0).applyQuaternion(root.turned);
    return { position: root.position.sub(hub), turned: root.turned };
  }

  const shapes = (at: Instant) => run.space.parts.map((part) => (part.beam ? sections(part, at, factor, PIECES) : undefined));

  function outline(points: Float64Array, at: Instant): Vector3[] {
    const count = points.length / run.space.times.length;
    return Array.from({ length: count / 3 }, (_, k) => {
      const vertex = (i: number) => new Vector3().fromArray(points, count * i + 3 * k);
      return vertex(at.from).lerp(vertex(at.to), at.share);
    });
  }

  /** A point as it is seen from the frame of reference. */
  const seen = (point: Vector3, { position, turned }: Section) =>
    point.clone().sub(position).applyQuaternion(turned.clone().conjugate());

  /** The paths of what is followed. */
  function trace() {
    const trail = (part: Part) => run.instants.map((at) => seen(end(part, at, factor), frame(at)));
    stage.trace(path ? run.followed.map(trail) : []);
  }

  function fit() {
    const { instants, space } = run;
    const every = Math.max(1, Math.floor(instants.length / 150));
    const points = instants.filter((_, k) => k % every === 0).flatMap((at) => {
      const now = frame(at);
      const places = space.parts.flatMap((part) => extent(part, at, factor));
      const closed = space.outlines.filter(({ points }) => points.length / space.times.length > 6);
      places.push(...closed.flatMap(({ points }) => outline(points, at)));
      places.push(now.position);
      return places.map((point) => seen(point, now));
    });
    const hub = Math.max(0, ...space.parts.map((part) => part.beam?.hub ?? 0));
    if (hub > 0) for (const x of [-hub, hub]) points.push(new Vector3(x, x, 0));
    stage.fit(points);
  }

  function draw(time: number) {
    const { space, pieces } = run;
    const at = instant(space.times, time);
    const outlines = space.outlines.map(({ points }) => outline(points, at));
    const moment: Moment = { at, carried: between(space.parts, at), drawn: drawing(at) };
    stage.place({
      poses: space.parts.map((part) => pose(part, at)),
      sections: shapes(at),
      outlines,
      frame: frame(at),
      others: others(time),
      acting: space.acting.map((of, kind) => (transmitted || kind < 2 ? arrows(of, run.strongest[kind], moment) : [])),
      along: rows(moment),
    });
    stage.follow(Math.floor(pieces * (at.from + at.share)) + 1);
    stage.render();
  }

  const { times, parts, planar } = run.space;
  const [start, last] = [times[0], times[times.length - 1]];
  room.subtitle.textContent =
    `${results.name === results.title ? "" : `${results.name}, `}${text(start)} to ${text(last)} s, ${times.length === 1 ? "1 frame" : `${times.length} frames`}, Flexion ${results.version}`;
  let player: Player | undefined;
  // Of one time there are values, but no curves.
  room.curves.hidden = run.recorded.length < 2;
  const curves = new Columns(room, run.recorded, run.columns, run.trusted, (time) => {
    player?.play(false);
    player?.seek(time);
  });
  const note = () => {
    const { results, revolutions, densest, strongest: [force, moment, inJoints, twisting] } = run;
    const larger = factor === 1 ? "" : `Deflections are drawn ${text(factor)} times as large.`;
    const fast = `The hub turns by up to ${text(revolutions, 2)} revolutions between frames: see it in its own frame.`;
    const blind = stage.shown ? "" : "This browser has no WebGL: there is no picture, but curves.";
    const forced = force > 0 ? `Arrows are forces, the longest ${text(force, 3)} N.` : "";
    const spread = densest > 0 ? `Rows of arrows are forces per length, the longest ${text(densest, 3)} N/m.` : "";
    const turned = moment > 0 ? `Arcs are couples, the widest ${text(moment, 3)} N·m.` : "";
    const most = [inJoints > 0 ? `${text(inJoints, 3)} N` : "", twisting > 0 ? `${text(twisting, 3)} N·m` : ""].filter((one) => one);
    const joined = transmitted && most.length > 0 ? `Grey is what joints and springs transmit, ${most.join(" and ")} at most.` : "";
    const left = run.space.left > 0 ? `${run.space.left} smaller ones are not drawn.` : "";
    const parts = [blind, results.caution ? `${results.caution}.` : "", revolutions > 0.5 ? fast : "", forced, spread, turned, joined, left, larger];
    room.note.textContent = parts.join(" ").trim();
  };
  const again = (fitted = false) => {
    trace();
    note();
    if (!fitted) fit();
    draw(player?.time ?? start);
  };
  const fitAgain = () => {
    fit();
    draw(player!.time);
  };
  button(room, "Fit", "f", fitAgain);
  if (!planar) {
    const views: [string, View][] = [["space", "space"], ["x, y", "xy"], ["x, z", "xz"], ["y, z", "yz"]];
    choice<View>(room, "View", views, "space", (view) => {
      stage.turn(view);
      fitAgain();
    });
  }
  const named = parts[0].beam?.hub === undefined ? `Frame of ${parts[0].name}` : "Rotating frame";
  toggle(room, named, "r", rotating, (on) => {
    rotating = on;
    again();
  });
  toggle(room, run.beams.length > 0 ? "Tip path" : "Paths", "p", path, (on) => {
    path = on;
    trace();
    draw(player!.time);
  });
  if (run.strongest[2] + run.strongest[3] > 0) {
    toggle(room, "Joint forces", "j", transmitted, (on) => {
      transmitted = on;
      note();
      draw(player!.time);
    });
  }
  if (run.straight) {
    const factors = [...new Set([1, 2, 5, 10, 20, 50, 100, 1000, factor])].sort((a, b) => a - b);
    choice(room, "Deflection", factors.map((x): [string, number] => [`${text(x)} ×`, x]), factor, (x) => {
      factor = x;
      again();
    });
  }
  const show = (time: number) => {
    draw(time);
    curves.show(time);
  };
  player = new Player(room, times, (time) => `${steady(time)} s`, show, speed(last - start), kept);
  let fitted = kept?.seen !== undefined && stage.look(kept.seen);
  const resized = () => {
    if (!fitted) fit();
    fitted = true;
    draw(player!.time);
  };
  room.canvas.addEventListener("resized", resized, { signal: room.signal });
  // Heads of arrows lie across the line of sight.
  const turned = (event: Event) => {
    event.preventDefault();
    draw(player!.time);
  };
  room.canvas.addEventListener("turned", turned, { signal: room.signal });
  // What is in sight is fitted and drawn when the canvas has its size.
  trace();
  note();
  player.seek(player.time);
  return {
    kept: () => ({ ...player!.kept, factor, rotating, path, transmitted, seen: fitted ? stage.seen : kept?.seen, shown: curves.shown }),
    seek: (share) => player!.seek(start + share * (last - start)),
    play: (on) => player!.play(on),
    seconds: player.seconds,
    take: (results, other) => {
      const next = read(results, other);
      if (!alike(run, next)) return false;
      choose(next, curves.shown);
      if (!curves.take(next.recorded, next.columns, next.trusted)) return false;
      run = next;
      again(true);
      return true;
    },
  };
}
