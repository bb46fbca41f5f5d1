// Builds site/: a front page, the lab with its pictures, the book, and the report where there is one.
//
//     node build/site.mjs [ENGINE.wasm]
//
// The engine is that of `cargo build --profile wasm -p flexion-lab --target wasm32-unknown-unknown`. The book is taken from target/book,
// or built where mdBook is on the path; the report is results/reproduce/report.html.
import { execFileSync } from "node:child_process";
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { deflateRawSync } from "node:zlib";
import { open } from "../engine/engine.mjs";

const lab = join(import.meta.dirname, "..");
const root = join(lab, "..");
const site = join(lab, "site");
const file = process.argv[2] ?? join(root, "target/wasm32-unknown-unknown/wasm/flexion_lab.wasm");
if (!existsSync(file)) {
  console.error(`There is no engine at ${file}: cargo build --profile wasm -p flexion-lab --target wasm32-unknown-unknown`);
  process.exit(1);
}
const node = (name, ...words) => execFileSync("node", [join(lab, "build", name), ...words], { stdio: "inherit" });

rmSync(site, { recursive: true, force: true });
mkdirSync(join(site, "lab"), { recursive: true });
node("pages.mjs", file);
for (const name of ["index.html", "engine.wasm", "lab.html", "files"]) cpSync(join(lab, "dist", name), join(site, "lab", name), { recursive: true });
node("pictures.mjs", file, join(site, "lab/pictures"));
const page = join(site, "lab/index.html");
const pictures = JSON.stringify(readdirSync(join(site, "lab/pictures")));
writeFileSync(page, readFileSync(page, "utf8").replace('id="pictures">[]<', () => `id="pictures">${pictures}<`));

const { items } = JSON.parse(readFileSync(join(lab, "made/gallery.json"), "utf8"));
const escaped = (text) => text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
const opened = (id, from) => `${from}lab/index.html#case=${encodeURIComponent(id).replaceAll("%2F", "/")}`;

// The book.
const made = join(root, "target/book");
const installed = () => {
  try {
    execFileSync("mdbook", ["--version"], { stdio: "ignore" });
    return existsSync(join(root, "docs/book/node_modules"));
  } catch {
    return false;
  }
};
if (installed()) execFileSync("npm", ["run", "build"], { cwd: join(root, "docs/book"), stdio: "inherit" });
const book = existsSync(made);
if (book) {
  cpSync(made, join(site, "book"), { recursive: true });
  const { ask } = await open(file);
  let links = 0;
  for (const name of readdirSync(join(site, "book"), { recursive: true }).filter((name) => name.endsWith(".html"))) {
    const page = join(site, "book", name);
    const up = "../".repeat(name.split(/[\\/]/).length);
    const link = (address, words) => {
      links += 1;
      return `<p><a href="${address}">${words}</a></p>`;
    };
    let html = readFileSync(page, "utf8");
    const item = items.find((item) => item.page === name.replaceAll("\\", "/"));
    if (item) html = html.replace("</h1>\n", (end) => end + link(opened(item.id, up), "Open this case in the lab"));
    // Whole cases among the examples.
    html = html.replace(/<pre><code class="language-toml">([\s\S]*?)<\/code><\/pre>/g, (block, code) => {
      const text = code.replace(/&lt;/g, "<").replace(/&gt;/g, ">").replace(/&quot;/g, '"').replace(/&#39;/g, "'").replace(/&amp;/g, "&");
      if (!/^\[/m.test(text) || ask({ do: "check", case: text, limits: { work: 1e5, memory: 1e8 } }).status !== "valid") return block;
      return block + link(`${up}lab/index.html#c=${deflateRawSync(text).toString("base64url")}`, "Open in the lab");
    });
    writeFileSync(page, html);
  }
  console.log(`the book, with ${links} links to the lab`);
}
const report = join(root, "results/reproduce/report.html");
if (existsSync(report)) cpSync(report, join(site, "report.html"));

// The front page.
const chosen = [
  "p1_spin_up_4", "falling_pendulum", "roll_up", "simo_vu_quoc_spin_up", "space_roll_up_release", "space_air_bearing", "space_heavy_top",
  "space_elbow", "modes_blade_nrel_5mw", "space_contact", "P2/F3", "P4/F2",
].flatMap((id) => items.filter((item) => item.id === id));
const cards = chosen.map(
  (item) =>
    `<a href="${opened(item.id, "")}"><img src="lab/pictures/${item.id.replace("/", "-")}.svg" alt="" width="240" height="150" loading="lazy"><b>${escaped(item.title)}</b><span>${escaped(item.source ? `${item.source.split(",").slice(0, 2).join(",")} …: ${item.sentence}` : item.sentence)}</span></a>`,
);
const ways = [
  ["lab/index.html", "Lab", "Change a beam and see it move; no installation."],
  ...(book ? [["book/index.html", "Book", "Tutorial, guide and theory."]] : []),
  ...(existsSync(report) ? [["report.html", "Papers computed again", "Figures and claims of five papers with the errors of the numbers."]] : []),
];
writeFileSync(
  join(site, "index.html"),
  `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src 'self' data:; base-uri 'none'; form-action 'none'">
<meta name="color-scheme" content="light dark">
<meta name="description" content="Dynamics of rotating flexible beams: every number with its error.">
<link rel="icon" href="data:,">
<title>Flexion</title>
<style>
:root { --ink: #1c1f24; --dim: #5b626d; --rule: #d5d9de; --accent: #1f5fa8; --paper: #fff; color-scheme: light dark; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e7eb; --dim: #9aa3af; --rule: #363c45; --accent: #7db2ea; --paper: #15181c; } }
body { max-width: 68rem; margin: 0 auto; padding: 2rem 1rem 4rem; color: var(--ink); background: var(--paper); font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { margin: 0; font-size: 2rem; }
h2 { margin: 2rem 0 0.8rem; font-size: 1.2rem; }
p { max-width: 42rem; }
a { color: var(--accent); }
nav, .cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); gap: 1rem; }
nav a, .cards a { display: flex; flex-direction: column; gap: 0.3rem; padding: 0.8rem; color: var(--ink); text-decoration: none; border: 1px solid var(--rule); border-radius: 6px; }
nav a:hover, .cards a:hover { border-color: var(--accent); }
nav b { color: var(--accent); font-size: 1.1rem; }
nav span, .cards span { color: var(--dim); font-size: 0.9rem; }
.cards span { display: -webkit-box; -webkit-line-clamp: 3; -webkit-box-orient: vertical; overflow: hidden; }
.cards img { width: 100%; height: auto; }
</style>
</head>
<body>
<h1>Flexion</h1>
<p>How far does a beam bend while its hub spins up, how does it vibrate afterwards, what torque does the motion take? Flexion computes the motion of robot arms, blades, booms and systems of beams and bodies, and states the error of every number.</p>
<nav>
${ways.map(([address, name, words]) => `<a href="${address}"><b>${name}</b><span>${words}</span></a>`).join("\n")}
</nav>
<h2>Open one and change it</h2>
<div class="cards">
${cards.join("\n")}
</div>
<p><a href="lab/index.html">All ${items.length} cases are in the lab</a>, under “Cases”.</p>
</body>
</html>
`,
);
console.log(`site/ with ${ways.map(([, name]) => name.toLowerCase()).join(", ")}`);
