// A case as a link: the state of the page in the fragment of its address.
import type { Kind } from "./engine";

/** The most characters of a fragment, and the most bytes of a case. */
export const LONGEST = 65536;
export const LARGEST = 1 << 20;

/** What a link says. */
export interface Link {
  /** A case of the gallery, and which of its runs. */
  named?: string;
  run?: string;
  set: string[];
  /** The case itself. */
  text?: string;
  kind?: Kind;
  /** Speed of modes, with its unit. */
  speed?: string;
  /** Largest speed of a Campbell diagram, with its unit. */
  most?: string;
  /** The version that made it. */
  version?: string;
}

const KINDS = ["run", "modes", "campbell", "statics"];

/** The fragment, without `#`. */
export async function write(link: Link): Promise<string> {
  const out = new URLSearchParams();
  if (link.text !== undefined) out.set("c", await pack(link.text));
  else if (link.named) {
    out.set("case", link.named);
    if (link.run) out.set("run", link.run);
    for (const change of link.set) out.append("set", change);
  }
  if (link.kind && link.kind !== "run") out.set("do", link.kind);
  if (link.speed) out.set("speed", link.speed);
  if (link.most) out.set("most", link.most);
  if (link.version) out.set("v", link.version);
  return out.toString().replaceAll("%2F", "/").replaceAll("%3D", "=");
}

/** What a fragment says; throws with words for the reader of the page. */
export async function read(fragment: string): Promise<Link> {
  const given = fragment.replace(/^#/, "");
  if (given.length > LONGEST) throw new Error(`The link has ${given.length} characters; ${LONGEST} is the most.`);
  const from = new URLSearchParams(given);
  const short = (name: string) => from.get(name)?.slice(0, 200) || undefined;
  const kind = short("do");
  if (kind && !KINDS.includes(kind)) throw new Error(`The link asks for “${kind}”, which is none of ${KINDS.join(", ")}.`);
  const packed = from.get("c");
  return {
    named: short("case"),
    run: short("run"),
    set: from.getAll("set"),
    text: packed === null ? undefined : await unpack(packed),
    kind: kind as Kind | undefined,
    speed: short("speed"),
    most: short("most"),
    version: short("v"),
  };
}

async function pack(text: string): Promise<string> {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const packed = new Uint8Array(await new Response(stream).arrayBuffer());
  let binary = "";
  for (let i = 0; i < packed.length; i += 8192) binary += String.fromCharCode(...packed.subarray(i, i + 8192));
  return btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

async function unpack(packed: string): Promise<string> {
  const damaged = "The case in the link is damaged: was the link cut off?";
  if (!/^[A-Za-z0-9_-]+$/.test(packed)) throw new Error(damaged);
  let source: Uint8Array<ArrayBuffer>;
  try {
    source = Uint8Array.from(atob(packed.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
  } catch {
    throw new Error(damaged);
  }
  const reader = new Blob([source]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader();
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let size = 0;
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) break;
      size += value.length;
      if (size > LARGEST) {
        await reader.cancel();
        throw new RangeError(`The case in the link is larger than ${LARGEST / 1024} kB.`);
      }
      parts.push(value as Uint8Array<ArrayBuffer>);
    }
    const text = await new Blob(parts).arrayBuffer();
    return new TextDecoder("utf-8", { fatal: true }).decode(text);
  } catch (error) {
    throw error instanceof RangeError ? error : new Error(damaged);
  }
}
