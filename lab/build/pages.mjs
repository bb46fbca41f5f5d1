// Builds the pages: dist/view.html, of `flexion view`; dist/index.html with its engine beside it; dist/lab.html with the engine within.
//
//     node build/pages.mjs [ENGINE.wasm]
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";

/** Most bytes of what is loaded, compressed. The engine came to 1,449 kB with contacts that rub in space, nets and gradients for cone problems, to 1,460 with
 *  what takes up runs within bursts, refuses contacts that nothing stops and gives those at rest their forces, and to 1,465 with narrow loads in space. */
const MOST = { "view.html": 175e3, "index.html": 350e3, "engine.wasm": 1_470e3 };

const lab = join(import.meta.dirname, "..");
const run = (...words) => execFileSync("npx", words, { cwd: lab, stdio: ["ignore", "ignore", "inherit"] });
const file = (name) => join(lab, "dist", name);
const kilobytes = (bytes) => `${(bytes.length / 1000).toFixed(0)} kB`;

/** Holds a file to its limit. */
function small(name, bytes) {
  if (bytes.length <= MOST[name]) return;
  console.error(`${name} has ${bytes.length} bytes compressed, and ${MOST[name]} are the most: find what has grown, or raise the limit in build/pages.mjs and say why`);
  process.exitCode = 1;
}

/** A module without its custom sections, which hold names. */
function stripped(module) {
  const kept = [module.subarray(0, 8)];
  for (let at = 8; at < module.length; ) {
    const start = at;
    const id = module[at++];
    let [size, shift] = [0, 0];
    for (let more = true; more; shift += 7) {
      const byte = module[at++];
      size += (byte & 127) * 2 ** shift;
      more = byte > 127;
    }
    at += size;
    if (id !== 0) kept.push(module.subarray(start, at));
  }
  return Buffer.concat(kept);
}

execFileSync("node", [join(lab, "build/gather.mjs")], { stdio: "inherit" });
run("tsc");
run("vite", "build", "--mode", "view");
run("vite", "build", "--mode", "editor");
run("vite", "build");
const page = readFileSync(file("index.html"), "utf8");
const large = readFileSync(join(lab, "made/files.json"), "utf8");
mkdirSync(file("files"), { recursive: true });
for (const [name, text] of Object.entries(JSON.parse(large))) writeFileSync(join(lab, "dist/files", name), text);
const pages = { "view.html": gzipSync(readFileSync(file("view.html"))), "index.html": gzipSync(page) };
console.log(Object.entries(pages).map(([name, packed]) => `${name} ${kilobytes(packed)}`).join(", "), "compressed");
for (const [name, packed] of Object.entries(pages)) small(name, packed);

const engine = process.argv[2] ?? join(lab, "../target/wasm32-unknown-unknown/wasm/flexion_lab.wasm");
if (existsSync(engine)) {
  const module = stripped(readFileSync(engine));
  const packed = gzipSync(module, { level: 9 });
  writeFileSync(file("engine.wasm"), module);
  small("engine.wasm", packed);
  const within = page.replace(/<script>[\s\S]*?<\/script>/, "").replace(">the engine<", () => `>${packed.toString("base64")}<`).replace(">{}<", () => `>${large.replaceAll("<", "\\u003c")}<`);
  writeFileSync(file("lab.html"), within);
  console.log(`engine.wasm ${kilobytes(packed)} compressed, lab.html ${kilobytes(readFileSync(file("lab.html")))} with it within`);
} else {
  console.log(`there is no engine at ${engine}: index.html needs engine.wasm beside it`);
}
