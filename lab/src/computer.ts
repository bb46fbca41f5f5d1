// What is computed when: the newest case at once, its errors when it rests, nothing long before a click.
import type { Stored } from "./data";
import { nice } from "./text";
import { Lane, load, Stopped, unestimated, type Kind, type Reply, type Request } from "./engine";

export interface Asked {
  text: string;
  files: Record<string, string>;
  /** Changes of the text that come first. */
  set?: string[];
  kind: Kind;
  /** Number of the text that it is about: another case or another text of the user has another. */
  revision: number;
  /** Number of what is asked: every change of the text or of what is asked of it has another. */
  number: number;
  speed?: string;
  /** Speeds of a Campbell diagram. */
  range?: string;
  /** More of the same will follow at once. */
  sliding?: boolean;
}

interface Told {
  /** The case has been read; what is asked of it, if it can be computed. */
  checked(reply: Reply, text: string, asked: Asked): Asked | undefined;
  answered(asked: Asked, reply: Reply, modes?: Reply): void;
  said(words: string, share?: number, act?: "compute" | "stop"): void;
  failed(words: string): void;
  /** Rows of a run that is not done, which ends at a time; without rows another run begins. */
  grown(rows?: Record<string, Stored>, end?: number): void;
}

/** What a case may take before a click: two seconds of counted work [s], and memory [bytes]. */
const [SECONDS, MEMORY] = [2, 256e6];
/** Counted work that a common machine does in a second, where the engine does not say it. */
const PER_SECOND = 1e6;
/** Memory behind a click [bytes]. */
const MOST = 1e9;
/** What is asked without a click is ended after this time [s], whatever was counted. */
const PATIENCE = 15;
/** A case that takes longer to be read than this is not read without a click [s]: what it will take is not counted before it has been read. */
const READING = 3;
/** What is said while files are made. */
export const MAKING = "making the files …";
/** Reading a case that takes longer than this is told [ms]. */
const SOON = 300;
/** An older request that takes longer than this is not waited for [s]. */
const SHORT = 0.25;

/** A value of TOML without the quotes that a change does not need. */
function bare(value: string): string {
  const inner = /^"([^"\\,{}[\]#]+)"$/.exec(value)?.[1] ?? "";
  return /[A-Za-z]/.test(inner) && !/^\s*([+-]?(inf|nan)|true|false|[\d.eE+-]+)\s*$/.test(inner) ? inner : value;
}

const pause = (milliseconds: number) => new Promise((resolve) => setTimeout(resolve, milliseconds));

export class Computer {
  /** Whether a click has lifted the limits. */
  lifted = false;
  /** The version of the engine, when it has been started. */
  readonly ready: Promise<string>;
  private readonly module = load();
  /** One worker for questions about the case, another for its answers. */
  private readonly quick = new Lane(this.module);
  private readonly runner = new Lane(this.module);
  /** Makes files. */
  private saving?: Lane;
  private wanted?: Asked;
  private present?: Asked;
  private running = false;
  private perSecond = PER_SECOND;
  /** The last Campbell diagram, and what was asked for it. */
  private diagram?: { asked: Asked; lifted: boolean; reply: Reply };
  /** Counts what was stopped. */
  private stops = 0;
  private reading = false;
  /** Ends the pause behind an answer under a slider. */
  private wake?: () => void;

  constructor(private readonly told: Told) {
    this.ready = this.begin();
  }

  private async begin(): Promise<string> {
    const told = this.quick.ask({ do: "version" }, PATIENCE);
    // What fails here fails there too.
    this.runner.start().catch(() => {});
    const { version, "work-per-second": perSecond } = await told;
    this.perSecond = perSecond ?? PER_SECOND;
    return version ?? "";
  }

  /** What a case may say: schema and kinds. */
  keys(): Promise<Reply> {
    return this.quick.ask({ do: "keys" }, PATIENCE);
  }

  /** The newest that is wanted; what is older is given up. */
  want(asked: Asked) {
    // What earlier ones were to change is changed too.
    const same = (one?: Asked) => (one?.revision === asked.revision ? one : undefined);
    const [present, wanted] = [same(this.present), same(this.wanted)];
    const before = [...((present?.text === asked.text && present?.set) || []), ...(wanted?.set ?? [])];
    const keys = new Set(asked.set?.map((change) => change.split("=")[0]));
    const kept = before.filter((change) => !keys.has(change.split("=")[0]));
    this.wanted = { ...asked, set: [...kept, ...(asked.set ?? [])] };
    if (this.runner.busy > SHORT) this.runner.stop();
    if (this.reading && this.quick.busy > SHORT) this.quick.stop();
    this.wake?.();
    if (!this.running) void this.pump();
  }

  /** When nothing is computed any more, or after two seconds. */
  async rests(): Promise<void> {
    for (let tries = 0; tries < 100 && this.running; tries++) await pause(20);
  }

  /** Ends what is computed. */
  stop(words?: string) {
    this.stops += 1;
    this.wanted = undefined;
    this.runner.stop();
    this.saving?.stop();
    if (this.reading) this.quick.stop();
    if (words) this.told.said(words, undefined, "compute");
  }

  /** The text with changes. */
  async change(text: string, set: string[], files: Record<string, string>): Promise<string> {
    const reply = await this.quick.ask({ do: "change", case: text, set, files, limits: this.limits() }, this.lifted ? PATIENCE : READING);
    if (reply.case === undefined) {
      const [problem] = reply.problems ?? [];
      throw new Error(problem ? `${problem.key ? `${problem.key}: ` : ""}${problem.message}` : (reply.message ?? "The case cannot be changed so."));
    }
    return reply.case;
  }

  /** How a text differs from another, as changes; nothing where that cannot be said, or not soon. */
  async difference(text: string, from: string, files: Record<string, string>): Promise<string[] | null | undefined> {
    if (text === from) return [];
    const asked = this.quick.ask({ do: "difference", case: text, from, files, limits: this.limits() }, this.lifted ? PATIENCE : READING);
    const { set } = await asked.catch((error): Reply => {
      if (error instanceof Stopped && error.why === "late") return {};
      throw error;
    });
    return set && Object.entries(set).map(([key, value]) => `${key}=${bare(value)}`);
  }

  /** The files that the program would write; those that were asked for before are given up. */
  async files(asked: Asked): Promise<Reply> {
    this.saving?.stop();
    const lane = (this.saving = new Lane(this.module));
    const range = asked.range ?? (asked.kind === "campbell" ? await this.range(asked) : undefined);
    const request = { ...this.request({ ...asked, range }), do: "files", of: asked.kind, errors: true, limits: this.limits(true) };
    // What is computed beside it is told first.
    const told = (text: string) => this.running || this.progress(text, MAKING);
    told("{}");
    return lane.ask(request, Infinity, told).finally(() => lane.end());
  }

  private limits(lifted = this.lifted) {
    return lifted ? { memory: MOST } : { work: SECONDS * this.perSecond, memory: MEMORY };
  }

  private async pump() {
    this.running = true;
    while (this.wanted) {
      const asked = this.wanted;
      [this.present, this.wanted] = [asked, undefined];
      await this.one(asked).catch((error) => this.fell(error));
    }
    [this.running, this.present] = [false, undefined];
  }

  private fell(error: unknown) {
    if (error instanceof Stopped && error.why === "stopped") return;
    // Time alone does not make a case too large for a click.
    if (error instanceof Stopped && error.why === "late" && !this.lifted) return this.told.said(error.message, undefined, "compute");
    const what = error instanceof Error ? error.message : String(error);
    this.told.failed(`The engine stopped: ${what}. It has been started anew; change the case and it computes again.`);
  }

  private request({ text, files, kind, speed, range }: Asked): Request {
    const request: Request = { do: kind, case: text, files, limits: this.limits() };
    if (kind === "modes") request.speed = speed ?? "0 rad/s";
    if (kind === "campbell") request.speeds = range;
    return request;
  }

  private async one(asked: Asked) {
    let { text } = asked;
    const { files, set } = asked;
    if (set?.length) {
      const reply = await this.read({ do: "change", case: text, files, set });
      if (reply.case === undefined) {
        this.told.checked(reply, text, asked);
        return;
      }
      text = reply.case;
    }
    const { stops } = this;
    const reply = await this.read({ do: "check", case: text, files });
    if (stops !== this.stops) return;
    const ready = this.told.checked(reply, text, asked);
    if (reply.status === "given-up") return void this.fine(reply);
    if (!ready) return;
    // A newer text is read first; under a slider every answer that is short is shown.
    if (this.wanted && !asked.sliding) return;
    if (!this.lifted && ready.kind === "run" && (reply.work ?? 0) > SECONDS * this.perSecond) {
      const seconds = Math.ceil((reply.work ?? 0) / this.perSecond);
      this.told.said(`This takes some ${seconds} s or more.`, undefined, "compute");
      return;
    }
    await this.answer(ready);
  }

  /** Asks what reads the case; where that takes long it is told, and can be stopped. */
  private async read(request: Request): Promise<Reply> {
    this.reading = true;
    const telling = setTimeout(() => this.told.said("reading the case …", undefined, "stop"), SOON);
    try {
      return await this.quick.ask({ ...request, limits: this.limits() }, this.lifted ? Infinity : READING);
    } finally {
      clearTimeout(telling);
      this.reading = false;
    }
  }

  private async answer(asked: Asked) {
    const { kind } = asked;
    const { stops } = this;
    this.told.said("computing …", undefined, "stop");
    let first: Reply;
    let modes: Reply | undefined;
    if (kind === "campbell") {
      first = await this.campbell(asked);
      if (!this.fine(first)) return;
      modes = await this.ask({ ...this.request({ ...asked, kind: "modes" }), count: 6 });
    } else {
      first = await this.ask({ ...this.request(asked), ...(kind === "run" && { errors: false, rows: true }) });
      if (!this.fine(first)) return;
    }
    this.told.answered(asked, first, modes);
    if (kind === "statics" && unestimated(first)) return this.offer("The error takes longer to estimate.", first);
    if (first.status === "given-up") {
      this.offer("This is as far as two seconds of work lead.", first);
      return;
    }
    this.told.said("");
    if (kind !== "run" || this.wanted) return;
    if (asked.sliding) await Promise.race([pause(300), new Promise<void>((resolve) => (this.wake = resolve))]);
    if (this.wanted || stops !== this.stops) return;
    this.told.said("estimating the error …", undefined, "stop");
    const whole = await this.ask({ ...this.request(asked), errors: true });
    if (this.wanted) return;
    // Where the companions took too long, the run stands without a band.
    if (whole.results && whole.status !== "given-up") this.told.answered(asked, whole);
    if (whole.status === "given-up" || unestimated(whole)) this.offer("The error takes longer to estimate.", whole);
    else this.told.said("");
  }

  /** The Campbell diagram: another speed of its modes needs no other diagram. */
  private async campbell(asked: Asked): Promise<Reply> {
    const { diagram, lifted } = this;
    const same = (one: Asked) => one.text === asked.text && one.files === asked.files && one.range === asked.range;
    if (diagram && diagram.lifted === lifted && same(diagram.asked)) return diagram.reply;
    const reply = await this.ask(this.request({ ...asked, range: asked.range ?? (await this.range(asked)) }));
    this.diagram = reply.results ? { asked, lifted, reply } : undefined;
    return reply;
  }

  /** Speeds up to twice the lowest frequency, where the case says no speed. */
  private async range(asked: Asked): Promise<string> {
    const reply = await this.ask({ ...this.request({ ...asked, kind: "modes" }), speed: "0 rad/s", unit: "rad/s", count: 8 });
    const modes = (reply.summary?.modes ?? []) as { frequency: number }[];
    const lowest = modes.map(({ frequency }) => frequency).filter((frequency) => frequency > 1e-6);
    return `0 rad/s:${nice(2 * (lowest[0] ?? 5))} rad/s:31`;
  }

  /** What was given up is offered behind a click; where the click was made already, it says why. */
  private offer(words: string, { message }: Reply) {
    if (this.lifted) this.told.said(message ?? words);
    else this.told.said(words, undefined, "compute");
  }

  /** Whether there is something to be drawn; else it says why not. */
  private fine(reply: Reply): boolean {
    if (reply.results) return true;
    if (reply.status === "given-up" && !this.lifted) {
      this.offer(`This takes more than ${reply.message?.includes("memory") ? `${MEMORY / 1e6} MB` : "two seconds"}.`, reply);
      return false;
    }
    const words = reply.problems?.map(({ message }) => message).join("; ") || reply.message || "There is no answer.";
    this.told.failed(words);
    return false;
  }

  private ask(request: Request): Promise<Reply> {
    this.told.grown();
    return this.runner.ask(request, this.lifted ? Infinity : PATIENCE, (text) => this.progress(text, request.errors === true ? "estimating the error …" : "computing …"));
  }

  private progress(text: string, words: string) {
    try {
      const { time, end, rows } = JSON.parse(text);
      if (rows) this.told.grown(rows, end);
      const share = typeof time === "number" && end > 0 ? time / end : undefined;
      this.told.said(words, share, "stop");
    } catch {
      // A notice that cannot be read says nothing.
    }
  }
}
