// What may stand at a place of a case, by the schema.
import type { Schema } from "./engine";

/** A word that may be written, and what it means. */
export interface Word {
  word: string;
  meaning: string;
  /** What is put in. */
  text: string;
}

/** Where the cursor stands. */
export interface Place {
  /** Tables from the outside in. */
  path: string[];
  /** The kind of the innermost table, where it is said. */
  kind?: string;
  /** The key whose value is being written. */
  key?: string;
  /** What has been written of the word. */
  begun: string;
}

/** The place at the end of `before`, with `after` behind it. */
export function place(before: string, after: string): Place {
  const headings = [...before.matchAll(/^[ \t]*\[{1,2}([^\]\n]+)\]{1,2}/gm)];
  const heading = headings.at(-1);
  const start = heading ? heading.index + heading[0].length : 0;
  const path = heading ? heading[1].split(".").map((part) => part.trim()) : [];
  const rest = after.split(/^[ \t]*\[/m)[0];
  let own = before.slice(start) + rest;
  // Inline tables that are open on this line.
  const line = before.slice(before.lastIndexOf("\n") + 1);
  const open: number[] = [];
  let quoted = "";
  for (let i = 0; i < line.length; i++) {
    const c = line[i];
    if (quoted) quoted = c === quoted ? "" : quoted;
    else if (c === '"' || c === "'") quoted = c;
    else if (c === "#") break;
    else if (c === "{") open.push(i);
    else if (c === "}") open.pop();
  }
  for (const at of open) {
    const key = line.slice(0, at).match(/([\w.-]+)\s*=\s*\[?\s*$/);
    if (key) path.push(...key[1].split("."));
    own = line.slice(at + 1) + after.split(/[}\n]/)[0];
  }
  const kind = own.match(/\bkind\s*=\s*["']([\w-]+)["']/)?.[1];
  const part = line.slice((open.at(-1) ?? -1) + 1);
  const value = part.match(/(?:^|,)\s*([\w-]+)\s*=\s*["']?([^,"']*)$/);
  if (value) return { path, kind, key: value[1], begun: value[2].trimStart() };
  return { path, kind, begun: part.match(/([\w-]*)$/)![1] };
}

function alternatives(schema: Schema): Schema[] {
  const further = [...(schema.anyOf ?? []), ...(schema.oneOf ?? []), ...(schema.items ? [schema.items] : [])];
  return [schema, ...further.flatMap(alternatives)];
}

/** The tables at a path. */
function tables(root: Schema, path: string[], kind?: string): Schema[] {
  let found = alternatives(root);
  for (const name of path) {
    const next = found.flatMap((schema) => (schema.properties?.[name] ? alternatives(schema.properties[name]) : []));
    found = next;
  }
  const ofKind = found.filter((schema) => schema.properties?.kind?.const === kind);
  return kind && ofKind.length > 0 ? ofKind : found;
}

export function words(root: Schema, { path, kind, key }: Place): Word[] {
  const out = new Map<string, Word>();
  const add = (word: string, meaning: string, text = word) => out.set(word, out.get(word) ?? { word, meaning, text });
  for (const table of tables(root, path, kind)) {
    if (key === undefined) {
      for (const [name, schema] of Object.entries(table.properties ?? {})) add(name, described(schema), `${name} = `);
      continue;
    }
    for (const schema of table.properties?.[key] ? alternatives(table.properties[key]) : []) {
      if (schema.const !== undefined) add(schema.const, schema.description ?? "");
      for (const value of schema.enum ?? []) add(value, "");
      for (const example of schema.examples ?? []) add(String(example), schema.title ?? "an example");
      if (schema.type === "boolean") for (const value of ["true", "false"]) add(value, "");
      // The kinds of a table, written as an inline table.
      const of = schema.properties?.kind?.const;
      if (of) add(`{ kind = "${of}" }`, schema.description ?? "");
    }
  }
  return [...out.values()];
}

const described = (schema: Schema) => schema.description ?? schema.title ?? "";
