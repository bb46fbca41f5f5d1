// Preprocessor of mdBook: typesets equations, and adds the pages of the repository to which the book links.

import { readFileSync } from "node:fs";
import { join, posix } from "node:path";
import katex from "katex";
import { FOLDER, inBook, root, target } from "./repository.mjs";

if (process.argv[2] === "supports") process.exit(0);

const [, book] = JSON.parse(readFileSync(0, "utf8"));
const items = book.items ?? book.sections;
/** Pages of the repository that are linked to, with their text once they are read. */
const added = new Map();

const typeset = (text) =>
  katex.renderToString(text.trim(), { displayMode: true, throwOnError: true, strict: "error" }).replaceAll("\n", " ");

/** A page of the book that stands at `path` in the repository. */
function page(text, path) {
  const here = posix.dirname(inBook(path));
  const link = (whole, before, address) => {
    const file = target(path, address);
    if (file === undefined) return whole;
    if (file.endsWith(".md") && inBook(file).startsWith(FOLDER) && !added.has(file)) added.set(file, undefined);
    const anchor = address.includes("#") ? address.slice(address.indexOf("#")) : "";
    return `${before}(${posix.relative(here, inBook(file))}${anchor})`;
  };
  let equations = 0;
  const fenced = text.split(/^(```[^\n]*\n[\s\S]*?^```[ ]*$)/m).map((part) => {
    if (part.startsWith("```math")) {
      equations += 1;
      return `<div class="equation" style="overflow-x: auto">${typeset(part.slice(7, part.lastIndexOf("```")))}</div>\n`;
    }
    if (part.startsWith("```")) return part;
    return part.replace(/(\])\(([^()\s]+)\)/g, link);
  });
  const up = posix.relative(here, ".");
  const style = `<link rel="stylesheet" href="${up ? `${up}/` : ""}katex/katex.min.css">\n\n`;
  return (equations ? style : "") + fenced.join("");
}

function chapters(list) {
  for (const { Chapter: chapter } of list) {
    if (!chapter?.path) continue;
    chapter.content = page(chapter.content, `docs/src/${chapter.source_path ?? chapter.path}`);
    chapters(chapter.sub_items);
  }
}

chapters(items);
for (let open = true; open; ) {
  open = false;
  for (const [path, text] of added) {
    if (text !== undefined) continue;
    added.set(path, page(readFileSync(join(root, path), "utf8"), path));
    open = true;
  }
}
const chapter = (path, parent_names, sub_items = []) => ({
  Chapter: {
    name: added.get(path).match(/^# (.*)$/m)?.[1].replaceAll("`", "") ?? path,
    content: added.get(path),
    number: null,
    sub_items,
    path: inBook(path),
    source_path: null,
    parent_names,
  },
});
const paths = [...added.keys()].sort();
const cases = paths.filter((path) => /^verification\/[^/]+\/README\.md$/.test(path));
const index = "verification/README.md";
if (cases.length && !added.has(index)) throw new Error(`no page links to ${index}`);
items.push({ PartTitle: "From the repository" });
for (const path of paths.filter((path) => !cases.includes(path))) {
  const name = "Verification";
  items.push(chapter(path, [], path === index ? cases.map((path) => chapter(path, [name])) : []));
}
process.stdout.write(JSON.stringify(book));
