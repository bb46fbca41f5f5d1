// The engine: requests to workers, their replies, and new workers for those that fall.
import type { Results } from "./data";
import EngineWorker from "./worker?worker&inline";

export interface Problem {
  line?: number | null;
  column?: number | null;
  length?: number | null;
  /** The change that is wrong, where it is one. */
  set?: string | null;
  key?: string;
  message: string;
  label?: string;
  help?: string[];
  severity?: string;
}

/** A key of the case with its value and what it takes. */
export interface Entry {
  path: string;
  doc: string;
  /** number, quantity, integer, boolean, choice, kind, text, … */
  takes: string;
  unit: string;
  range?: { least: number | null; most: number | null; above: boolean } | null;
  /** In SI, as TOML. */
  value: string;
  number?: number | null;
  /** As it stands in the case, where it does. */
  written?: string | null;
  default: boolean;
  choices?: string[];
  /** Path of the kinds of a table. */
  choice?: string;
}

/** What the engine says; which parts there are depends on what was asked. */
export interface Reply {
  status?: "valid" | "finished" | "stopped" | "failed" | "rejected" | "refused" | "given-up";
  message?: string | null;
  problems?: Problem[];
  warnings?: string[];
  version?: string;
  "work-per-second"?: number;
  schema?: Schema;
  choices?: { path: string; kinds: { name: string; example: string }[] }[];
  missing?: Problem[] | null;
  kind?: Kind;
  work?: number | null;
  /** Why errors could not be had. */
  refused?: string | null;
  tables?: Entry[];
  results?: unknown;
  summary?: Summary & Record<string, unknown>;
  /** Of a Campbell diagram: how each mode moves. */
  moves?: (string | null)[];
  /** Of a path of equilibria. */
  columns?: { name: string; unit: string; role: string }[];
  events?: unknown;
  case?: string;
  set?: Record<string, string> | null;
  files?: Record<string, string>;
}

export type Kind = "run" | "modes" | "campbell" | "statics";

export interface Schema {
  type?: string;
  const?: string;
  enum?: string[];
  default?: unknown;
  title?: string;
  description?: string;
  examples?: unknown[];
  properties?: Record<string, Schema>;
  items?: Schema;
  anyOf?: Schema[];
  oneOf?: Schema[];
}

export interface Summary {
  status?: string;
  message?: string | null;
  columns?: Record<string, Column>;
  trust?: { estimated?: boolean; reason?: string | null; until?: number | null; column?: string | null };
  /** Of a path of equilibria. */
  errors?: { estimated: boolean; reason: string | null };
  warnings?: string[];
  duration?: number;
  end_time?: number;
}

interface Column {
  min: number;
  t_min: number;
  max: number;
  t_max: number;
  final: number;
  unit: string;
  role?: string;
  error?: Record<string, number | null> | null;
}

/** Results of a run or of modes, as `flexion view` has them. */
export const moving = (reply: Reply) => reply.results as Results;

/** Whether a run or a path is whole, and the work was limited before its errors were known. */
export const unestimated = ({ status, message }: Reply) => status !== "given-up" && (message?.startsWith("given up at") ?? false);

/** A request was stopped, its worker fell, or it took too long. */
export class Stopped extends Error {
  constructor(
    message: string,
    readonly why: "stopped" | "fell" | "late",
  ) {
    super(message);
  }
}

export interface Request {
  do: string;
  case?: string;
  files?: Record<string, string>;
  set?: string[];
  limits?: { work?: number; memory?: number };
  [option: string]: unknown;
}

/** The largest memory that a worker is kept with [bytes]. */
const KEPT = 400e6;

/** One worker and what is asked of it, in turn. */
export class Lane {
  private worker?: Worker;
  private turn: Promise<unknown> = Promise.resolve();
  private stopping?: (error: Stopped) => void;
  private since = 0;

  constructor(private readonly module: Promise<WebAssembly.Module>) {}

  /** Asks; what takes longer than `patience` [s] is ended, and `progress` is told how far it is. */
  ask(request: Request, patience = Infinity, progress?: (text: string) => void): Promise<Reply> {
    const next = this.turn.then(() => this.send(request, patience, progress));
    this.turn = next.catch(() => undefined);
    return next;
  }

  /** Seconds that the present request has taken, none if there is none. */
  get busy(): number {
    return this.stopping ? (performance.now() - this.since) / 1000 : 0;
  }

  /** Ends the present request. */
  stop(message = "stopped", why: Stopped["why"] = "stopped") {
    const stopping = this.stopping;
    if (!stopping) return;
    this.worker?.terminate();
    this.worker = undefined;
    stopping(new Stopped(message, why));
  }

  /** Ends the worker. */
  end() {
    this.stop();
    this.worker?.terminate();
    this.worker = undefined;
  }

  /** Starts its worker where it has none: before the first request this takes its time while others are answered. */
  async start(): Promise<Worker> {
    const module = await this.module;
    if (!this.worker) {
      this.worker = new EngineWorker();
      this.worker.postMessage({ module });
    }
    return this.worker;
  }

  private async send(request: Request, patience: number, progress?: (text: string) => void): Promise<Reply> {
    const worker = await this.start();
    this.since = performance.now();
    const limit = patience < Infinity ? setTimeout(() => this.stop(`This takes more than ${patience} s.`, "late"), 1000 * patience) : undefined;
    try {
      return await new Promise<Reply>((resolve, reject) => {
        this.stopping = reject;
        worker.onerror = (event) => {
          event.preventDefault();
          this.stop(event.message || "the worker could not be started", "fell");
        };
        worker.onmessage = ({ data }: MessageEvent<{ progress?: string; reply?: string; trap?: string; bytes?: number }>) => {
          // What was on its way when the worker was ended.
          if (this.worker !== worker) return;
          if (data.progress !== undefined) progress?.(data.progress);
          else if (data.trap !== undefined) this.stop(data.trap, "fell");
          else {
            try {
              resolve(JSON.parse(data.reply!));
            } catch {
              reject(new Stopped("the engine's reply cannot be read", "fell"));
            }
            if (data.bytes! > KEPT) {
              worker.terminate();
              this.worker = undefined;
            }
          }
        };
        worker.postMessage({ request: JSON.stringify(request) });
      });
    } finally {
      clearTimeout(limit);
      this.stopping = undefined;
    }
  }
}

/** Bytes of text in base64. */
export function bytes(base64: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
}

/** Bytes as text in base64. */
export function base64(content: Uint8Array): string {
  let binary = "";
  for (let i = 0; i < content.length; i += 8192) binary += String.fromCharCode(...content.subarray(i, i + 8192));
  return btoa(binary);
}

declare global {
  interface Window {
    /** The engine, if the page has begun to fetch it. */
    engine?: Promise<WebAssembly.Module>;
  }
}

/** The engine within the page, or else the file beside it, which comes while the page is read. */
export async function load(): Promise<WebAssembly.Module> {
  const within = document.getElementById("engine")?.textContent?.trim() ?? "";
  if (within.length > 100) {
    const stream = new Blob([bytes(within)]).stream().pipeThrough(new DecompressionStream("gzip"));
    return WebAssembly.compile(await new Response(stream).arrayBuffer());
  }
  if (!window.engine) throw new Error("the page has none");
  return window.engine;
}
