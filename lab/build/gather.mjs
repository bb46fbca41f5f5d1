// Gathers the gallery: every case of verification/ and every item of papers/, with title, sentence, runs and files.
//
//     node build/gather.mjs        writes made/gallery.json, large files into made/files.json, and what is drawn of items into made/pictured.json
import { existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join, posix } from "node:path";
import { parse } from "smol-toml";

const root = join(import.meta.dirname, "../..");
/** Larger files lie beside the page, and are read when their case is opened [bytes]. */
const LARGE = 2500;
/** Files of the case that is shown first are within the page, however large. */
const FIRST = "verification/p1_spin_up_4";
/** Still larger files, those of other formats, are left to those who have the repository [bytes]. */
const LARGEST = 70_000;

const text = (path) => readFileSync(join(root, path), "utf8");
const folders = (path) => readdirSync(join(root, path), { withFileTypes: true }).filter((e) => e.isDirectory()).map((e) => e.name).sort();

/** Markdown as plain words. */
const plain = (markdown) =>
  markdown.replace(/!?\[([^\]]*)\]\([^)]*\)/g, "$1").replace(/[`*]/g, "").replace(/\s+/g, " ").trim();

/** The first sentence of the text behind the heading. */
function sentence(markdown) {
  const paragraph = markdown.split(/\n\s*\n/).find((part, i) => i > 0 && !/^[#|`>$-]/.test(part.trim())) ?? "";
  const words = plain(paragraph);
  const end = words.search(/(?<![A-Z&]|\bal|\bFig|\bEq|\bInt|\bComput|\bJ|\d)\.(?=\s+[A-Z]|$)/);
  return end > 0 ? words.slice(0, end + 1) : words;
}

/** Files that texts of a case name, by the names that they are named by; a deck may name a further file. */
function files(folder, texts) {
  const found = {};
  const add = (name, from) => {
    const path = posix.normalize(posix.join(from, name));
    if (!/\.(csv|dat)$/i.test(name) || found[name] !== undefined || path.startsWith("..") || !existsSync(join(root, path))) return;
    const content = text(path);
    if (content.length > LARGEST) return;
    const within = content.length <= LARGE || from === FIRST;
    // Beside the page its name is its path, so that two of one name are two.
    const beside = path.replaceAll("/", "-");
    if (!within) large[beside] = content;
    found[name] = within ? content : { beside };
    if (!/\.(dat|inp|yaml|yml|htc)$/i.test(name)) return;
    for (const [, further] of content.slice(0, 20000).matchAll(/^\s*"([^"\n]+\.(?:dat|csv|inp))"/gim)) {
      add(posix.join(posix.dirname(name), further), from);
    }
  };
  for (const of of texts) for (const [, name] of of.matchAll(/\bfile\s*=\s*["']([^"']+)["']/g)) add(name, folder);
  return found;
}

const cases = {};
const large = {};
const items = [];

for (const name of folders("verification")) {
  const folder = `verification/${name}`;
  if (!existsSync(join(root, folder, "case.toml"))) continue;
  const readme = text(`${folder}/README.md`);
  const source = text(`${folder}/case.toml`);
  const expected = parse(text(`${folder}/expected.toml`));
  const variants = (expected.variant ?? []).map(({ name, title, set }) => ({ name, title, set }));
  const sets = variants.flatMap(({ set }) => set);
  cases[folder] = { text: source, files: files(folder, [source, ...sets]) };
  const known = cases[folder].files;
  const whole = ({ set }) => [...set.join("\n").matchAll(/\bfile\s*=\s*["']([^"']+)["']/g)].every(([, name]) => name in known);
  // A case that is held to frequencies alone is one of modes.
  const modal = expected.modes && !expected.columns && !expected.figures;
  const speed = expected.modes?.find(({ speed }) => speed > 0)?.speed ?? expected.modes?.[0]?.speed;
  items.push({
    id: name,
    group: "Verification",
    title: plain(readme.match(/^# (.*)$/m)?.[1] ?? parse(source).title ?? name),
    sentence: sentence(readme),
    case: folder,
    page: `repository/verification/${name}.html`,
    runs: [{ name: "as it stands", set: [] }, ...variants.filter(whole)],
    ...(modal || name.startsWith("modes_") ? { do: "modes", speed: speed === undefined ? undefined : `${Number(speed.toPrecision(6))} rad/s` } : {}),
  });
}

/** A run for every combination of the lists of `each`. */
function combinations(each = {}) {
  return Object.entries(each).reduce((all, [key, values]) => all.flatMap((one) => values.map((value) => ({ ...one, [key]: value }))), [{}]);
}

for (const paper of folders("papers")) {
  const about = parse(text(`papers/${paper}/paper.toml`));
  for (const file of readdirSync(join(root, `papers/${paper}/cases`)).sort()) {
    const source = text(`papers/${paper}/cases/${file}`);
    cases[`papers/${paper}/cases/${file}`] = { text: source, files: files(`papers/${paper}/cases`, [source]) };
  }
  for (const item of about.items) {
    const of = parse(text(`papers/${paper}/${item}.toml`));
    const runs = (of.run ?? []).filter((run) => run.case && !run["strain-energy"]).flatMap((run) =>
      combinations(run.each).map((values) => {
        const filled = (words) => String(words).replace(/\{(\w+)\}/g, (all, key) => (key in values ? values[key] : all));
        const modes = run.modes && !run.modes.unit ? { do: "modes", speed: filled(run.modes.speed ?? "0 rad/s") } : {};
        return { name: filled(run.name), case: `papers/${paper}/cases/${run.case}.toml`, set: (run.set ?? []).map(filled), ...modes };
      }),
    );
    // A case is named with a run where it is not that of the item.
    const first = runs[0]?.case ?? Object.keys(cases).find((name) => name.startsWith(`papers/${paper}/`));
    items.push({
      id: `${paper}/${item}`,
      group: `${paper}: ${about.title}`,
      source: `${about.authors}, ${about.source}`,
      title: `${item}. ${of.title}`,
      sentence: plain(of.claim?.[0]?.text ?? of.survives ?? of.chosen ?? about.about),
      case: first,
      runs: runs.length > 0 ? runs.map(({ case: of, ...run }) => (of === first ? run : { ...run, case: of })) : [{ name: "the case", set: [] }],
      // The curves of its first plot.
      ...(of.plot?.[0]?.y && !of.plot[0].x && { plot: { y: of.plot[0].y, runs: of.plot[0].runs?.slice(0, 3), from: of.plot[0].from, to: of.plot[0].to } }),
      ...(of.drawing && { drawing: `papers/${paper}/${of.drawing}` }),
    });
  }
}

const made = join(import.meta.dirname, "../made");
mkdirSync(made, { recursive: true });
// What only the pictures need is not in the page.
const pictured = Object.fromEntries(items.map(({ id, plot, drawing }) => [id, { plot, drawing }]));
writeFileSync(join(made, "pictured.json"), JSON.stringify(pictured));
writeFileSync(join(made, "gallery.json"), JSON.stringify({ cases, items: items.map(({ plot, drawing, ...item }) => item) }));
writeFileSync(join(made, "files.json"), JSON.stringify(large));
const runs = items.reduce((sum, item) => sum + item.runs.length, 0);
console.log(`${items.length} items with ${runs} runs of ${Object.keys(cases).length} cases`);
