// The engine in a worker: one request at a time, its reply, and its progress in between.

interface Exports {
  memory: WebAssembly.Memory;
  allocate(bytes: number): number;
  release(at: number, bytes: number): void;
  call(at: number, bytes: number): number;
  reply_length(): number;
}

class Exhausted extends Error {}

let engine: Exports | undefined;
const { port } = { port: self as unknown as Worker };

const text = (at: number, bytes: number) => new TextDecoder().decode(new Uint8Array(engine!.memory.buffer, at, bytes));

const env = {
  clock: () => performance.now() / 1000,
  progress: (at: number, bytes: number) => port.postMessage({ progress: text(at, bytes) }),
  exhausted: () => {
    throw new Exhausted();
  },
};

function reply(request: string): string {
  const bytes = new TextEncoder().encode(request);
  const at = engine!.allocate(bytes.length);
  new Uint8Array(engine!.memory.buffer, at, bytes.length).set(bytes);
  const start = engine!.call(at, bytes.length);
  const answer = text(start, engine!.reply_length());
  engine!.release(at, bytes.length);
  return answer;
}

let module: WebAssembly.Module | undefined;
const start = () => (engine = new WebAssembly.Instance(module!, { env }).exports as unknown as Exports);

self.onmessage = ({ data }: MessageEvent<{ module?: WebAssembly.Module; request?: string }>) => {
  try {
    if (data.module) {
      module = data.module;
      start();
    }
    if (data.request) port.postMessage({ reply: reply(data.request), bytes: engine!.memory.buffer.byteLength });
  } catch (error) {
    if (!(error instanceof Exhausted)) return port.postMessage({ trap: String((error as Error).message ?? error) });
    // What the instance holds is of no use.
    start();
    port.postMessage({ reply: JSON.stringify({ status: "given-up", message: "It takes more memory than it may." }), bytes: 0 });
  }
};
