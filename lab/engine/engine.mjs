// The engine in Node: `await open(FILE)` gives `ask(request)`, which returns the reply.

import { readFileSync } from "node:fs";

/** Opens a module; `shown` gets what it shows while it computes. */
export async function open(file, shown = () => {}) {
    const module = await WebAssembly.compile(readFileSync(file));
    const text = (address, length) => new TextDecoder().decode(new Uint8Array(memory().buffer, address, length));
    const env = {
        clock: () => performance.now() / 1000,
        progress: (address, length) => shown(JSON.parse(text(address, length))),
    };
    const { exports } = await WebAssembly.instantiate(module, { env });
    const memory = () => exports.memory;
    const ask = (request) => {
        const bytes = new TextEncoder().encode(typeof request === "string" ? request : JSON.stringify(request));
        const address = exports.allocate(bytes.length);
        new Uint8Array(memory().buffer).set(bytes, address);
        const reply = exports.call(address, bytes.length);
        exports.release(address, bytes.length);
        return JSON.parse(text(reply, exports.reply_length()));
    };
    return { ask, memory: () => memory().buffer.byteLength };
}

/** Numbers of an array of a reply. */
export function numbers({ values }) {
    const [kind, text] = values.split(":");
    const bytes = Uint8Array.from(Buffer.from(text, "base64"));
    return kind === "f4" ? new Float32Array(bytes.buffer) : new Float64Array(bytes.buffer);
}
