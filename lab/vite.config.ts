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

export default defineConfig(({ mode }) => {
  if (mode === "editor") {
    const lib = { entry: "src/editor.ts", formats: ["iife" as const], name: "CaseEditor", fileName: () => "editor.js" };
    return { publicDir: false, build: { outDir: "made", emptyOutDir: false, lib } };
  }
  const page = mode === "view" ? "view.html" : "index.html";
  return {
    base: "./",
    publicDir: false,
    plugins: [licences(mode), viteSingleFile({ removeViteModuleLoader: true }), editor, policy],
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
