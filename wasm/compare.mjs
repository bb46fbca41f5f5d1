// Runs the spin-up in WebAssembly and compares it with the trajectory of the native program:
//
//     node compare.mjs MODULE.wasm RESULTS/trajectory.csv
//
// Every value of every column must be equal to TOLERANCE of the column's peak. Exits with 1 if not.

import { readFileSync } from "node:fs";

const TOLERANCE = 1e-12;
const ELEMENTS = 10;

const [moduleFile, trajectoryFile] = process.argv.slice(2);
const bytes = readFileSync(moduleFile);
const { instance } = await WebAssembly.instantiate(bytes, {});
const flexion = instance.exports;

const started = performance.now();
const rows = flexion.flexion_run(ELEMENTS);
const elapsed = performance.now() - started;
const text = new Uint8Array(flexion.memory.buffer, flexion.flexion_heading(), flexion.flexion_heading_length());
const heading = new TextDecoder().decode(text);
if (rows === 0) {
    console.error(`the run failed: ${heading}`);
    process.exit(1);
}
const columns = flexion.flexion_columns();
const values = new Float64Array(flexion.memory.buffer, flexion.flexion_values(), rows * columns);

const [nativeHeading, ...lines] = readFileSync(trajectoryFile, "utf8").trimEnd().split("\n");
const native = lines.map((line) => line.split(",").map(Number));
if (nativeHeading !== heading || native.length !== rows) {
    console.error(`${native.length} rows of ${nativeHeading}\nare not ${rows} rows of ${heading}`);
    process.exit(1);
}

let [largest, place, equal] = [0, "", 0];
heading.split(",").forEach((name, column) => {
    const peak = Math.max(...native.map((row) => Math.abs(row[column])));
    native.forEach((row, i) => {
        const difference = Math.abs(values[i * columns + column] - row[column]);
        equal += difference === 0;
        // A column of zeros must be one of zeros.
        const relative = difference === 0 ? 0 : difference / peak;
        if (!(relative <= largest)) [largest, place] = [relative, `${name} at ${row[0]} s`];
    });
});
console.log(
    `${bytes.length} bytes, ${elapsed.toFixed(0)} ms; ${equal} of ${rows * columns} values are the native ones, ` +
        `the largest difference is ${largest.toExponential(1)} of a peak${place && `: ${place}`}`,
);
if (!(largest <= TOLERANCE)) process.exit(1);
