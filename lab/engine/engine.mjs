// The engine in Node: `await open(FILE)` gives `ask(request)`, which returns the reply. A request that finds no memory is given up, and the next one
// has an instance of its own.

import { readFileSync } from "node:fs";

class Exhausted extends Error {}

/** Opens a module; `shown` gets what it shows while it computes. */
export async function open(file, shown = () => {}) {
    const module = await WebAssembly.compile(readFileSync(file));
    const text = (address, length) => new TextDecoder().decode(new Uint8Array(memory().buffer, address, length));
    const env = {
        clock: () => performance.now() / 1000,
        progress: (address, length) => shown(JSON.parse(text(address, length))),
        exhausted: () => {
            throw new Exhausted();
        },
    };
    const instance = () => new WebAssembly.Instance(module, { env }).exports;
    let exports = instance();
    const memory = () => exports.memory;
    const answered = (bytes) => {
        const address = exports.allocate(bytes.length);
        new Uint8Array(memory().buffer).set(bytes, address);
        const reply = exports.call(address, bytes.length);
        exports.release(address, bytes.length);
        return JSON.parse(text(reply, exports.reply_length()));
    };
    const ask = (request) => {
        try {
            return answered(new TextEncoder().encode(typeof request === "string" ? request : JSON.stringify(request)));
        } catch (error) {
            if (!(error instanceof Exhausted)) throw error;
            exports = instance();
            return { status: "given-up", message: "given up at the limit of the memory that it may take" };
        }
    };
    return { ask, memory: () => memory().buffer.byteLength };
}

/** Numbers of an array of a reply. */
export function numbers({ values }) {
    const [kind, text] = values.split(":");
    const bytes = Uint8Array.from(Buffer.from(text, "base64"));
    return kind === "f4" ? new Float32Array(bytes.buffer) : new Float64Array(bytes.buffer);
}
