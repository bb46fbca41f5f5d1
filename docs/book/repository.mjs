// Files of the repository that the book shows besides its own pages, and where they stand in it.

import { existsSync, statSync } from "node:fs";
import { dirname, join, posix, relative, resolve, sep } from "node:path";
import { fileURLToPath } from "node:url";

export const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
export const source = join(root, "docs/src");

/** Folder of the book for files of the repository. */
export const FOLDER = "repository";

/** Path from the root of the repository to the file at which a link points, or nothing for other addresses. */
export function target(from, link) {
  if (/^[a-z]+:/i.test(link) || link.startsWith("#")) return undefined;
  const path = resolve(root, dirname(from), decodeURIComponent(link.split("#")[0]));
  if (!existsSync(path)) throw new Error(`${from}: there is no ${link}`);
  const page = statSync(path).isDirectory() ? join(path, "README.md") : path;
  return relative(root, existsSync(page) ? page : path).split(sep).join("/");
}

/** Where a file of the repository stands in the book. */
export function inBook(path) {
  const own = posix.relative("docs/src", path);
  if (!own.startsWith("..")) return own;
  // mdBook makes an index of a README.
  return `${FOLDER}/${path.replace(/\/README\.md$/, ".md").replace(/^README\.md$/, "readme.md")}`;
}
