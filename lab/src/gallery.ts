// The gallery: cases of the verification and items of the papers.
import stored from "../made/gallery.json";
import { tag } from "./curves";
import type { Kind } from "./engine";

export interface Run {
  name: string;
  title?: string;
  set: string[];
  /** Where it is not that of the item. */
  case?: string;
  do?: Kind;
  speed?: string;
}

export interface Item {
  id: string;
  group: string;
  title: string;
  sentence: string;
  case: string;
  source?: string;
  page?: string;
  do?: Kind;
  speed?: string;
  runs: Run[];
}

/** Texts of files by the names that a case has for them; a large one lies beside the page, under a name of its own. */
type Files = Record<string, string | { beside: string }>;

interface Case {
  text: string;
  files: Files;
}

const gallery = stored as unknown as { cases: Record<string, Case>; items: Item[] };
const items = new Map(gallery.items.map((item) => [item.id, item]));
const cases = new Map(Object.entries(gallery.cases));

export const first = "p1_spin_up_4";

/** An item with one of its runs. */
export function named(id: string, run?: string): { item: Item; run: Run; text: string; files: Files; path: string } | undefined {
  const item = items.get(id);
  const found = item && (run === undefined ? item.runs[0] : item.runs.find(({ name }) => name === run));
  const path = found?.case ?? item?.case;
  const of = path === undefined ? undefined : cases.get(path);
  return item && found && of && { item, run: found, text: of.text, files: of.files, path: path! };
}

/** The texts of files; large ones are within the page, or else beside it. */
export async function texts(files: Files): Promise<Record<string, string>> {
  const within = JSON.parse(document.getElementById("files")?.textContent ?? "{}") as Record<string, string>;
  const found = Object.entries(files).map(async ([name, text]): Promise<[string, string]> => {
    if (typeof text === "string") return [name, text];
    const { beside } = text;
    if (Object.hasOwn(within, beside)) return [name, within[beside]];
    const answer = await fetch(`files/${beside}`);
    if (!answer.ok) throw new Error(`The file ${name} of this case cannot be read.`);
    return [name, await answer.text()];
  });
  return Object.fromEntries(await Promise.all(found));
}

/** The name that is nearest to one that there is not. */
export function nearest(id: string): string | undefined {
  const words = id.toLowerCase().split(/[^a-z0-9]+/).filter(Boolean).slice(0, 20);
  const score = (name: string) => words.filter((word) => name.toLowerCase().includes(word)).length;
  const best = [...items.keys()].sort((a, b) => score(b) - score(a))[0];
  return score(best) > 0 ? best : undefined;
}

/** Names of the pictures that a site has beside the page. */
const pictures = new Set(JSON.parse(document.getElementById("pictures")?.textContent ?? "[]") as string[]);

function card(item: Item): HTMLElement {
  const link = tag("a", { class: "card", href: `#case=${encodeURIComponent(item.id).replaceAll("%2F", "/")}` });
  const name = `${item.id.replace("/", "-")}.svg`;
  if (pictures.has(name)) link.append(tag("img", { src: `pictures/${name}`, alt: "", loading: "lazy", width: "200", height: "120" }));
  link.append(tag("b", {}, item.title), tag("span", {}, item.sentence));
  return link;
}

/** Fills the dialog; choosing a card closes it. */
export function fill(dialog: HTMLDialogElement) {
  const search = tag("input", { type: "search", "aria-label": "Search the gallery", placeholder: "Search: blade, contact, roll-up …" });
  const close = tag("button", { type: "button" }, "Close");
  const groups = Map.groupBy(gallery.items, ({ group }) => group);
  const cards = new Map<Item, HTMLElement>();
  const sections = [...groups].map(([name, members]) => {
    for (const item of members) cards.set(item, card(item));
    const source = members[0].source;
    const head = tag("h3", {}, name);
    const nodes = members.map((item) => cards.get(item)!);
    const about = source ? [tag("p", { class: "caption" }, source)] : [];
    return tag("section", {}, head, ...about, tag("div", { class: "cards" }, ...nodes));
  });
  search.addEventListener("input", () => {
    const wanted = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const [item, node] of cards) {
      const text = `${item.id} ${item.title} ${item.sentence} ${item.group}`.toLowerCase();
      node.hidden = !wanted.every((word) => text.includes(word));
    }
    for (const section of sections) section.hidden = !section.querySelector(".card:not([hidden])");
  });
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog || (event.target as HTMLElement).closest(".card")) dialog.close();
  });
  const bar = tag("div", { class: "bar" }, tag("h2", {}, "Cases"), search, close);
  dialog.replaceChildren(bar, ...sections);
}
