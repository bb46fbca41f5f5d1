// Modes of vibration about an equilibrium.
import { Vector3 } from "three";
import { array, type read, type Vibration } from "./data";
import { Panel, tag } from "./curves";
import { Player } from "./player";
import { scene, sections, type Section } from "./scene";
import { Stage, type View } from "./stage";
import { text } from "./text";
import { button, choice } from "./tools";

/** Seconds of a period, as it is played. */
const PERIOD = 2;
const AXES = ["tangent", "second", "third"];
const NAMES = ["along the tangent", "second axis", "third axis"];

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

export function modes(results: ReturnType<typeof read>) {
  const { table, shapes } = results.modes!;
  const space = scene(results.scene);
  const [part] = space.parts;
  const canvas = element<HTMLCanvasElement>("canvas");
  const get = (name: string) => array(shapes, name)!;
  const stations = get("station");
  // Real and imaginary parts along each axis.
  const shape = table.modes.map((_, k) =>
    AXES.map((axis) => ["real", "imaginary"].map((part) => get(`mode${k + 1}.${axis}.${part}`))),
  );
  const largest = (values: Float64Array) => values.reduce((most, u) => Math.max(most, Math.abs(u)), 0);
  const flat = shape.every((axes) => axes[2].every((values) => largest(values) < 1e-12));
  space.planar &&= flat;
  const stage = new Stage(canvas, element("scale"), space);
  let [mode, amplitude] = [0, 0.1];

  // The equilibrium at the stations of the shapes.
  const fine = sections(part, { from: 0, to: 0, share: 0 }, 1, 16);
  const coarse = part.beam!.stations;
  const rest = Array.from(stations, (x): Section => {
    let k = 0;
    while (k + 2 < coarse.length && coarse[k + 1] <= x) k++;
    const place = 16 * (k + (x - coarse[k]) / (coarse[k + 1] - coarse[k]));
    const i = Math.min(Math.max(Math.floor(place), 0), fine.length - 2);
    const position = fine[i].position.clone().lerp(fine[i + 1].position, place - i);
    return { position, turned: fine[i].turned.clone().slerp(fine[i + 1].turned, place - i) };
  });

  function moved(phase: number): Section[] {
    const [cosine, sine] = [Math.cos(phase), Math.sin(phase)];
    const scale = amplitude * stage.size;
    return rest.map(({ position, turned }, k) => {
      const along = shape[mode].map(([real, imaginary]) => scale * (real[k] * cosine - imaginary[k] * sine));
      const u = new Vector3().fromArray(along).applyQuaternion(turned);
      return { position: u.add(position), turned };
    });
  }

  const frame: Section = { position: new Vector3(), turned: rest[0].turned.clone().identity() };
  function draw(time: number) {
    stage.place({ poses: [rest[0]], sections: [moved((2 * Math.PI * time) / PERIOD)], outlines: [], frame });
    stage.render();
  }

  function fit() {
    const all = [0, 0.25, 0.5, 0.75].flatMap((part) => moved(2 * Math.PI * part));
    stage.fit([...all.map((section) => section.position), frame.position.clone()]);
  }

  const unit = table.unit || "×";
  const moves = (vibration: Vibration) =>
    Object.entries(vibration.shares)
      .filter(([, share]) => Math.abs(share) > 0.01)
      .sort((a, b) => b[1] - a[1])
      .map(([name, share]) => `${name} ${Math.round(100 * share)} %`)
      .join(", ");
  const plots = tag("div", { class: "panels" });
  const curves = shape.map((axes) => {
    const lists = axes.flatMap((parts, i) =>
      parts.map((values, j) => ({ name: `${NAMES[i]}${j ? ", a quarter of a period before" : ""}`, unit: "", values })),
    );
    return lists.filter(({ values }) => largest(values) > 1e-6).slice(0, 6);
  });
  const rows = table.modes.map((vibration, k) => {
    const radio = tag("input", { type: "radio", name: "mode", id: `mode${k}`, "aria-label": `Mode ${k + 1}` });
    radio.checked = k === 0;
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
  const head = ["mode", `frequency [${unit}]`, "damping", "nodes", "moves"].map((name) => tag("th", { scope: "col" }, name));
  element("curves").append(
    tag("div", { class: "table" }, tag("table", {}, tag("thead", {}, tag("tr", {}, ...head)), tag("tbody", {}, ...rows))),
    plots,
  );
  function choose(k: number) {
    mode = k;
    element<HTMLInputElement>(`mode${k}`).checked = true;
    rows.forEach((row, i) => row.classList.toggle("chosen", i === k));
    plots.replaceChildren(new Panel(stations, curves[k], undefined).node, tag("p", { class: "abscissa" }, "arc length [m]"));
    fit();
    if (player) draw(player.time);
  }
  element("subtitle").textContent =
    `${table.modes.length} modes at ${text(table.speed)} ${table.unit}, Flexion ${results.version}`;
  element("note").textContent = table.warnings.join(" ");
  button("Fit", "f", fit);
  if (!space.planar) {
    const views: [string, View][] = [["space", "space"], ["x, y", "xy"], ["x, z", "xz"], ["y, z", "yz"]];
    choice<View>("View", views, "space", (view) => {
      stage.turn(view);
      fit();
    });
  }
  const amplitudes = [0.02, 0.05, 0.1, 0.2].map((x): [string, number] => [`${text(100 * x)} % of the length`, x]);
  choice("Amplitude", amplitudes, amplitude, (x) => {
    amplitude = x;
    fit();
    draw(player!.time);
  });
  let player: Player | undefined;
  const times = Float64Array.from({ length: 25 }, (_, k) => (PERIOD * k) / 24);
  player = new Player(times, (time) => `${Math.round((360 * time) / PERIOD)}° of a period`, draw, 1);
  let fitted = false;
  canvas.addEventListener("resized", () => {
    if (fitted) draw(player!.time);
    else fit();
    fitted = true;
  });
  choose(0);
}
