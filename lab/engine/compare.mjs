// Runs the verification cases in WebAssembly and by the program, and compares their files byte by byte:
//
//     [LONGEST=10] node compare.mjs ENGINE.wasm FLEXION [NAME…]
//
// trajectory.csv, events.csv, the resolved case, and summary.json without its times: status, warnings and estimated errors are in it. A case
// that takes the program more than LONGEST seconds, or goes on from an archive, which the module does not read, is listed and left out. Exits with
// 1 if a byte differs.

import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync } from "node:fs";
import { availableParallelism, tmpdir } from "node:os";
import { join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { Worker, isMainThread, parentPort, workerData } from "node:worker_threads";
import { open } from "./engine.mjs";

const LONGEST = Number(process.env.LONGEST ?? 10);
const TIMES = /"(wall_time|cpu_time|preparation_wall_time|preparation_cpu_time)": [^\n]*\n/g;
const root = fileURLToPath(new URL("../../verification", import.meta.url));

/** The texts of a list of TOML that begins at a place. */
function texts(toml, at) {
    const found = [];
    const text = /\s*(?:#[^\n]*\n|,|'([^']*)'|"((?:[^"\\]|\\.)*)"|(\]))/y;
    text.lastIndex = at;
    for (let match; (match = text.exec(toml)) && !match[3]; ) {
        if (match[1] !== undefined) found.push(match[1]);
        if (match[2] !== undefined) found.push(JSON.parse(`"${match[2]}"`));
    }
    return found;
}

/** Every case and every variant of one: name, folder, changes. */
function cases() {
    const folders = readdirSync(root).filter((folder) => existsSync(join(root, folder, "case.toml"))).sort();
    return folders.flatMap((folder) => {
        const [, ...variants] = readFileSync(join(root, folder, "expected.toml"), "utf8").split("[[variant]]");
        const variant = (toml) => {
            const name = `${folder}/${/^name = "(.*)"/m.exec(toml)[1]}`;
            const set = /^set = \[/m.exec(toml);
            return { name, folder, set: texts(toml, set.index + set[0].length) };
        };
        return [{ name: folder, folder, set: [] }, ...variants.map(variant)];
    });
}

/** The files that a case may name: those in its folder, and those that its text names. */
function files(folder, text) {
    const path = join(root, folder);
    const beside = readdirSync(path, { recursive: true }).filter((name) => statSync(join(path, name)).isFile());
    const named = [...text.matchAll(/file *= *["']([^"'\n]+)["']/g)].map((match) => match[1]);
    const decks = named.flatMap((name) => {
        const around = join(path, name, "..");
        return existsSync(around) ? readdirSync(around).map((file) => relative(path, join(around, file))) : [];
    });
    const all = [...new Set([...beside, ...named, ...decks])].filter((name) => {
        const file = join(path, name);
        return existsSync(file) && statSync(file).isFile() && statSync(file).size < 1e7;
    });
    return Object.fromEntries(all.map((name) => [name, readFileSync(join(path, name)).toString("base64")]));
}

function compare(ask, program, { name, folder, set }, work) {
    const output = join(work, name.replaceAll("/", "-"));
    const changes = [...set, "output.plots=false"];
    const words = ["run", join(root, folder), "--output", output, ...changes.flatMap((change) => ["--set", change])];
    const native = spawnSync(program, words, { encoding: "utf8", timeout: 1000 * LONGEST, killSignal: "SIGKILL" });
    if (native.signal) return { name, slow: true };
    const text = readFileSync(join(root, folder, "case.toml"), "utf8");
    if (/state\.npz/.test(text + set.join("\n"))) return { name, archive: true };
    const started = performance.now();
    const reply = ask({
        do: "files",
        case: text,
        files: files(folder, text + set.join("\n")),
        set: Object.fromEntries(changes.map((change) => change.split(/=(.*)/s).slice(0, 2))),
        errors: true,
    });
    const seconds = (performance.now() - started) / 1000;
    if (!existsSync(join(output, "summary.json"))) {
        // The program has refused it: so must the module.
        const refused = (reply.problems ?? []).every((problem) => native.stderr.includes(problem.message.split("\n")[0]));
        return { name, seconds, differs: reply.status === "rejected" && refused ? [] : [`${reply.status}: ${reply.message}, and the program: ${native.stderr}`] };
    }
    if (!reply.files) return { name, seconds, differs: [`${reply.status}: ${reply.message}`] };
    const differs = [];
    const names = readdirSync(output).filter((file) => /\.(csv|toml|json|vtu|pvd)$/.test(file));
    for (const file of names) {
        const [ours, theirs] = [Buffer.from(reply.files[file] ?? "", "base64").toString(), readFileSync(join(output, file), "utf8")]
            .map((text) => (file === "summary.json" ? text.replace(TIMES, "") : text).split("\n"));
        const line = theirs.findIndex((line, i) => line !== ours[i]);
        if (line >= 0 || ours.length !== theirs.length) {
            differs.push(`${file} line ${line + 1}: ${ours[line]?.slice(0, 120)}, and the program: ${theirs[line]?.slice(0, 120)}`);
        }
    }
    rmSync(output, { recursive: true });
    return { name, seconds, differs };
}

if (isMainThread) {
    const [module, program, ...chosen] = process.argv.slice(2);
    const started = performance.now();
    const list = cases().filter(({ name }) => chosen.length === 0 || chosen.some((word) => name.includes(word)));
    const work = mkdtempSync(join(tmpdir(), "flexion-"));
    const found = [];
    const next = (worker) => (list.length > 0 ? worker.postMessage(list.shift()) : worker.terminate());
    const threads = Array.from({ length: Math.min(availableParallelism(), list.length) }, () => {
        const worker = new Worker(fileURLToPath(import.meta.url), { workerData: { module, program, work } });
        worker.on("message", (message) => {
            if (message.name) found.push(message);
            if (process.env.SHOW && message.name) console.log(message.name, message.slow ? "slow" : message.differs?.length ? "differs" : "same");
            if (message.differs?.length) console.log(`${message.name}\n  ${message.differs.join("\n  ")}`);
            next(worker);
        });
        return new Promise((resolve) => worker.on("exit", resolve));
    });
    await Promise.all(threads);
    rmSync(work, { recursive: true });
    const [slow, wrong] = [found.filter((of) => of.slow), found.filter((of) => of.differs?.length)];
    const archives = found.filter((of) => of.archive);
    if (archives.length) console.log(`from an archive: ${archives.map((of) => of.name).join(", ")}`);
    if (slow.length) console.log(`more than ${LONGEST} s by the program: ${slow.map((of) => of.name).join(", ")}`);
    const seconds = ((performance.now() - started) / 1000).toFixed(0);
    console.log(`${found.length - slow.length - archives.length - wrong.length} of ${found.length} cases give the same bytes, ${wrong.length} do not; ${seconds} s`);
    process.exit(wrong.length ? 1 : 0);
} else {
    const { module, program, work } = workerData;
    let engine = await open(module);
    parentPort.on("message", async (job) => {
        try {
            parentPort.postMessage(compare(engine.ask, program, job, work));
        } catch (error) {
            engine = await open(module);
            parentPort.postMessage({ name: job.name, differs: [String(error)] });
        }
    });
    parentPort.postMessage({});
}
