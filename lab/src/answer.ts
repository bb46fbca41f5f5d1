// The answer: what the engine says of a case, drawn in the room, with what concerns it.
import { tag } from "./curves";
import { campbell, diagram } from "./diagram";
import type { Results } from "./data";
import { moving, unestimated, type Kind, type Reply } from "./engine";
import { modes } from "./modes";
import { motion } from "./motion";
import { path } from "./path";
import type { Drawn, Kept, Room } from "./room";
import { table } from "./table";
import { inRadians, steady, text } from "./text";

/** A run that others are compared with. */
export interface Pin {
  kind: Kind;
  reply: Reply;
  /** The text of its case. */
  text: string;
}

/** Most warnings and events that are listed. */
const MOST = 50;

export class Answer {
  private drawn?: Drawn;
  private kind?: Kind;
  /** What was chosen in the last answer of each kind. */
  private readonly kept = new Map<Kind, Kept>();

  constructor(
    private readonly room: Room,
    private readonly notes: HTMLElement,
    private readonly values: HTMLElement,
    private readonly choose: (speed: string) => void,
  ) {}

  get motion(): Drawn | undefined {
    return this.drawn;
  }

  /** Takes away everything. */
  clear() {
    if (this.kind && this.drawn) this.kept.set(this.kind, this.drawn.kept());
    this.room.clear();
    this.drawn = undefined;
    this.notes.replaceChildren();
    this.values.replaceChildren();
    this.room.subtitle.textContent = "";
  }

  /** Draws a reply. What was chosen in the last answer of the same kind stays. */
  show(kind: Kind, reply: Reply, pin?: Pin, remark?: string) {
    const other = pin?.kind === kind ? pin : undefined;
    if (kind === "run" && this.kind === kind && this.again(reply, other)) return this.remark(reply, remark, other);
    this.clear();
    const kept = this.kept.get(kind);
    this.kind = kind;
    this.room.stage.hidden = false;
    if (kind === "run") this.run(reply, kept, other);
    else if (kind === "modes") this.drawn = this.modes(reply, kept);
    else if (kind === "statics") this.statics(reply);
    this.room.footer.hidden = !this.drawn?.seconds;
    this.remark(reply, remark, other);
  }

  /** A Campbell diagram with the modes at one of its speeds. */
  showCampbell(reply: Reply, at: Reply | undefined, asked: string, remark?: string) {
    this.clear();
    const kept = this.kept.get("campbell");
    this.kind = "campbell";
    const of = campbell(reply);
    const unit = of["speed-unit"];
    this.room.stage.hidden = at?.results === undefined;
    if (at?.results) this.drawn = this.modes(at, kept);
    this.room.footer.hidden = this.drawn === undefined;
    // The engine knows every unit of a speed: its modes say at which one they are.
    const table = at?.results ? moving(at).modes?.table : undefined;
    const speed = table && (table.speed * inRadians(table["speed-unit"])) / inRadians(unit);
    const found = diagram(of, this.room, speed, (speed) => this.choose(`${speed} ${unit}`));
    this.room.curves.prepend(found, tag("h2", {}, `Modes at ${speed === undefined ? asked : `${text(speed, 3)} ${unit}`}`));
    this.remark({ ...reply, warnings: [...(reply.warnings ?? []), ...(at?.warnings ?? [])] }, remark);
    if (!at?.results) this.notes.append(tag("p", { class: "failed" }, `There are no modes at this speed: ${at?.message ?? "no reason is given"}`));
  }

  /** Draws a run: its motion, its columns, its values and its events. */
  private run(reply: Reply, kept: Kept | undefined, pin: Pin | undefined) {
    const results = banded(moving(reply), reply.summary);
    const moves = isMoving(results);
    this.room.stage.hidden = !moves;
    if (moves) this.drawn = motion(results, this.room, kept, pin && moving(pin.reply));
    this.list(reply, pin);
  }

  /** Draws a run in the place of one that is like it; whether it is. */
  private again(reply: Reply, pin: Pin | undefined): boolean {
    const results = banded(moving(reply), reply.summary);
    if (!isMoving(results) || !this.drawn?.take?.(results, pin && moving(pin.reply))) return false;
    this.notes.replaceChildren();
    this.values.replaceChildren();
    this.list(reply, pin);
    return true;
  }

  /** Lists values and events. */
  private list(reply: Reply, pin: Pin | undefined) {
    const { summary } = reply;
    if (summary?.columns) this.values.append(table(summary, pin?.reply.summary, this.room.signal));
    const events = listed(reply.events);
    if (events) this.values.append(events);
  }

  private modes(reply: Reply, kept: Kept | undefined): Drawn {
    const drawn = modes(moving(reply), this.room, kept);
    // Warnings stand beside the picture here.
    this.room.note.textContent = "";
    return drawn;
  }

  private statics(reply: Reply) {
    this.room.stage.hidden = true;
    this.room.curves.append(path(reply));
  }

  /** What concerns the answer: that it is of another version, what it is compared with, warnings, trust. */
  private remark(reply: Reply, remark: string | undefined, pin?: Pin) {
    const add = (name: string, ...words: (string | Node)[]) => this.notes.append(tag("p", { class: name }, ...words));
    if (remark) add("remark", remark);
    if (reply.status === "failed") add("failed", `The run stopped early: ${reply.message ?? "no reason is given"}`);
    if (reply.status === "given-up" && reply.results) add("doubt", `This answer is not whole: ${(reply.message ?? "it was given up").replace(/\.$/, "")}.`);
    if (pin) add("pinned", "Dashed: the pinned answer.");
    const { trust, errors } = reply.summary ?? {};
    const end = reply.summary?.end_time;
    if (trust?.estimated && trust.until !== null && trust.until !== undefined && end !== undefined && trust.until < end) {
      add("doubt", `Errors are known and small until ${steady(trust.until)} s${trust.column ? `, then that of ${trust.column} grows` : ""}. What lies behind is shaded.`);
    }
    // Of a run, or of a path of equilibria.
    const { estimated, reason } = trust ?? errors ?? {};
    if (estimated === false && reason) {
      add("dim", `Errors are not known: ${unestimated(reply) ? "it takes more work to estimate them than is done without a click" : reason}.`);
    }
    const warnings = [...new Set([...(reply.warnings ?? []), ...(reply.summary?.warnings ?? [])])];
    if (warnings.length === 0) return;
    const shown = warnings.slice(0, MOST).map((warning) => tag("li", {}, String(warning)));
    const name = warnings.length === 1 ? "1 warning" : `${warnings.length} warnings`;
    const list = tag("details", { class: "warnings" }, tag("summary", {}, name), tag("ul", {}, ...shown));
    list.open = warnings.length < 3;
    this.notes.append(list);
  }
}

/** Whether there is something in motion. */
const isMoving = (results: Results) => results?.scene && Object.keys(results.scene).length > 0;

/** With the largest error of a column as its band, where there is none over time. */
function banded(results: Results, summary: Reply["summary"]): Results {
  const { curves } = results ?? {};
  const trust = summary?.trust;
  // What ended it is said beside the picture.
  if (!curves || !trust?.estimated) return { ...results, caution: null };
  const columns = curves.columns.map((column) => ({
    ...column,
    error: column.error ?? summary?.columns?.[column.name]?.error?.discretization,
  }));
  return { ...results, caution: null, curves: { ...curves, columns, trusted: curves.trusted ?? trust.until } };
}

/** Events as they are listed in events.csv, in columns of their own. */
function listed(events: unknown): HTMLElement | undefined {
  const rows = typeof events === "string" ? events.trim().split("\n").map((line) => line.split(",")) : undefined;
  const objects = Array.isArray(events) ? events : undefined;
  const head = rows?.[0] ?? (objects?.length ? Object.keys(objects[0] as object) : []);
  const body = rows?.slice(1) ?? objects?.map((event) => head.map((key) => String((event as Record<string, unknown>)[key] ?? ""))) ?? [];
  if (body.length === 0) return undefined;
  const number = (cell: string) => (cell.trim() !== "" && Number.isFinite(Number(cell)) ? text(Number(cell), 6) : cell);
  // Columns that say nothing are left out.
  const said = head.map((_, i) => i).filter((i) => body.some((row) => (row[i] ?? "").trim() !== ""));
  const lines = body.slice(0, MOST).map((row) => tag("tr", {}, ...said.map((i) => tag("td", {}, number(row[i] ?? "")))));
  const titles = tag("tr", {}, ...said.map((i) => tag("th", { scope: "col" }, head[i].replaceAll("_", " "))));
  const name = `${body.length} event${body.length === 1 ? "" : "s"}${body.length > MOST ? `, the first ${MOST} are shown` : ""}`;
  const whole = tag("table", {}, tag("thead", {}, titles), tag("tbody", {}, ...lines));
  return tag("details", { class: "events" }, tag("summary", {}, name), tag("div", { class: "table" }, whole));
}
