// Asks the engine what nobody should: cut, changed and huge cases and requests.
//
//     node hostile.mjs ENGINE.wasm [COUNT]
//
// Each is answered, within its limits of work and memory. Exits with 1 if one takes more than LONGEST seconds, or ends in a trap.

import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { Worker, isMainThread, parentPort, workerData } from "node:worker_threads";
import { open } from "./engine.mjs";

const LONGEST = 20;
const LIMITS = { work: 2e5, memory: 2.56e8 };
const WHAT = ["check", "run", "run", "run", "modes", "campbell", "statics", "change", "difference", "files", "keys", "version"];
const ODD = [
    "0", "-1", "1e308", "-1e308", "1e-308", "nan", "inf", "1000000", "100000000", "9223372036854775807", "0.5", '""', "[]", "{}", "true",
    '"</script><b>"', '"\\u0000"', '"1e9 s"', '"1 parsec"', "[[1]]", '{ kind = "x" }', '"' + "x".repeat(5000) + '"', "1979-05-27",
    "[" + "[".repeat(200) + "]".repeat(200) + "]",
];

const used = (before) => {
    const { user, system } = process.cpuUsage(before);
    return (user + system) / 1e6;
};

/** Numbers from 0 to 1 that are the same each time (mulberry32). */
function randomly(seed) {
    return () => {
        seed = (seed + 0x6d2b79f5) | 0;
        let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
        t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
        return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
    };
}

function request(number, texts) {
    const random = randomly(number);
    const among = (list) => list[Math.floor(random() * list.length)];
    let text = among(texts);
    // Half of them are sound but for one or two numbers.
    const sound = random() < 0.5;
    const times = 1 + Math.floor(random() * (sound ? 2 : 3));
    for (let i = 0; i < times; i++) {
        const lines = text.split("\n");
        const at = Math.floor(random() * lines.length);
        switch (sound ? 4 : Math.floor(random() * 8)) {
            case 0: text = text.slice(0, Math.floor(random() * text.length)); break;
            case 1: lines.splice(at, 1); text = lines.join("\n"); break;
            case 2: lines.splice(at, 0, among(lines)); text = lines.join("\n"); break;
            case 3: {
                const place = Math.floor(random() * text.length);
                text = text.slice(0, place) + String.fromCharCode(Math.floor(random() * 300)) + text.slice(place + 1);
                break;
            }
            // A number of the case for another.
            case 4: case 5: {
                const numbers = [...text.matchAll(/-?\d+(\.\d+)?(e-?\d+)?/g)];
                if (numbers.length === 0) break;
                const found = among(numbers);
                const other = among(["0", "-3", "1e9", "1e-9", "1e30", "7", "1000000", "300", "2000", "100000", String(Number(found[0]) * 10)]);
                text = text.slice(0, found.index) + other + text.slice(found.index + found[0].length);
                break;
            }
            default: lines[at] = lines[at].replace(/= .*/, `= ${among(ODD)}`); text = lines.join("\n");
        }
    }
    const all = {
        do: among(WHAT), case: text, limits: LIMITS, errors: random() < 0.3, from: among(texts), speeds: sound ? among(["0:20:11", "0:1e9:100000"]) : among(["x", "5:1", 3]),
        speed: sound ? among([0, 4, 1e12, "12 rpm"]) : among(["nan", -1]), count: sound ? among([3, 1000]) : among([-1, 1e9, "x"]), to: sound ? among([1, 1e9]) : -1,
        of: among(["run", "modes", "campbell", "statics", "x"]), files: !sound && random() < 0.2 ? { "a.csv": "QQ==", "b": "!" } : {},
        set: !sound && random() < 0.2 ? { [among(["basis.elements", "run.duration", "x.y.z", "", "beam", "load[99]"])]: among(ODD) } : {},
    };
    const json = JSON.stringify(all);
    return !sound && random() < 0.05 ? json.slice(0, Math.floor(random() * json.length)) : json;
}

if (isMainThread) {
    const [module, count = 500] = process.argv.slice(2);
    const root = fileURLToPath(new URL("../../verification", import.meta.url));
    const texts = readdirSync(root).map((name) => join(root, name, "case.toml")).filter(existsSync).map((file) => readFileSync(file, "utf8"));
    const statuses = {};
    let [traps, hangs, slowest] = [[], [], 0];
    const open = () => new Worker(fileURLToPath(import.meta.url), { workerData: { module } });
    let worker = open();
    for (let number = 1; number <= count; number++) {
        const asked = request(number, texts);
        const before = process.cpuUsage();
        const answer = await new Promise((resolve) => {
            // Time of the processor, for a machine may have other work.
            const timer = setInterval(() => used(before) > LONGEST && (clearInterval(timer), resolve({ hang: true })), 200);
            worker.once("message", (message) => (clearInterval(timer), resolve(message)));
            worker.postMessage(asked);
        });
        const seconds = used(before);
        slowest = Math.max(slowest, seconds);
        if (answer.hang) hangs.push(number);
        if (answer.trap) traps.push(`${number}: ${answer.trap}`);
        if (answer.hang || answer.trap) {
            await worker.terminate();
            worker = open();
        } else statuses[answer.status] = (statuses[answer.status] ?? 0) + 1;
        if (process.env.SHOW && seconds > 3) console.log(number, seconds.toFixed(1), JSON.stringify(answer).slice(0, 200));
    }
    await worker.terminate();
    console.log(`${count} requests: ${JSON.stringify(statuses)}; the slowest ${slowest.toFixed(1)} s`);
    if (traps.length) console.log(`traps:\n  ${traps.join("\n  ")}`);
    if (hangs.length) console.log(`more than ${LONGEST} s: ${hangs.join(", ")}`);
    process.exit(hangs.length || traps.length ? 1 : 0);
} else {
    let panic;
    const { ask } = await open(workerData.module, (shown) => (panic = shown.phase === "panic" ? shown.message : panic));
    parentPort.on("message", (text) => {
        try {
            const { status = "told", message } = ask(text);
            parentPort.postMessage({ status, message });
        } catch (error) {
            parentPort.postMessage({ trap: panic ?? String(error) });
        }
    });
}
