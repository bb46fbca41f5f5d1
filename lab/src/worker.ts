// The engine in a worker: one request at a time, its reply, and its progress in between.

interface Exports {
  memory: WebAssembly.Memory;
  allocate(bytes: number): number;
  release(at: number, bytes: number): void;
  call(at: number, bytes: number): number;
  reply_length(): number;
}

let engine: Exports | undefined;
const { port } = { port: self as unknown as Worker };

const text = (at: number, bytes: number) => new TextDecoder().decode(new Uint8Array(engine!.memory.buffer, at, bytes));

const env = {
  clock: () => performance.now() / 1000,
  progress: (at: number, bytes: number) => port.postMessage({ progress: text(at, bytes) }),
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

self.onmessage = ({ data }: MessageEvent<{ module?: WebAssembly.Module; request?: string }>) => {
  try {
    if (data.module) engine = new WebAssembly.Instance(data.module, { env }).exports as unknown as Exports;
    if (data.request) port.postMessage({ reply: reply(data.request), bytes: engine!.memory.buffer.byteLength });
  } catch (error) {
    // A module that finds no memory ends at an instruction of this name.
    const message = String((error as Error).message ?? error);
    port.postMessage({ trap: message.startsWith("unreachable") ? "the case takes more memory than there is, or the engine has a fault" : message });
  }
};
