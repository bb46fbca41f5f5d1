// The lab: a case as form and text, and its answer, which follows it.
import "./style.css";
import "./lab.css";
import "./answer.css";
import "./screens.css";
import { Answer, type Pin } from "./answer";
import { tag } from "./curves";
import { Computer, MAKING, type Asked } from "./computer";
import { campbell } from "./diagram";
import { base64, bytes, Stopped, type Entry, type Kind, type Problem, type Reply } from "./engine";
import { example, Form, largest, quantity, written } from "./form";
import * as gallery from "./gallery";
import { Growing } from "./growing";
import { read, write, LARGEST, LONGEST, type Link } from "./link";
import "./menus";
import { list as problemsOf } from "./problems";
import { Room } from "./room";
import * as save from "./save";
import { Source } from "./source";
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
  /** There is no case: none has been opened, or a link leads nowhere. */
  none?: boolean;
}

const room = new Room(element("subtitle"));
element("answer").prepend(room.stage);
element("notes").after(room.curves);
element("answer").after(room.footer);

const embedded = new URLSearchParams(location.search).has("embed");
document.body.classList.toggle("embed", embedded);

let state: State = { text: "", files: {}, kind: "run", none: true };
let entries: Entry[] = [];
/** The answer that is shown, and what it was asked. */
let shown: { asked: Asked; reply: Reply; modes?: Reply } | undefined;
let pin: Pin | undefined;
let version = "";
/** Counts the texts of the user and the cases that were opened. */
let revision = 0;
/** Counts every change of the text and of what is asked of it: an answer to an older number is old. */
let number = 0;

const growing = new Growing(element("growing"));
const computer = new Computer({ checked, answered, said, failed, grown: (rows, end) => (rows ? growing.add(rows, end ?? 0) : growing.clear()) });
const source = new Source(element("text"), (text) => {
  state = { ...state, text, none: false };
  revision += 1;
  able();
  renewed();
  clearTimeout(waiting);
  waiting = window.setTimeout(() => change(), 250);
});
const form = new Form(element("form"), (key, value, sliding) => set([`${key.replace(/\[(\d+)\]/g, ".$1")}=${value}`], sliding));
const answer = new Answer(room, element("notes"), element("values"), (speed) => {
  state.speed = speed;
  element<HTMLInputElement>("rotation").value = speed;
  change();
});

let waiting = 0;

/** The text or what is asked of it is another; `sliding` says that more will follow. */
function renewed(sliding = false) {
  number += 1;
  halted = "";
  element("result").classList.toggle("sliding", sliding);
  age();
}

/** An old answer never stands under a new case as if it were its own. */
function age() {
  const old = shown?.asked.number !== number;
  element("result").classList.toggle("stale", old);
  element("result").setAttribute("aria-busy", String(old));
}

const asked = (): Asked => ({
  text: state.text,
  files: state.files,
  kind: state.kind,
  revision,
  number,
  speed: state.speed,
  range: range(),
});

/** Speeds of the Campbell diagram: from rest to what is chosen, or half as much again as the speed of the case. */
function range(): string | undefined {
  const own = quantity(speedOf());
  const most = quantity(state.most ?? "") ?? (own && own.number > 0 ? { ...own, number: Number((1.5 * own.number).toPrecision(2)) } : undefined);
  return most && most.number > 0 ? `0 ${most.unit || "rad/s"}:${most.number} ${most.unit || "rad/s"}:31` : undefined;
}

/** Speeds of the diagram that is shown. */
function speeds(): string {
  if (shown?.asked.kind !== "campbell") return range() ?? "0:10:31";
  const { speeds, "speed-unit": unit } = campbell(shown.reply);
  return range() ?? `0 ${unit}:${Number(speeds[speeds.length - 1].toPrecision(3))} ${unit}:31`;
}

/** The case or what is asked of it has changed. */
function change() {
  renewed();
  computer.want(asked());
  remember();
}

/** Sets keys of the case. */
function set(changes: string[], sliding = false) {
  renewed(sliding);
  computer.want({ ...asked(), set: changes, sliding });
}

/** The case has been read; what is asked of it, if it can be computed. */
function checked(reply: Reply, text: string, of: Asked): Asked | undefined {
  // What has been written or opened since is newer.
  if (of.revision !== revision) return undefined;
  if (of.set?.length) source.text = state.text = text;
  const problems = reply.problems ?? [];
  const missing = state.kind === "run" && !state.fresh ? (reply.missing ?? []) : [];
  list([...problems, ...missing]);
  source.report(problems);
  if (reply.tables) {
    entries = reply.tables;
    form.show(entries);
    const title = entries.find(({ path }) => path === "title");
    name(title ? written(title) : "");
  } else if (state.fresh) {
    // Nothing of the case before stands beside one that cannot be read.
    nothing();
    name("");
  }
  // A case without a run has modes; those of a case are at its own speed, which is known now.
  const modal = reply.missing?.length ? state.kind === "run" : state.kind === "modes" || state.kind === "campbell";
  if (state.fresh && modal && problems.length === 0) {
    if (state.kind === "run") state.kind = "modes";
    state.fresh = false;
    present();
    change();
    return undefined;
  }
  if (reply.tables) state.fresh = false;
  const rotates = state.kind === "modes" || state.kind === "campbell";
  if (rotates && state.speed === undefined) element<HTMLInputElement>("rotation").value = state.speed = speedOf();
  if (!of.sliding) remember();
  return problems.length + missing.length > 0 ? undefined : { ...of, text, set: undefined, speed: state.speed, range: range() };
}

function name(title: string) {
  const words = (title || state.item?.title || "A case").slice(0, 200);
  element("title").textContent = words;
  document.title = `${words} – Flexion lab`;
}

function list(problems: Problem[]) {
  problemsOf(element("problems"), problems, (problem) => {
    // A value that was not taken over stands in its box, and not in the text.
    const box = problem.line ? null : document.getElementById(`key-${problem.key}`);
    tab(box ? "form" : "text");
    if (box) return box.focus();
    source.go(problem.line ?? 1, problem.column ?? 1);
  });
  if (problems.length > 0) said(problems.length === 1 ? "The case has a mistake." : `The case has ${problems.length} mistakes.`);
}

/** An answer has come. */
function answered(asked: Asked, reply: Reply, modes?: Reply) {
  shown = { asked, reply, modes };
  growing.clear();
  draw();
}

/** Draws the answer, beside what is pinned. */
function draw() {
  if (!shown) return;
  const { asked, reply, modes } = shown;
  const older = state.version && version && state.version !== version;
  const remark = older ? `The link was made with Flexion ${state.version}; these numbers are of Flexion ${version} and may differ.` : undefined;
  try {
    if (asked.kind === "campbell") {
      const box = element<HTMLInputElement>("most");
      if (!state.most && document.activeElement !== box) box.value = speeds().split(":")[1];
      answer.showCampbell(reply, modes, asked.speed ?? "0 rad/s", remark);
    } else answer.show(asked.kind, reply, pin, remark);
    if (pin) void compare(pin, asked);
  } catch (error) {
    shown = undefined;
    failed(`The answer cannot be drawn: ${(error as Error).message}`);
  }
  age();
  able();
}

/** Says what the pinned case has otherwise. */
async function compare({ text }: Pin, of: Asked) {
  const set = await computer.difference(text, of.text, of.files).catch(() => undefined);
  const note = document.querySelector("#notes .pinned");
  if (note && shown?.asked === of && set?.length && set.length < 6) note.textContent = `Dashed: the pinned answer, with ${set.join(", ")}.`;
}

/** Without a case there is nothing to compute or to take along, and without a run nothing to pin. */
function able() {
  for (const node of all("[data-kind], [data-copy], [data-save]")) node.toggleAttribute("disabled", state.none === true);
  element("pin").toggleAttribute("disabled", !pin && shown?.asked.kind !== "run");
}

/** Says how far it is. */
function said(words: string, share?: number, act?: "compute" | "stop") {
  // A number with hundreds of digits says no more than its size.
  element("state").textContent = words.replace(/\d{25,}(\.\d+)?/g, (digits) => String(Number(digits)));
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
/** Counts what is to be written there, and whether it is a new entry of the history. */
let [addresses, pushing] = [0, false];
/** Links that are being opened. */
let following = 0;
/** What ended the opening of the link in the address, if something did: the user, or that it takes long. */
let halted: "" | "stopped" | "late" = "";
/** Whether the address leads elsewhere than to what is shown. */
const leads = () => following > 0 || location.hash.slice(1) !== written_;

/** The address says what is shown, if it leads nowhere else by then. */
function remember(push = false) {
  clearTimeout(remembering);
  const own = ++addresses;
  pushing ||= push;
  const act = async () => {
    if (leads()) return;
    const fragment = await link().catch(() => "");
    if (fragment === written_ || own !== addresses || leads()) return;
    written_ = fragment;
    const address = `${location.pathname}${location.search}${fragment && `#${fragment}`}`;
    history[pushing ? "pushState" : "replaceState"](null, "", address);
    pushing = false;
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
  const named = needed();
  if (named.length > 0) throw new Error(`A link cannot carry the files of this case (${named.join(", ")}): save the case as a file and pass that on.`);
  const fragment = await write({ ...common, text: state.text, set: [] });
  if (fragment.length > LONGEST || state.text.length > LARGEST) throw new Error("The case is too long for a link: save it as a file and pass that on.");
  return fragment;
}

/** Files that the case names. */
const needed = () => Object.keys(state.files).filter((name) => state.text.includes(name));

/** Shows what the address says; `lifted` says that a click allows it to take long. */
async function follow(lifted = false) {
  const fragment = location.hash.slice(1);
  if (fragment === written_ && state.text) return;
  written_ = fragment;
  [addresses, pushing] = [addresses + 1, false];
  renewed();
  list([]);
  said("opening …", undefined, "stop");
  following += 1;
  // A newer address is followed instead, and after Stop none.
  const wanted = () => written_ === fragment && !halted;
  try {
    const asked = await read(fragment);
    if (wanted()) await open(asked, lifted);
  } catch (error) {
    if (!wanted()) return;
    if (error instanceof Stopped && error.why === "late") {
      halted = "late";
      said(error.message, undefined, "compute");
    } else refuse((error as Error).message);
  } finally {
    following -= 1;
  }
}

function refuse(message: string) {
  computer.stop();
  nothing();
  replace({ text: "", files: {}, kind: "run", none: true });
  renewed();
  source.report([]);
  name("This link cannot be opened");
  element("problems").replaceChildren(tag("li", {}, message, " ", again()));
  said("");
}

/** Takes away what is known of a case. */
function nothing() {
  [shown, entries] = [undefined, []];
  form.show(entries);
  answer.clear();
  room.stage.hidden = true;
  able();
}

/** A way on from a link that leads nowhere. */
function again() {
  return tag("a", { href: `#case=${gallery.first}` }, "Open a case that works");
}

/** Counts the cases that were to be opened. */
let openings = 0;

async function open(asked: Link, lifted = false) {
  const own = ++openings;
  computer.stop();
  computer.lifted = lifted;
  const kind = asked.kind ?? "run";
  if (asked.text !== undefined) {
    replace({ text: asked.text, files: {}, kind, speed: asked.speed, most: largest(asked.most), version: asked.version, fresh: true });
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
    replace({ text, files, item: found.item, run: found.run, kind: its ?? kind, speed, most: largest(asked.most), version: asked.version, fresh: true });
  }
  name("");
  change();
}

/** Another case: what is known of the one before comes too late from here on. */
function replace(next: State) {
  state = next;
  revision += 1;
  source.text = state.text;
  present();
}

/** Shows the state beside the answer. */
function present() {
  able();
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
for (const node of all("[data-kind]")) {
  node.addEventListener("click", () => {
    state.kind = node.dataset.kind as Kind;
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
  change();
});
element<HTMLSelectElement>("run").addEventListener("change", (event) => {
  const found = state.item && gallery.named(state.item.id, (event.target as HTMLSelectElement).value);
  if (!found) return;
  const keep = { kind: found.run.do ?? state.kind, speed: found.run.speed ?? state.speed };
  void open({ named: found.item.id, run: found.run.name, set: [], ...keep }).then(() => remember(true), (error) => failed(error.message));
});
element("compute").addEventListener("click", () => {
  const of = halted;
  if (of) {
    written_ = "#";
    return void follow(of === "late");
  }
  computer.lifted = true;
  change();
});
element("stop").addEventListener("click", () => {
  halted = following > 0 ? "stopped" : "";
  if (halted) openings += 1;
  computer.stop(halted ? "Stopped. Press Compute to open the link." : "Stopped. Change the case or press Compute to go on.");
});

const dialog = element<HTMLDialogElement>("gallery");
element("open-gallery").addEventListener("click", () => {
  if (!dialog.hasChildNodes()) gallery.fill(dialog);
  dialog.showModal();
});

element("pin").addEventListener("click", () => {
  pin = pin ? undefined : shown && { kind: shown.asked.kind, reply: shown.reply, text: shown.asked.text };
  element("pin").setAttribute("aria-pressed", String(pin !== undefined));
  element("pin").textContent = pin ? "Pinned" : "Pin";
  if (pin) tell("Pinned. Change the case: both answers are drawn, the pinned one dashed.");
  else draw();
});

// The address is that of the case.
document.querySelector(".skip")!.addEventListener("click", (event) => {
  event.preventDefault();
  element("result").focus();
});

async function put(text: string, what: string) {
  await save.copy(text, what);
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
  python: async () => put(save.python(state.kind, state.text, state.speed, speeds(), needed()), "The Python text"),
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
    const name = `${file()}.webm`;
    save.download(await save.film(room, answer.motion, room.signal), name);
    tell("The film is saved.");
  },
  files: async () => {
    const [words, offered] = [element("state").textContent ?? "", !element("compute").hidden];
    const reply = await computer.files(asked()).finally(() => {
      if (element("state").textContent === MAKING) said(words === MAKING ? "" : words, undefined, offered ? "compute" : undefined);
    });
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
  computer.lifted = false;
  replace({ text, files, kind: "run", fresh: true });
  change();
}

// While the engine comes.
(window.requestIdleCallback ?? setTimeout)(() => warm(room.canvas));
addEventListener("hashchange", () => follow());
addEventListener("popstate", () => follow());
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
