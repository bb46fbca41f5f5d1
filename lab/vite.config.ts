// Pages with all in them: scripts, styles, and the licences of what is inlined. `--mode view` builds the page of `flexion view`.
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { defineConfig, type Plugin } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

const inlined = (mode: string) => {
  const { dependencies } = JSON.parse(readFileSync("package.json", "utf8"));
  const names = Object.keys(dependencies);
  return mode === "view" ? names.filter((name) => ["three", "uplot"].includes(name)) : [...names, ...further];
};
/** What the editor needs besides. */
const further = ["@lezer/common", "@lezer/highlight", "@marijn/find-cluster-break", "crelt", "style-mod", "w3c-keyname"];

const licences = (mode: string): Plugin => ({
  name: "licences",
  transformIndexHtml: (html) => {
    const texts = new Map<string, string[]>();
    for (const name of inlined(mode)) {
      const { version } = JSON.parse(readFileSync(`node_modules/${name}/package.json`, "utf8"));
      const text = readFileSync(`node_modules/${name}/LICENSE`, "utf8").trim();
      texts.set(text, [...(texts.get(text) ?? []), `${name} ${version}`]);
    }
    const all = [...texts].map(([text, names]) => `${names.join(", ")}\n\n${text}\n`);
    return html.replace("<html", `<!--\nThis page holds these libraries.\n\n${all.join("\n")}-->\n<html`);
  },
});

/** The editor's code as text, which is run when the editor is first looked at. */
const editor: Plugin = {
  name: "editor",
  transformIndexHtml: {
    order: "post",
    handler: (html) => {
      if (!html.includes(">the editor<")) return html;
      const code = readFileSync("made/editor.js", "utf8").trim().replaceAll("</script", "<\\/script");
      if (code.includes("<!--")) throw new Error("the code of the editor cannot stand in a page: it holds a comment of HTML");
      return html.replace(">the editor<", () => `>${code}<`);
    },
  },
};

/** Only the scripts that are in the page may run: their hashes take the place of `'unsafe-inline' SCRIPTS` in the policy. */
const policy: Plugin = {
  name: "policy",
  writeBundle({ dir }, bundle) {
    for (const name of Object.keys(bundle).filter((name) => name.endsWith(".html"))) {
      const file = join(dir!, name);
      const html = readFileSync(file, "utf8");
      const scripts = [...html.matchAll(/<script(?: type="module"[^>]*| type="text\/plain" id="editor")?>([\s\S]*?)<\/script>/g)];
      const hashes = scripts.map(([, text]) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`);
      writeFileSync(file, html.replace("'unsafe-inline' SCRIPTS", hashes.join(" ")));
    }
  },
};

const THREE = "node_modules/three";
const SHADERS = `${THREE}/src/renderers/shaders`;
/** What three.js draws surfaces and lines of `stage.ts` with, and what it puts before every shader. */
const USED = [
  ...["meshbasic", "meshlambert"].map((name) => `${SHADERS}/ShaderLib/${name}.glsl.js`),
  `${THREE}/examples/jsm/lines/LineMaterial.js`,
  `${THREE}/src/renderers/webgl/WebGLProgram.js`,
];

let kept: Set<string>;

/** Shaders of other materials than those in use are left out, and comments of the rest: 20 kB of what is compressed. */
const shaders: Plugin = {
  name: "shaders",
  buildStart: () => void (kept = needed()),
  transform(code, id) {
    const file = id.match(/\/shaders\/(ShaderLib|ShaderChunk)\/(\w+)\.glsl\.js$/);
    if (!file) return;
    const shortened = (text: string) => text.split("\n").map((line) => line.replace(/\/\/.*/, "").trim()).filter(Boolean).join("\n");
    return code.replace(/`([^`]*)`/g, (_, text) => (kept.has(`${SHADERS}/${file[1]}/${file[2]}.glsl.js`) ? `\`\n${shortened(text)}\n\`` : '""'));
  },
};

/** The files of the shaders in use, with what they include. */
function needed(): Set<string> {
  const [kept, open] = [new Set<string>(), [...USED]];
  for (let file = open.pop(); file; file = open.pop()) {
    if (kept.has(file)) continue;
    kept.add(file);
    for (const [, name] of readFileSync(file, "utf8").matchAll(/(?:#include +<|ShaderChunk\[ ')(\w+)/g)) open.push(`${SHADERS}/ShaderChunk/${name}.glsl.js`);
  }
  return kept;
}

export default defineConfig(({ mode }) => {
  if (mode === "editor") {
    const lib = { entry: "src/editor.ts", formats: ["iife" as const], name: "CaseEditor", fileName: () => "editor.js" };
    return { publicDir: false, build: { outDir: "made", emptyOutDir: false, lib } };
  }
  const page = mode === "view" ? "view.html" : "index.html";
  return {
    base: "./",
    publicDir: false,
    // Its sources, of which only what is used is taken.
    resolve: { alias: [{ find: /^three$/, replacement: "three/src/Three.js" }] },
    plugins: [shaders, licences(mode), viteSingleFile({ removeViteModuleLoader: true }), editor, policy],
    worker: { format: "iife" },
    build: {
      outDir: "dist",
      emptyOutDir: false,
      assetsInlineLimit: 1e8,
      chunkSizeWarningLimit: 4000,
      modulePreload: false,
      rollupOptions: { input: page },
    },
  };
});
