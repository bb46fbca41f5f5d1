// Modes of vibration about an equilibrium.
import { Vector3 } from "three";
import { array, type Results, type Vibration } from "./data";
import { Panel, tag } from "./curves";
import { Player } from "./player";
import type { Drawn, Kept, Room } from "./room";
import { extent, largest, pose, rotation, scene, sections, type Instant, type Part, type Section } from "./scene";
import { Stage, type View } from "./stage";
import { text } from "./text";
import { button, choice } from "./tools";

/** Pieces of a beam between neighbouring stations. */
const PIECES = 3;
/** Seconds of a period, as it is played. */
const PERIOD = 2;
/** What is drawn along the beam, in panels of one unit each: the largest displacement is 1 m, or in a mode of torsion the largest rotation 1 rad. */
const PANELS = [
  { unit: "m", axes: ["axial", "chord", "flap"] },
  { unit: "rad", axes: ["torsion"] },
];

export function modes(results: Results, room: Room, kept?: Kept): Drawn {
  const { table, shapes } = results.modes!;
  const space = scene(results.scene);
  const stage = new Stage(room, space);
  let [mode, amplitude] = [Math.min(kept?.mode ?? 0, table.modes.length - 1), kept?.factor ?? 0.1];

  // What the real and the imaginary part of every mode make of every part, as differences from the equilibrium.
  const still: Instant = { from: 0, to: 0, share: 0 };
  const rest = space.parts.map((part) => pose(part, still));
  const differences = table.modes.map((_, k) =>
    space.parts.map((part, p) =>
      [2 * k + 1, 2 * k + 2].map((time) => {
        const moved = pose(part, { from: time, to: time, share: 0 });
        const turned = rest[p].turned.clone().conjugate().multiply(moved.turned);
        const sine = new Vector3(turned.x, turned.y, turned.z).multiplyScalar(2 * Math.sign(turned.w));
        const less = (values: Float64Array | undefined) => {
          const count = 3 * (part.beam?.stations.length ?? 0);
          const base = values?.subarray(0, count);
          return values?.slice(count * time, count * (time + 1)).map((u, i) => u - base![i]);
        };
        return {
          position: moved.position.sub(rest[p].position),
          turned: sine,
          displacements: less(part.beam?.displacements),
          rotations: less(part.beam?.rotations),
        };
      }),
    ),
  );

  /** Part `p` at a phase of mode `k`, with displacements `scale` times those of the files. */
  function displaced(k: number, p: number, phase: number, scale: number): Part {
    const part = space.parts[p];
    const [real, imaginary] = differences[k][p];
    const [c, s] = [scale * Math.cos(phase), -scale * Math.sin(phase)];
    const position = rest[p].position.clone().addScaledVector(real.position, c).addScaledVector(imaginary.position, s);
    const theta = real.turned.clone().multiplyScalar(c).addScaledVector(imaginary.turned, s);
    const { x, y, z, w } = rest[p].turned.clone().multiply(rotation(theta));
    const poses = Float64Array.from([...position.toArray(), w, x, y, z]);
    const sum = (base: Float64Array, a: Float64Array, b: Float64Array) => a.map((u, i) => base[i] + c * u + s * b[i]);
    const beam = part.beam && {
      ...part.beam,
      displacements: sum(part.beam.displacements, real.displacements!, imaginary.displacements!),
      rotations: sum(part.beam.rotations, real.rotations!, imaginary.rotations!),
    };
    return { ...part, poses, beam };
  }
  const all = space.parts.map((_, p) => p);
  const places = (k: number, phase: number, scale: number) =>
    all.flatMap((p) => extent(displaced(k, p, phase, scale), still, 1));

  // What makes the largest displacement of every mode one.
  const unit = table.modes.map((_, k) => {
    const base = places(k, 0, 0);
    const most = Math.max(
      ...[0, 0.25].flatMap((share) => places(k, 2 * Math.PI * share, 1).map((point, i) => point.distanceTo(base[i]))),
    );
    return most > 0 ? 1 / most : 0;
  });
  const size = () => amplitude * stage.size * unit[mode];

  const frame: Section = { position: new Vector3(), turned: rest[0].turned.clone().identity() };
  function draw(time: number) {
    const parts = all.map((p) => displaced(mode, p, (2 * Math.PI * time) / PERIOD, size()));
    const poses = parts.map((part) => pose(part, still));
    const shown = parts.map((part) => (part.beam ? sections(part, still, 1, PIECES) : undefined));
    stage.place({ poses, sections: shown, outlines: [], frame });
    stage.render();
  }

  function fit() {
    const phases = [0, 0.25, 0.5, 0.75].flatMap((share) => places(mode, 2 * Math.PI * share, size()));
    stage.fit([...phases, frame.position.clone()]);
  }

  const moves = (vibration: Vibration) =>
    Object.entries(vibration.shares)
      // The same displacement along the axes of the section is not said twice.
      .filter(([name, share]) => Math.abs(share) > 0.01 && !name.startsWith("section-"))
      .sort((a, b) => b[1] - a[1])
      .map(([name, share]) => `${name} ${Math.round(100 * share)} %`)
      .join(", ");
  // Curves along the beam, where the shape of one beam is recorded.
  const plots = tag("div", { class: "panels" });
  const get = (name: string) => array(shapes, name) ?? new Float64Array();
  const stations = get("station");
  const curves = (k: number, { unit, axes }: (typeof PANELS)[number]) => {
    const lists = axes.flatMap((axis) =>
      ["real", "imaginary"].map((part, j) => ({
        name: `${axis}${j ? ", a quarter of a period before" : ""}`,
        unit,
        values: get(`mode${k + 1}.${axis}.${part}`),
      })),
    );
    return lists.filter(({ values }) => largest(values) > 1e-6);
  };
  const rows = table.modes.map((vibration, k) => {
    const radio = tag("input", { type: "radio", name: "mode", id: `mode${k}`, "aria-label": `Mode ${k + 1}` });
    radio.addEventListener("change", () => choose(k));
    const cells = [
      tag("label", { for: `mode${k}` }, radio, String(k + 1)),
      text(vibration.frequency, 6),
      text(vibration["damping-ratio"], 3),
      String(vibration.nodes),
      moves(vibration),
    ];
    const row = tag("tr", {}, ...cells.map((cell) => tag("td", {}, cell)));
    row.addEventListener("click", () => choose(k));
    return row;
  });
  const head = ["mode", table.unit ? `frequency [${table.unit}]` : "frequency", "damping", "nodes", "moves"].map((name) => tag("th", { scope: "col" }, name));
  room.curves.append(
    tag("div", { class: "table" }, tag("table", {}, tag("thead", {}, tag("tr", {}, ...head)), tag("tbody", {}, ...rows))),
    plots,
  );
  function choose(k: number) {
    mode = k;
    rows[k].querySelector("input")!.checked = true;
    rows.forEach((row, i) => row.classList.toggle("chosen", i === k));
    const drawn = PANELS.map((panel) => curves(k, panel)).filter((lists) => stations.length > 0 && lists.length > 0);
    const panels = drawn.map((lists) => new Panel(room, stations, lists, undefined).node);
    if (panels.length > 0) panels.push(tag("p", { class: "abscissa" }, "arc length [m]"));
    plots.replaceChildren(...panels);
    fit();
    if (player) draw(player.time);
  }
  room.subtitle.textContent =
    `${table.modes.length} modes at ${text(table.speed)} ${table["speed-unit"]}, Flexion ${results.version}`;
  room.note.textContent = table.warnings.join(" ");
  button(room, "Fit", "f", fit);
  if (!space.planar) {
    const views: [string, View][] = [["space", "space"], ["x, y", "xy"], ["x, z", "xz"], ["y, z", "yz"]];
    choice<View>(room, "View", views, "space", (view) => {
      stage.turn(view);
      fit();
    });
  }
  const amplitudes = [0.02, 0.05, 0.1, 0.2].map((x): [string, number] => [`${text(100 * x)} % of the length`, x]);
  choice(room, "Amplitude", amplitudes, amplitude, (x) => {
    amplitude = x;
    fit();
    draw(player!.time);
  });
  let player: Player | undefined;
  const times = Float64Array.from({ length: 25 }, (_, k) => (PERIOD * k) / 24);
  player = new Player(room, times, (time) => `${Math.round((360 * time) / PERIOD)}° of a period`, draw, 1, kept);
  let fitted = false;
  const resized = () => {
    if (fitted) draw(player!.time);
    else fit();
    fitted = true;
  };
  room.canvas.addEventListener("resized", resized, { signal: room.signal });
  choose(mode);
  return {
    kept: () => ({ ...player!.kept, factor: amplitude, mode }),
    seek: (share) => player!.seek(share * PERIOD),
    play: (on) => player!.play(on),
    seconds: player.seconds,
  };
}
