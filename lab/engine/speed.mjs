// How long requests take in WebAssembly, over how long they take natively: medians of the time of the processor, after a warm-up, each of as many
// requests as take 0.2 s, for systems count that time in steps of some milliseconds. Exits with 1 if one takes more than twice as long.
//
//     cargo build --profile wasm -p flexion-lab --example answer
//     node speed.mjs ENGINE.wasm target/wasm/examples/answer [COUNT]

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { open } from "./engine.mjs";

const [module, native, count = "20"] = process.argv.slice(2);
const root = fileURLToPath(new URL("../..", import.meta.url));
const spinUp = "verification/p1_spin_up_4/case.toml";
const requests = {
    "P1, first": { do: "run", case: spinUp },
    "P1, exact": { do: "run", case: spinUp, set: { "model.coupling": "exact" } },
    "falling pendulum": { do: "run", case: "verification/falling_pendulum/case.toml" },
    "P2 (i) to 3 s": { do: "run", case: "papers/P2/cases/air_bearing.toml", until: 3 },
    "Campbell diagram": { do: "campbell", case: spinUp, speeds: "0:20:41", modes: 4 },
};
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
/** Largest ratio. */
const MOST = 2;
/** What a time is measured over at least [s]. */
const LEAST = 0.2;
let slow = 0;
const work = mkdtempSync(join(tmpdir(), "flexion-"));
const file = join(work, "request.json");
for (const [name, request] of Object.entries(requests)) {
    const { ask } = await open(module);
    const whole = { ...request, case: readFileSync(join(root, request.case), "utf8") };
    writeFileSync(file, JSON.stringify(whole));
    const once = () => {
        const before = process.cpuUsage();
        const { status, message } = ask(whole);
        if (status !== "finished" && status !== "stopped") throw new Error(`${name}: ${status}: ${message}`);
        const { user, system } = process.cpuUsage(before);
        return (user + system) / 1e6;
    };
    const first = once();
    for (let k = 0; k < 5; k++) once();
    const several = Math.ceil(LEAST / Math.max(median(Array.from({ length: 5 }, once)), 1e-3));
    const mean = () => Array.from({ length: several }, once).reduce((sum, time) => sum + time / several, 0);
    const [ours, theirs, ratios] = [[], [], []];
    // By turns, for the processor is not always as fast.
    for (let k = 0; k < Number(count); k++) {
        ours.push(Array.from({ length: several }, once).reduce((sum, time) => sum + time / several, 0));
        theirs.push(Number(execFileSync(native, [file, "1", String(LEAST)], { encoding: "utf8" }).split(" ")[0]));
        ratios.push(ours[k] / theirs[k]);
    }
    const ratio = median(ratios);
    const ms = (seconds) => `${(1000 * seconds).toFixed(1)} ms`;
    if (ratio > MOST) slow += 1;
    console.log(`${name}: ${ms(median(ours))} in WebAssembly, ${ms(median(theirs))} natively, ratio ${ratio.toFixed(2)}; the first call ${ms(first)}`);
}
rmSync(work, { recursive: true });
process.exit(slow ? 1 : 0);
