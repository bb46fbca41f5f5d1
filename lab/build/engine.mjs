// The engine in Node: `const ask = await engine(FILE)`, then `ask({ do: "run", case: TEXT, set: ["KEY=VALUE"] })`.
import { readFileSync } from "node:fs";

const changes = (list) => Object.fromEntries(list.map((change) => [change.slice(0, change.indexOf("=")), change.slice(change.indexOf("=") + 1)]));

export async function engine(file) {
  const module = await WebAssembly.compile(readFileSync(file));
  const made = () => {
    const { exports } = new WebAssembly.Instance(module, { env: { clock: () => performance.now() / 1000, progress: () => {} } });
    return exports;
  };
  let of = made();
  return (request) => {
    try {
      const bytes = new TextEncoder().encode(JSON.stringify({ ...request, set: changes(request.set ?? []) }));
      const at = of.allocate(bytes.length);
      new Uint8Array(of.memory.buffer, at, bytes.length).set(bytes);
      const start = of.call(at, bytes.length);
      const reply = new TextDecoder().decode(new Uint8Array(of.memory.buffer, start, of.reply_length()));
      of.release(at, bytes.length);
      return JSON.parse(reply);
    } catch (error) {
      of = made();
      return { status: "failed", message: String(error.message) };
    }
  };
}
