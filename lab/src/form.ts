// The case as a form: sliders for numbers, lists for kinds.
import { tag } from "./curves";
import type { Entry } from "./engine";

/** A slider leads from the value over this factor to its product with it. */
const REACH = 4;
/** Time for which a slider that was moved stays where it is [ms]. */
const HELD = 600;
/** Steps of a slider. */
const STEPS = 200;

/** A quantity as it is written: its number, and the unit behind. */
export function quantity(value: string): { number: number; unit: string } | undefined {
  const plain = value.trim().replace(/^["']|["']$/g, "");
  const found = plain.match(/^([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([A-Za-zµμ°%1(].*)?$/);
  return found ? { number: Number(found[1]), unit: found[2] ?? "" } : undefined;
}

/** A largest speed, if it is one. */
export function largest(most?: string): string | undefined {
  const number = quantity(most ?? "")?.number ?? 0;
  return number > 0 && Number.isFinite(number) ? most : undefined;
}

/** A value as it stands in the case, or with its unit in SI; without the quotes of a text. */
export function written({ written, value, unit, number }: Entry): string {
  const plain = (written ?? value).trim().replace(/^("""|'''|""|''|"|')\r?\n?(.*)\1$/s, "$2");
  return written || !unit || number === null || number === undefined ? plain : `${number} ${unit}`;
}

/** A kind with the table of its example. */
export function example(path: string, { name, example }: { name: string; example: string }) {
  const own = path.split(".").at(-1)!;
  const table = new RegExp(`(?:^|[\\s{,])${own}\\s*=\\s*(\\{.*)`, "s").exec(example)?.[1];
  if (!table) return { name, example: `{ kind = "${name}" }` };
  let depth = 0;
  const end = [...table].findIndex((c) => (depth += c === "{" ? 1 : c === "}" ? -1 : 0) === 0);
  return { name, example: table.slice(0, end + 1) };
}

/** A key in words: `section.second-moment` is the second moment of the section. */
const word = (key: string) => key.replaceAll("-", " ");

interface Row {
  node: HTMLElement;
  /** Takes the value of the entry, unless the user holds the control. */
  take(entry: Entry): void;
}

export class Form {
  private rows = new Map<string, Row>();
  private shape = "";
  private everything = false;
  private entries: Entry[] = [];
  private kinds = new Map<string, { name: string; example: string }[]>();

  /** `changed` is told of a value that the user chose; `sliding` says that more will follow. */
  constructor(
    private readonly into: HTMLElement,
    private readonly changed: (key: string, value: string, sliding: boolean) => void,
  ) {}

  /** Kinds of tables with the keys of an example, by their paths. */
  offer(kinds: Map<string, { name: string; example: string }[]>) {
    // What is being typed is not taken away.
    if (this.into.contains(document.activeElement)) {
      this.into.addEventListener("focusout", () => setTimeout(() => this.offer(kinds)), { once: true });
      return;
    }
    this.kinds = kinds;
    this.shape = "";
    this.show(this.entries);
  }

  show(entries: Entry[]) {
    this.entries = entries;
    const shown = entries.filter(({ takes, default: left }) => !["table", "tables"].includes(takes) && (this.everything || !left));
    const shape = JSON.stringify(shown.map(({ path, takes }) => [path, takes]));
    if (shape !== this.shape) this.build(shown);
    this.shape = shape;
    for (const entry of shown) this.rows.get(entry.path)?.take(entry);
  }

  private build(entries: Entry[]) {
    this.rows = new Map(entries.map((entry) => [entry.path, this.row(entry)]));
    const groups = new Map<string, Entry[]>();
    for (const entry of entries) {
      const [head, ...rest] = entry.path.split(".");
      const tabled = rest.length > 0 || entries.some(({ path }) => path.startsWith(`${head}.`));
      const group = tabled ? head.replace("[", " ").replace("]", "") : "case";
      groups.set(group, [...(groups.get(group) ?? []), entry]);
    }
    const all = tag("input", { type: "checkbox" });
    all.checked = this.everything;
    all.addEventListener("change", () => {
      this.everything = all.checked;
      this.show(this.entries);
    });
    const nodes = [...groups].map(([name, members]) =>
      tag("fieldset", {}, tag("legend", {}, word(name)), ...members.map(({ path }) => this.rows.get(path)!.node)),
    );
    const order = (node: HTMLElement) => (node.textContent?.startsWith("case") ? 1 : 0);
    nodes.sort((a, b) => order(a) - order(b));
    this.into.replaceChildren(...nodes, tag("label", { class: "all" }, all, "Values that are left out of the case, too"));
  }

  private row(entry: Entry): Row {
    const { path: key, takes, doc: meaning } = entry;
    const kinds = this.kinds.get(entry.choice ?? "");
    const choices = entry.choices ?? kinds?.map(({ name }) => name);
    const [head, ...rest] = key.split(".");
    const name = rest.length > 0 ? rest.join(" ") : takes === "kind" ? "kind" : head;
    const label = tag("label", { for: `key-${key}`, title: meaning }, word(name));
    const help = tag("p", { class: "meaning" }, meaning);
    if (takes === "boolean") {
      const box = tag("input", { type: "checkbox", id: `key-${key}` });
      box.addEventListener("change", () => this.changed(key, String(box.checked), false));
      const node = tag("div", { class: "row" }, label, box, help);
      return { node, take: (now) => (box.checked = written(now) === "true") };
    }
    if (choices?.length) {
      const select = tag("select", { id: `key-${key}` }, ...choices.map((choice) => new Option(word(choice), choice)));
      // Another kind has other keys: it begins with those of its example.
      const whole = (name: string) => kinds?.find((kind) => kind.name === name)?.example ?? name;
      select.addEventListener("change", () => this.changed(key, whole(select.value), false));
      const node = tag("div", { class: "row" }, label, select, help);
      return { node, take: (now) => (select.value = kinds ? now.value : written(now)) };
    }
    const box = tag("input", { type: "text", id: `key-${key}`, autocomplete: "off", spellcheck: "false" });
    box.addEventListener("change", () => this.changed(key, box.value, false));
    const slid = ["number", "quantity", "integer"].includes(takes) && quantity(written(entry));
    const slider = slid ? this.slider(entry, box) : undefined;
    const node = tag("div", { class: slider ? "row slid" : "row" }, label, box, ...(slider ? [slider.node] : []), help);
    return {
      node,
      take: (now) => {
        if (slider?.held()) return;
        if (document.activeElement !== box) box.value = written(now);
        slider?.take(now);
      },
    };
  }

  /** A slider over the number in front of the unit; its middle is the value that it was made with. */
  private slider(entry: Entry, box: HTMLInputElement) {
    const { path: key, takes } = entry;
    const node = tag("input", { type: "range", min: "0", max: String(STEPS), step: "1", "aria-label": word(key) });
    let middle = quantity(written(entry))!;
    // Bounds are in SI: a number in another unit is held to them by the engine alone.
    const range = middle.unit === entry.unit || middle.unit === "" ? entry.range : undefined;
    const limit = (x: number) => Math.min(Math.max(x, range?.least ?? -Infinity), range?.most ?? Infinity);
    const at = (step: number) => {
      const share = (2 * step) / STEPS - 1;
      if (middle.number === 0) return limit(share);
      return limit(middle.number * REACH ** share);
    };
    const step = (x: number) => {
      const share = middle.number === 0 ? x : Math.log(x / middle.number) / Math.log(REACH);
      return (STEPS * (share + 1)) / 2;
    };
    const write = () => {
      const x = at(Number(node.value));
      const number = takes === "integer" ? String(Math.round(x)) : String(Number(x.toPrecision(3)));
      return middle.unit ? `${number} ${middle.unit}` : number;
    };
    let touched = -Infinity;
    const slide = (more: boolean) => {
      touched = performance.now();
      box.value = write();
      node.setAttribute("aria-valuetext", box.value);
      this.changed(key, box.value, more);
    };
    node.addEventListener("input", () => slide(true));
    node.addEventListener("change", () => slide(false));
    // An answer that comes while the slider moves is of an earlier place.
    const held = () => performance.now() - touched < HELD;
    const take = (entry: Entry) => {
      const value = written(entry);
      const now = quantity(value);
      if (!now) return;
      const place = step(now.number);
      if (!(place >= 0 && place <= STEPS) || now.unit !== middle.unit) middle = now;
      node.value = String(Math.round(step(now.number)));
      node.setAttribute("aria-valuetext", value);
    };
    return { node, take, held };
  }
}
