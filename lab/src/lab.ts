// The lab: a case as form and text, and its answer, which follows it.
import "./style.css";
import "./lab.css";
import "./answer.css";
import "./screens.css";
import { Answer, type Pin } from "./answer";
import { tag } from "./curves";
import { Computer, type Asked } from "./computer";
import { campbell } from "./diagram";
import { base64, bytes, type Entry, type Kind, type Problem, type Reply } from "./engine";
import { Form, quantity, written } from "./form";
import * as gallery from "./gallery";
import { Growing } from "./growing";
import { read, write, LARGEST, LONGEST, type Link } from "./link";
import { Room } from "./room";
import * as save from "./save";
import { Source } from "./source";
import { inRadians } from "./text";
import { warm } from "./stage";
import { zip } from "./zip";

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const all = (selector: string) => [...document.querySelectorAll<HTMLElement>(selector)];

/** What is shown: a case, where it is from, and what is asked of it. */
interface State {
  text: string;
  /** Files that the case names, in base64. */
  files: Record<string, string>;
  /** Of the gallery. */
  item?: gallery.Item;
  run?: gallery.Run;
  kind: Kind;
  /** Speed of modes. */
  speed?: string;
  /** Largest speed of a Campbell diagram. */
  most?: string;
  /** It has not been read yet. */
  fresh?: boolean;
  /** The version that the link names. */
  version?: string;
}

const room = new Room(element("subtitle"));
element("answer").prepend(room.stage);
element("notes").after(room.curves);
element("answer").after(room.footer);

const embedded = new URLSearchParams(location.search).has("embed");
document.body.classList.toggle("embed", embedded);

let state: State = { text: "", files: {}, kind: "run" };
let entries: Entry[] = [];
let shown: { kind: Kind; reply: Reply } | undefined;
let pin: Pin | undefined;
let version = "";
/** The diagram whose modes are looked at. */
let diagram: Reply | undefined;

const growing = new Growing(element("growing"));
const computer = new Computer({ checked, answered, said, failed, grown: (rows, end) => (rows ? growing.add(rows, end ?? 0) : growing.clear()) });
const source = new Source(element("text"), (text) => {
  state.text = text;
  diagram = undefined;
  revision += 1;
  wait(() => change(), 250);
});
const form = new Form(element("form"), (key, value, sliding) => set([`${key.replace(/\[(\d+)\]/g, ".$1")}=${value}`], sliding));
const answer = new Answer(room, element("notes"), element("values"), (speed) => {
  state.speed = speed;
  element<HTMLInputElement>("rotation").value = speed;
  change();
});

let waiting = 0;
function wait(act: () => void, milliseconds: number) {
  clearTimeout(waiting);
  stale();
  waiting = window.setTimeout(act, milliseconds);
}

/** An old answer never stands under a new case as if it were its own. */
function stale() {
  element("result").classList.add("stale");
  element("result").setAttribute("aria-busy", "true");
}

/** Counts the texts of the user and the cases that were opened. */
let revision = 0;

const asked = (): Asked => ({
  text: state.text,
  files: state.files,
  kind: state.kind,
  revision,
  speed: state.speed,
  range: range(),
  diagram: state.kind === "campbell" ? diagram : undefined,
});

/** A largest speed, if it is one. */
const largest = (most?: string) => ((quantity(most ?? "")?.number ?? 0) > 0 ? most : undefined);

/** Speeds of the Campbell diagram: from rest to what is chosen, or half as much again as the speed of the case. */
function range(): string | undefined {
  const own = quantity(speedOf());
  const most = quantity(state.most ?? "") ?? (own && own.number > 0 ? { ...own, number: Number((1.5 * own.number).toPrecision(2)) } : undefined);
  return most && most.number > 0 ? `0 ${most.unit || "rad/s"}:${most.number} ${most.unit || "rad/s"}:31` : undefined;
}

/** Speeds of the diagram that is shown. */
function speeds(): string {
  const of = diagram && campbell(diagram);
  const unit = of?.["speed-unit"];
  return range() ?? (of ? `0 ${unit}:${Number(of.speeds[of.speeds.length - 1].toPrecision(3))} ${unit}:31` : "0:10:31");
}

/** The case or what is asked of it has changed. */
function change(sliding = false) {
  stale();
  computer.want({ ...asked(), sliding });
  if (!sliding) remember();
}

/** Sets keys of the case. */
function set(changes: string[], sliding = false) {
  stale();
  diagram = undefined;
  computer.want({ ...asked(), set: changes, sliding });
}

/** The case has been read; whether it can be computed. */
function checked(reply: Reply, text: string, { revision: of, set, sliding }: Asked): boolean {
  // What has been written or opened since is newer.
  if (of !== revision) return false;
  if (set) source.text = state.text = text;
  const problems = reply.problems ?? [];
  const missing = state.kind === "run" && !state.fresh ? (reply.missing ?? []) : [];
  list([...problems, ...missing]);
  source.report(problems);
  if (reply.tables) {
    entries = reply.tables;
    form.show(entries);
    const title = entries.find(({ path }) => path === "title");
    name(title ? written(title) : "");
  }
  // A case without a run has modes; those of a case are at its own speed, which is known now.
  const modal = reply.missing?.length ? state.kind === "run" : state.kind === "modes" || state.kind === "campbell";
  if (state.fresh && modal && problems.length === 0) {
    if (state.kind === "run") state.kind = "modes";
    state.speed ??= speedOf();
    state.fresh = false;
    present();
    change();
    return false;
  }
  state.fresh = false;
  if (!sliding) remember();
  return problems.length === 0 && missing.length === 0;
}

function name(title: string) {
  const words = (title || state.item?.title || "A case").slice(0, 200);
  element("title").textContent = words;
  document.title = `${words} – Flexion lab`;
}

function list(problems: Problem[]) {
  const nodes = problems.slice(0, 20).map((problem) => {
    const go = tag("button", { type: "button" }, problem.line ? `Line ${problem.line}` : (problem.key ?? "Case"));
    go.addEventListener("click", () => {
      // A value that was not taken over stands in its box, and not in the text.
      const box = problem.line ? null : document.getElementById(`key-${problem.key}`);
      tab(box ? "form" : "text");
      if (box) return box.focus();
      source.go(problem.line ?? 1, problem.column ?? 1);
    });
    const help = [problem.label, ...(problem.help ?? [])].filter(Boolean).join("; ");
    const key = problem.key && problem.line ? `${problem.key}: ` : "";
    return tag("li", {}, go, ` ${key}${problem.message}`, ...(help ? [tag("small", {}, help)] : []));
  });
  if (problems.length > nodes.length) nodes.push(tag("li", {}, `and ${problems.length - nodes.length} more`));
  element("problems").replaceChildren(...nodes);
  if (problems.length > 0) said(problems.length === 1 ? "The case has a mistake." : `The case has ${problems.length} mistakes.`);
}

/** An answer has come. */
function answered(kind: Kind, reply: Reply, modes?: Reply) {
  const older = state.version && version && state.version !== version;
  const remark = older ? `The link was made with Flexion ${state.version}; these numbers are of Flexion ${version} and may differ.` : undefined;
  try {
    if (kind === "campbell") {
      diagram = reply;
      const { speeds, "speed-unit": unit } = campbell(reply);
      element<HTMLInputElement>("most").value ||= (range() ?? `0:${Number(speeds[speeds.length - 1].toPrecision(3))} ${unit}`).split(":")[1];
      // The speed of the modes may be in another unit than those of the diagram.
      const at = quantity(state.speed ?? "");
      const factor = at?.unit ? inRadians(at.unit) / inRadians(unit) : 1;
      answer.showCampbell(reply, modes, factor * (at?.number ?? 0), remark);
    } else answer.show(kind, reply, pin, remark);
    shown = { kind, reply };
    growing.clear();
    if (pin) void compare(pin);
    element("result").classList.remove("stale");
    element("result").removeAttribute("aria-busy");
    element("pin").toggleAttribute("disabled", kind !== "run" && !pin);
  } catch (error) {
    failed(`The answer cannot be drawn: ${(error as Error).message}`);
  }
}

/** Says what the pinned case has otherwise. */
async function compare({ text }: Pin) {
  const set = await computer.difference(text, state.text, state.files).catch(() => undefined);
  const note = document.querySelector("#notes .pinned");
  if (note && set?.length && set.length < 6) note.textContent = `Dashed: the pinned answer, with ${set.join(", ")}.`;
}

/** Says how far it is. */
function said(words: string, share?: number, act?: "compute" | "stop") {
  element("state").textContent = words;
  const progress = element<HTMLProgressElement>("progress");
  progress.hidden = share === undefined;
  if (share !== undefined) progress.value = share;
  element("compute").hidden = act !== "compute";
  element("stop").hidden = act !== "stop";
}

function failed(words: string) {
  said(words);
  element("state").classList.add("alert");
  setTimeout(() => element("state").classList.remove("alert"), 3000);
}

let hint = 0;
/** A short word about something done. */
function tell(words: string) {
  const said = element("said");
  said.textContent = words;
  said.classList.add("on");
  clearTimeout(hint);
  hint = window.setTimeout(() => said.classList.remove("on"), 4000);
}

// The link.

/** What was last put into the address. */
let written_ = "";
let remembering = 0;
/** Links that are being opened. */
let following = 0;
/** Whether the address leads elsewhere than to what is shown. */
const leads = () => following > 0 || location.hash.slice(1) !== written_;

/** The address says what is shown, if it leads nowhere else by then. */
function remember(push = false) {
  clearTimeout(remembering);
  const act = async () => {
    const before = written_;
    if (leads()) return;
    const fragment = await link().catch(() => "");
    if (fragment === written_ || before !== written_ || leads()) return;
    written_ = fragment;
    const address = `${location.pathname}${location.search}${fragment && `#${fragment}`}`;
    history[push ? "pushState" : "replaceState"](null, "", address);
  };
  if (push) void act();
  else remembering = window.setTimeout(act, 300);
}

/** The fragment of the link to what is shown. */
async function link(): Promise<string> {
  const common = { kind: state.kind, speed: state.kind === "run" ? undefined : state.speed, most: state.kind === "campbell" ? state.most : undefined, version };
  const item = state.item && gallery.named(state.item.id, state.run?.name);
  if (item) {
    const changes = item.run.set.length > 0 ? await computer.change(item.text, item.run.set, state.files) : item.text;
    const run = item.run === item.item.runs[0] ? undefined : item.run.name;
    if (changes === state.text) return write({ ...common, named: item.item.id, run, set: [] });
    const set = await computer.difference(state.text, changes, state.files);
    if (set) return write({ ...common, named: item.item.id, run, set });
  }
  const named = Object.keys(state.files).filter((name) => state.text.includes(name));
  if (named.length > 0) throw new Error(`A link cannot carry the files of this case (${named.join(", ")}): save the case as a file and pass that on.`);
  const fragment = await write({ ...common, text: state.text, set: [] });
  if (fragment.length > LONGEST || state.text.length > LARGEST) throw new Error("The case is too long for a link: save it as a file and pass that on.");
  return fragment;
}

/** Shows what the address says. */
async function follow() {
  const fragment = location.hash.slice(1);
  if (fragment === written_ && state.text) return;
  written_ = fragment;
  stale();
  list([]);
  said("opening …", undefined, "stop");
  following += 1;
  try {
    const asked = await read(fragment);
    // A newer address is followed instead.
    if (written_ === fragment) await open(asked);
  } catch (error) {
    if (written_ === fragment) refuse((error as Error).message);
  } finally {
    following -= 1;
  }
}

function refuse(message: string) {
  computer.stop();
  state = { text: "", files: {}, kind: "run" };
  [shown, diagram, entries] = [undefined, undefined, []];
  present();
  form.show(entries);
  source.report([]);
  answer.clear();
  room.stage.hidden = true;
  name("This link cannot be opened");
  element("problems").replaceChildren(tag("li", {}, message, " ", again()));
  said("");
}

/** A way on from a link that leads nowhere. */
function again() {
  return tag("a", { href: `#case=${gallery.first}` }, "Open a case that works");
}

/** Counts the cases that were to be opened. */
let openings = 0;

async function open(asked: Link) {
  const own = ++openings;
  computer.stop();
  computer.lifted = false;
  diagram = undefined;
  // What is known of the case before comes too late from here on.
  revision += 1;
  const kind = asked.kind ?? "run";
  if (asked.text !== undefined) {
    state = { text: asked.text, files: {}, kind, speed: asked.speed, most: largest(asked.most), version: asked.version, fresh: true };
  } else {
    const id = asked.named ?? gallery.first;
    const found = gallery.named(id, asked.run);
    if (!found) {
      const near = gallery.nearest(id);
      throw new Error(`There is no case “${id}”${asked.run ? ` with a run “${asked.run}”` : ""} in the gallery.${near ? ` The nearest is “${near}”.` : ""}`);
    }
    const files = Object.fromEntries(Object.entries(await gallery.texts(found.files)).map(([name, text]) => [name, base64(new TextEncoder().encode(text))]));
    const its = asked.named && asked.kind ? undefined : (found.run.do ?? found.item.do);
    const changes = [...found.run.set, ...asked.set];
    const text = changes.length > 0 ? await computer.change(found.text, changes, files) : found.text;
    const speed = asked.speed ?? found.run.speed ?? found.item.speed;
    // Another one was opened in the meantime.
    if (own !== openings) return;
    state = { text, files, item: found.item, run: found.run, kind: its ?? kind, speed, most: largest(asked.most), version: asked.version, fresh: true };
  }
  present();
  name("");
  change();
}

/** Shows the state beside the answer. */
function present() {
  revision += 1;
  source.text = state.text;
  const runs = state.item?.runs ?? [];
  element("runs").hidden = runs.length < 2;
  const select = element<HTMLSelectElement>("run");
  select.replaceChildren(...runs.map(({ name, title }) => new Option(title ?? name, name)));
  if (state.run) select.value = state.run.name;
  const sentence = element("sentence");
  sentence.replaceChildren(state.item?.sentence ?? "");
  if (state.item?.page && location.protocol.startsWith("http")) sentence.append(" ", tag("a", { href: `../book/${state.item.page}` }, "Read more"));
  for (const node of all("[data-kind]")) node.setAttribute("aria-selected", String(node.dataset.kind === state.kind));
  element("speeds").hidden = state.kind !== "modes" && state.kind !== "campbell";
  element<HTMLInputElement>("rotation").value = state.speed ?? "";
  element("mosts").hidden = state.kind !== "campbell";
  element<HTMLInputElement>("most").value = state.most ?? "";
}

// Controls.

function tab(which: "form" | "text") {
  for (const name of ["form", "text"]) {
    element(name).hidden = name !== which;
    element(`tab-${name}`).setAttribute("aria-selected", String(name === which));
  }
  if (which === "text") source.shown();
}

for (const name of ["form", "text"] as const) element(`tab-${name}`).addEventListener("click", () => tab(name));
for (const list of all('[role="tablist"]')) {
  list.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const tabs = [...list.querySelectorAll<HTMLElement>('[role="tab"]')];
    const at = tabs.indexOf(event.target as HTMLElement);
    if (!by || at < 0) return;
    event.preventDefault();
    event.stopPropagation();
    const next = tabs[(at + by + tabs.length) % tabs.length];
    next.focus();
    next.click();
  });
}
for (const node of all("[data-kind]")) {
  node.addEventListener("click", () => {
    state.kind = node.dataset.kind as Kind;
    if (state.kind === "modes" || state.kind === "campbell") state.speed ??= speedOf();
    present();
    list([]);
    change();
  });
}

/** The speed of the case, if it says one. */
function speedOf(): string {
  const found = entries.find(({ path, default: left }) => /(^|\.)(speed|angular-speed)$/.test(path) && !left);
  return found ? written(found) : "0 rad/s";
}

element<HTMLInputElement>("rotation").addEventListener("change", (event) => {
  state.speed = (event.target as HTMLInputElement).value.trim() || "0 rad/s";
  change();
});
element<HTMLInputElement>("most").addEventListener("change", (event) => {
  const box = event.target as HTMLInputElement;
  state.most = largest(box.value);
  if (box.value.trim() && !state.most) tell("The diagram leads up to a speed above zero, as 20 rpm.");
  box.value = state.most ?? "";
  diagram = undefined;
  change();
});
element<HTMLSelectElement>("run").addEventListener("change", (event) => {
  const found = state.item && gallery.named(state.item.id, (event.target as HTMLSelectElement).value);
  if (!found) return;
  const keep = { kind: found.run.do ?? state.kind, speed: found.run.speed ?? state.speed };
  void open({ named: found.item.id, run: found.run.name, set: [], ...keep }).then(() => remember(true), (error) => failed(error.message));
});
element("compute").addEventListener("click", () => {
  computer.lifted = true;
  change();
});
element("stop").addEventListener("click", () => computer.stop("Stopped. Change the case or press Compute to go on."));

const dialog = element<HTMLDialogElement>("gallery");
element("open-gallery").addEventListener("click", () => {
  if (!dialog.hasChildNodes()) gallery.fill(dialog);
  dialog.showModal();
});

element("pin").addEventListener("click", () => {
  pin = pin ? undefined : shown && { ...shown, text: state.text };
  element("pin").setAttribute("aria-pressed", String(pin !== undefined));
  element("pin").textContent = pin ? "Pinned" : "Pin";
  if (pin) tell("Pinned. Change the case: both answers are drawn, the pinned one dashed.");
  else if (shown) answered(shown.kind, shown.reply);
});

// The address is that of the case.
document.querySelector(".skip")!.addEventListener("click", (event) => {
  event.preventDefault();
  element("result").focus();
});

// A menu closes when something in it was chosen, or something else was.
for (const menu of all("details.menu") as HTMLDetailsElement[]) {
  document.addEventListener("click", (event) => {
    const { target } = event as unknown as { target: Node };
    if (!menu.contains(target) || (target as HTMLElement).matches("div button")) menu.open = false;
  });
  menu.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !menu.open) return;
    menu.open = false;
    menu.querySelector("summary")!.focus();
  });
}

async function put(text: string, what: string) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const box = tag("textarea", { "aria-label": what });
    box.value = text;
    document.body.append(box);
    box.select();
    document.execCommand("copy");
    box.remove();
  }
  tell(`${what} is copied.`);
}

const here = (query = location.search) => `${location.origin === "null" ? "file://" : location.origin}${location.pathname}${query}`;

const copies: Record<string, () => Promise<void>> = {
  link: async () => put(`${here()}#${await link()}`, "The link"),
  embed: async () => put(`<iframe src="${here("?embed")}#${await link()}" width="800" height="520" title="Flexion"></iframe>`, "The frame"),
  toml: async () => put(state.text, "The case"),
  command: async () => {
    const found = state.item && gallery.named(state.item.id, state.run?.name);
    const difference = found && (await computer.difference(state.text, found.text, state.files));
    await put(save.command(state.kind, difference ? found.path : "case.toml", difference ?? [], state.speed, speeds()), "The command");
    if (!difference) tell("The command is copied. It takes the case from case.toml: save the case as that.");
  },
  python: async () => put(save.python(state.kind, state.text, state.speed), "The Python text"),
};
for (const node of all("[data-copy]")) {
  node.addEventListener("click", () => copies[node.dataset.copy!]().catch((error) => tell(error.message)));
}

const file = () => (element("title").textContent ?? "case").toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "").slice(0, 40) || "case";
const content = (text: string) => new TextEncoder().encode(text);
const decoded = (files: Record<string, string>) => Object.fromEntries(Object.entries(files).map(([name, text]) => [name.replaceAll("../", ""), bytes(text)]));
const saves: Record<string, () => Promise<void>> = {
  picture: async () => save.download(await save.picture(room), `${file()}.png`),
  film: async () => {
    if (!answer.motion || !save.films()) throw new Error("There is no motion that this browser can film.");
    tell("The motion is filmed once from start to end.");
    save.download(await save.film(room, answer.motion, room.signal), `${file()}.webm`);
    tell("The film is saved.");
  },
  files: async () => {
    tell("The files are made.");
    const reply = await computer.files(asked());
    if (!reply.files) throw new Error(reply.message ?? "There are no files of this answer.");
    save.download(zip(decoded(reply.files)), `${file()}.zip`);
  },
  case: async () => {
    const further = decoded(state.files);
    // Files that the case names by another folder lie beside it in the archive.
    const text = state.text.replaceAll("../", "");
    if (Object.keys(further).length === 0) save.download(new Blob([state.text], { type: "application/toml" }), `${file()}.toml`);
    else save.download(zip({ "case.toml": content(text), ...further }), `${file()}.zip`);
  },
};
for (const node of all("[data-save]")) {
  node.addEventListener("click", () => saves[node.dataset.save!]().catch((error) => tell(error.message)));
}

element<HTMLInputElement>("file").addEventListener("change", (event) => take([...((event.target as HTMLInputElement).files ?? [])]));
document.addEventListener("dragover", (event) => event.preventDefault());
document.addEventListener("drop", (event) => {
  event.preventDefault();
  void take([...(event.dataTransfer?.files ?? [])]);
});

/** Opens files of the user: one of them is the case. */
async function take(given: File[]) {
  element<HTMLDetailsElement>("open").open = false;
  const toml = given.find(({ name }) => name.endsWith(".toml"));
  if (!toml || given.some(({ size }) => size > 64 * LARGEST)) return tell("Choose a case (.toml) and the files that it names.");
  const files: Record<string, string> = {};
  const own = ++openings;
  for (const other of given) if (other !== toml) files[other.name] = base64(new Uint8Array(await other.arrayBuffer()));
  const text = await toml.text();
  if (own !== openings) return;
  computer.stop();
  state = { text, files, kind: "run", fresh: true };
  [diagram, computer.lifted] = [undefined, false];
  present();
  change();
}

/** A kind with the table of its example. */
function example(path: string, { name, example }: { name: string; example: string }) {
  const own = path.split(".").at(-1)!;
  const table = new RegExp(`(?:^|[\\s{,])${own}\\s*=\\s*(\\{.*)`, "s").exec(example)?.[1];
  if (!table) return { name, example: `{ kind = "${name}" }` };
  let depth = 0;
  const end = [...table].findIndex((c) => (depth += c === "{" ? 1 : c === "}" ? -1 : 0) === 0);
  return { name, example: table.slice(0, end + 1) };
}

// While the engine comes.
(window.requestIdleCallback ?? setTimeout)(() => warm(room.canvas));
addEventListener("hashchange", follow);
addEventListener("popstate", follow);
void computer.ready
  .then((of) => {
    version = of;
    return follow();
  })
  // The first answer is not kept waiting for what only the editor and the form need.
  .then(() => computer.rests())
  .then(() => computer.keys())
  .then(({ schema, choices }) => {
    source.schema = schema;
    form.offer(new Map((choices ?? []).map(({ path, kinds }) => [path, kinds.map((kind) => example(path, kind))])));
  })
  .catch((error) => failed(`The engine could not be started: ${error.message}`));
if (embedded) {
  const home = element<HTMLAnchorElement>("home");
  home.textContent = "Open in the lab";
  home.addEventListener("click", (event) => {
    event.preventDefault();
    window.open(`${here("")}${location.hash}`, "_blank", "noopener");
  });
}
