// Pictures of the gallery: positions of the motion and the first curve of each item, or its drawing.
//
//     node build/pictures.mjs ENGINE.wasm FOLDER
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { numbers as decoded, open } from "../engine/engine.mjs";

const [WIDTH, HEIGHT, CURVE] = [240, 150, 44];
/** Work after which a run is drawn as far as it came. */
const WORK = 1e6;
const STYLE =
  "<style>.b{fill:none;stroke:#1f5fa8;stroke-width:1.6;stroke-linecap:round}.p{fill:none;stroke:#d0812f;stroke-width:1}" +
  ".o{fill:none;stroke:#a33a32;stroke-width:1.5}.c{fill:none;stroke:#1f5fa8;stroke-width:1.3}.k1{stroke:#c4701f;stroke-dasharray:5 2}.k2{stroke:#3c8548;stroke-dasharray:2 2}.a{stroke:#c9ced5;stroke-width:1}" +
  ".s{fill:none;stroke:#5b626d;stroke-width:1.2}text{font:9px system-ui,sans-serif;fill:#5b626d}" +
  "@media(prefers-color-scheme:dark){.b,.c{stroke:#7db2ea}.k1{stroke:#e39a51}.k2{stroke:#7cc487}.p{stroke:#e39a51}.o{stroke:#e27d73}.a{stroke:#363c45}.s{stroke:#9aa3af}text{fill:#9aa3af}}</style>";

const numbers = (values) => decoded({ values });

/** A vector turned by a quaternion (w, x, y, z). */
function turned([w, x, y, z], [a, b, c]) {
  const t = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * t[0] + y * t[2] - z * t[1], b + w * t[1] + z * t[0] - x * t[2], c + w * t[2] + x * t[1] - y * t[0]];
}

/** What moves: lines at every time. */
function shapes(scene) {
  const get = (name) => scene[name] && numbers(scene[name].values);
  const count = numbers(scene.time.values).length;
  const outside = Object.keys(scene).some((key) => key.endsWith(".outline"));
  const parts = Object.keys(scene).filter((key) => key.endsWith(".pose")).map((key) => {
    const name = key.slice(0, -5);
    const [pose, stations, moved, box] = [get(key), get(`${name}.station`), get(`${name}.displacement`), get(`${name}.box`)];
    // Small deflections of straight beams are drawn larger, where no gap to an obstacle would be.
    const most = moved ? moved.reduce((most, u) => Math.max(most, Math.abs(u)), 0) / stations.at(-1) : 0;
    const factor = most > 0 && most < 0.02 && !outside ? 0.08 / most : 1;
    const at = (t) => {
      const place = [...pose.slice(7 * t, 7 * t + 3)];
      const turn = [...pose.slice(7 * t + 3, 7 * t + 7)];
      const world = (point) => turned(turn, point).map((x, i) => x + place[i]);
      if (stations) {
        const m = stations.length;
        return [...stations].map((s, k) => {
          const u = moved.slice(3 * (m * t + k), 3 * (m * t + k) + 3).map((u) => factor * u);
          return world([s - stations[0] + u[0], u[1], u[2]]);
        });
      }
      const [x, y, z, a, b, c] = box ?? [0, 0, 0, 0.05, 0.05, 0.05];
      const corner = (i, j, k) => world([x + (i * a) / 2, y + (j * b) / 2, z + (k * c) / 2]);
      return [corner(-1, -1, 0), corner(1, -1, 0), corner(1, 1, 0), corner(-1, 1, 0), corner(-1, -1, 0)];
    };
    return { beam: Boolean(stations), at };
  });
  const outlines = Object.keys(scene).filter((key) => key.endsWith(".outline")).map((key) => {
    const points = get(key);
    const each = points.length / count;
    return (t) => Array.from({ length: each / 3 }, (_, k) => [...points.slice(each * t + 3 * k, each * t + 3 * k + 3)]);
  });
  return { count, parts, outlines };
}

function drawn(results) {
  const { scene } = results;
  const first = column(results);
  const { count, parts, outlines } = shapes(scene);
  const times = [...new Set(Array.from({ length: 7 }, (_, k) => Math.round((k * (count - 1)) / 6)))];
  const lines = times.map((t) => parts.map((part) => part.at(t)));
  const every = Math.max(1, Math.floor(count / 240));
  const trail = Array.from({ length: Math.floor((count - 1) / every) + 1 }, (_, k) => k * every);
  const paths = parts.filter(({ beam }) => beam || parts.length < 3).slice(0, 6).map((part) => trail.map((t) => part.at(t).at(-1)));
  const last = times.at(-1);
  const obstacles = outlines.map((outline) => outline(last));
  const flat = lines.flat(2).every((point) => Math.abs(point[2]) < 1e-9);
  const project = ([x, y, z]) => (flat ? [x, -y] : [0.83 * x + 0.56 * y, 0.25 * x - 0.37 * y - 0.89 * z]);
  const points = [...lines.flat(2), ...paths.flat(), ...obstacles.filter((of) => of.length > 2).flat()].map(project);
  if (points.some((point) => !point.every(Number.isFinite))) return undefined;
  const range = (i) => [Math.min(...points.map((p) => p[i])), Math.max(...points.map((p) => p[i]))];
  const [[x0, x1], [y0, y1]] = [range(0), range(1)];
  const free = HEIGHT - CURVE;
  const scale = Math.min((WIDTH - 20) / Math.max(x1 - x0, 1e-9), (free - 16) / Math.max(y1 - y0, 1e-9));
  const place = (point) => {
    const [x, y] = project(point);
    return `${(WIDTH / 2 + scale * (x - (x0 + x1) / 2)).toFixed(1)},${(free / 2 + scale * (y - (y0 + y1) / 2)).toFixed(1)}`;
  };
  const line = (of, name, opacity = 1) => `<polyline class="${name}" opacity="${opacity}" points="${of.map(place).join(" ")}"/>`;
  return [
    ...paths.map((path) => line(path, "p")),
    ...obstacles.filter((of) => of.length > 1).map((of) => line(of, "o")),
    ...lines.flatMap((all, k) => all.map((of, i) => line(of, parts[i].beam ? "b" : "s", (0.2 + (0.8 * (k + 1)) / lines.length).toFixed(2)))),
    curves(first.name, [first], HEIGHT - CURVE),
  ].join("");
}

/** Curves over time in the lower part of a picture, from `top` on. */
function curves(name, lists, top) {
  const finite = lists.flatMap(({ times, values }) => [...times.keys()].filter((i) => Number.isFinite(values[i])).map((i) => [times[i], values[i]]));
  if (finite.length < 2) return "";
  const range = (i) => finite.reduce(([low, high], pair) => [Math.min(low, pair[i]), Math.max(high, pair[i])], [Infinity, -Infinity]);
  const [[t0, t1], [low, high]] = [range(0), range(1)];
  const bottom = HEIGHT - 6;
  const x = (t) => 10 + ((WIDTH - 20) * (t - t0)) / (t1 - t0 || 1);
  const y = (v) => bottom - ((bottom - top - 14) * (v - low)) / (high - low || 1);
  const line = ({ times, values }, k) => {
    const every = Math.max(1, Math.floor(times.length / 400));
    const kept = [...times.keys()].filter((i) => i % every === 0 && Number.isFinite(values[i]));
    return `<polyline class="c k${k}" points="${kept.map((i) => `${x(times[i]).toFixed(1)},${y(values[i]).toFixed(1)}`).join(" ")}"/>`;
  };
  const rule = top > 0 ? `<line class="a" x1="0" x2="${WIDTH}" y1="${top}" y2="${top}"/>` : "";
  return `${rule}<text x="10" y="${top + 10}">${name.replace(/[<&]/g, "")}</text>${lists.map(line).join("")}`;
}

/** A column of results within some times. */
function column(results, name, from = -Infinity, to = Infinity) {
  const all = numbers(results.curves.times);
  const found = results.curves.columns.find((column) => column.name === name) ?? results.curves.columns.find(({ shown }) => shown) ?? results.curves.columns[0];
  const values = numbers(found.values);
  const kept = [...all.keys()].filter((i) => all[i] >= from && all[i] <= to);
  return { name: found.name, times: kept.map((i) => all[i]), values: kept.map((i) => values[i]) };
}

const [file, folder] = process.argv.slice(2);
const root = join(import.meta.dirname, "../..");
const { cases, items: listed } = JSON.parse(readFileSync(join(root, "lab/made/gallery.json"), "utf8"));
const pictured = JSON.parse(readFileSync(join(root, "lab/made/pictured.json"), "utf8"));
const items = listed.map((item) => ({ ...item, ...pictured[item.id] }));
const large = JSON.parse(readFileSync(join(root, "lab/made/files.json"), "utf8"));
const { ask } = await open(file);
mkdirSync(folder, { recursive: true });
const without = [];
for (const item of items) {
  const name = join(folder, `${item.id.replace("/", "-")}.svg`);
  if (item.drawing) {
    const drawing = readFileSync(join(root, item.drawing), "utf8");
    writeFileSync(name, drawing.replace(/<svg([^>]*)>/, `<svg$1><style>svg{color:#1c1f24}@media(prefers-color-scheme:dark){svg{color:#e4e7eb}}</style>`));
    continue;
  }
  const answer = (run) => {
    const { text, files } = cases[run.case ?? item.case];
    const encoded = Object.fromEntries(Object.entries(files).map(([name, text]) => [name, Buffer.from(text.beside ? large[text.beside] : text).toString("base64")]));
    return ask({ do: "run", case: text, files: encoded, set: run.set, errors: false, limits: { work: WORK, memory: 256e6 } });
  };
  const chosen = item.plot?.runs?.flatMap((name) => item.runs.filter((run) => run.name === name)) ?? [];
  const runs = item.plot ? (chosen.length > 0 ? chosen : item.runs.slice(0, 3)) : item.runs.slice(0, 1);
  const replies = runs.map(answer);
  const found = replies.flatMap(({ results }) => (results?.curves ? [results] : []));
  let picture;
  if (item.plot && found.length > 0) {
    const { y, from, to } = item.plot;
    picture = curves(y, found.map((results) => column(results, y, from, to)), 0);
  } else if (found[0]?.scene && Object.keys(found[0].scene).length > 0) picture = drawn(found[0]);
  if (picture) writeFileSync(name, `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}">${STYLE}${picture}</svg>`);
  else without.push(`${item.id} (${replies[0].message ?? replies[0].problems?.[0]?.message ?? replies[0].status})`);
}
console.log(`${items.length - without.length} pictures${without.length > 0 ? `, none of ${without.join(", ")}` : ""}`);
