// One page with all in it: scripts, styles, and the licences of what is inlined.
import { readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

const inlined = ["three", "uplot"];

const licences: Plugin = {
  name: "licences",
  transformIndexHtml: (html) => {
    const texts = inlined.map((name) => {
      const { version } = JSON.parse(readFileSync(`node_modules/${name}/package.json`, "utf8"));
      return `${name} ${version}\n\n${readFileSync(`node_modules/${name}/LICENSE`, "utf8").trim()}\n`;
    });
    return html.replace("<html", `<!--\nThis page holds two libraries.\n\n${texts.join("\n")}-->\n<html`);
  },
};

export default defineConfig({
  base: "./",
  plugins: [licences, viteSingleFile({ removeViteModuleLoader: true })],
  build: { outDir: "dist", assetsInlineLimit: 1e8, chunkSizeWarningLimit: 2000, modulePreload: false },
});
