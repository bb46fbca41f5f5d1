// Builds the book into target/book and checks its links: `npm ci && npm run build` here, with mdBook on the path.

import { execFileSync } from "node:child_process";
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { FOLDER, root } from "./repository.mjs";

const book = join(root, "target/book");
execFileSync("mdbook", ["build", join(root, "docs")], { stdio: "inherit" });
const katex = join(import.meta.dirname, "node_modules/katex/dist");
for (const part of ["katex.min.css", "fonts"]) cpSync(join(katex, part), join(book, "katex", part), { recursive: true });

const pages = readdirSync(book, { recursive: true }).filter((name) => name.endsWith(".html"));
const text = new Map(pages.map((name) => [join(book, name), readFileSync(join(book, name), "utf8")]));
const broken = [];
let links = 0;
for (const [page, html] of text) {
  for (const [, link] of html.matchAll(/\s(?:href|src)="([^"]*)"/g)) {
    if (/^([a-z]+:|#$|$)/i.test(link)) continue;
    links += 1;
    const [path, anchor] = decodeURIComponent(link).split("#");
    const file = path === "" ? page : join(dirname(page), path);
    // A file of the repository that is no page is shown as it is.
    const own = relative(join(book, FOLDER), file);
    if (!existsSync(file) && !own.startsWith("..") && existsSync(join(root, own))) {
      mkdirSync(dirname(file), { recursive: true });
      cpSync(join(root, own), file, { recursive: true });
    }
    if (!existsSync(file)) broken.push(`${relative(book, page)}: there is no ${link}`);
    else if (anchor && text.has(file) && !text.get(file).includes(`id="${anchor}"`)) {
      broken.push(`${relative(book, page)}: no heading ${link}`);
    }
  }
}
if (broken.length) {
  console.error([...new Set(broken)].join("\n"));
  process.exit(1);
}
console.log(`${pages.length} pages, ${links} links, none of them dead`);
