// Five hundred hostile links in one page: each is answered by a message or an answer, nothing in it is run, nothing is requested.
//
//     node test/hostile.mjs CHROMIUM [SITE/lab] [NUMBER]
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { deflateRawSync } from "node:zlib";
import { launch, opened, serve } from "./open.mjs";

const [program, folder = join(import.meta.dirname, "../dist"), count = "500"] = process.argv.slice(2);
const root = join(import.meta.dirname, "../..");
const good = ["p1_spin_up_4", "falling_pendulum", "space_joints", "roll_up"].map((name) => readFileSync(join(root, `verification/${name}/case.toml`), "utf8"));

/** Numbers at random, the same each time. */
let seed = 20261125;
const random = (n) => {
  seed = (seed * 48271) % 2147483647;
  return seed % n;
};
const pick = (list) => list[random(list.length)];
const pack = (text) => `c=${deflateRawSync(text).toString("base64url")}`;
const evil = [
  "<img src=x onerror=hacked()>", "</script><script>hacked()</script>", "<svg/onload=hacked()>", "javascript:hacked()", "\u202Eegassem\u0000", "${hacked()}",
  "{{hacked()}}", "'\"><iframe srcdoc='<script>parent.hacked()</script>'>", "%3Cscript%3Ehacked()%3C/script%3E", "a".repeat(20_000), "\u{1F4A5}".repeat(500), "__proto__", "constructor",
];
const quoted = (text) => JSON.stringify(text);

const makers = [
  () => pack(good[0]).slice(0, 5 + random(200)),
  () => {
    const bytes = [...deflateRawSync(pick(good))];
    for (let k = 0; k < 3; k++) bytes[random(bytes.length)] = random(256);
    return `c=${Buffer.from(bytes).toString("base64url")}`;
  },
  () => `c=${Buffer.from(Array.from({ length: 1 + random(3000) }, () => random(256))).toString("base64url")}`,
  () => `c=${"A".repeat(random(70_000))}`,
  () => `c=${deflateRawSync(Buffer.alloc((1 + random(40)) << 20, 65 + random(3))).toString("base64url")}`,
  () => pack(good[0].replace(/title = .*/, `title = ${quoted(pick(evil))}`)),
  () => pack(good[2].replaceAll('"bar"', quoted(pick(evil).slice(0, 2000)))),
  () => pack(`${pick(evil)} = 1\n${pick(good)}`),
  () => pack(good[1].replace('"ground"', quoted(pick(evil)))),
  () => pack(pick(good).replace(/duration = .*/, `duration = ${pick(['"1e9 s"', "1e300", "-1", "nan", "inf", quoted(pick(evil))])}`)),
  () => pack(good[0].replace("elements = 10", `elements = ${pick([0, -3, 100_000, 1e9, 9223372036854775807n])}`)),
  () => pack(good[0].replace('step = "0.02 s"', `step = ${pick(['"1e-12 s"', '"1e-300 s"', "0", '"1 ns"'])}`)),
  () => pack(`x = ${pick(["[", "{a=", "{a=["]).repeat(1 + random(20_000))}`),
  () => pack(`${"[a.".repeat(50)}b]\n`.repeat(1 + random(500))),
  () => pack(Array.from({ length: 20_000 }, (_, k) => `key${k} = ${k}`).join("\n")),
  () => pack(good[3].replace("[run]", `${"[[load]]\non = \"10 m\"\nforce = [1, 1]\n".repeat(random(5000))}[run]`)),
  () => pack(good[0].replace('"spin-up"', '"expression"').replace('speed = "4 rad/s", time = "15 s"', `angle = "${pick(["(".repeat(5000), "t^".repeat(5000) + "t", "exp(exp(exp(t^9)))", "1/0", "sqrt(-1)"])}"`)),
  () => pack(good[0].replace('kind = "uniform"', `kind = "deck"\nfile = ${quoted(pick(["../../../etc/passwd", "https://example.com/x", "//example.com/a.csv", "file:///etc/passwd", "C:\\x"]))}`)),
  () => `case=${encodeURIComponent(pick(evil))}`,
  () => `case=${encodeURIComponent(pick(["__proto__", "constructor", "toString", "../../x", "P1/__proto__", ""]))}&run=${encodeURIComponent(pick(evil))}`,
  () => `case=p1_spin_up_4&run=${encodeURIComponent(pick(evil))}`,
  () => `case=p1_spin_up_4&${Array.from({ length: random(500) }, () => `set=${encodeURIComponent(pick(evil).slice(0, 60))}`).join("&")}`,
  () => `case=p1_spin_up_4&set=${encodeURIComponent(pick(["basis.elements=1000000", "run.duration=1e12", "__proto__.x=1", "title=" + pick(evil), "=", "beam.length", "output.step=1e-9"]))}`,
  () => `case=p1_spin_up_4&do=${encodeURIComponent(pick(evil))}&v=${encodeURIComponent(pick(evil))}`,
  () => `case=p1_spin_up_4&v=${encodeURIComponent(pick(evil))}`,
  () => `case=p1_spin_up_4&do=${pick(["modes", "campbell", "statics"])}&speed=${encodeURIComponent(pick([...evil, "1e300 rad/s", "-5 rpm", "nan", "4 kg"]))}`,
  () => pick(evil).repeat(1 + random(5)),
  () => `c=${encodeURIComponent(pick(evil))}`,
  () => "%".repeat(1 + random(100)),
];

const browser = await launch(program);
const { address, close } = await serve(folder);
const { page, spoken, requested } = await opened(browser);
let dialogs = 0;
page.on("dialog", (dialog) => ((dialogs += 1), dialog.dismiss()));
await page.addInitScript(() => {
  window.attacks = 0;
  window.hacked = () => (window.attacks += 1);
});
await page.goto(`${address}/index.html`);
await page.waitForFunction(() => document.querySelector("#stop").hidden && document.querySelector("#title").textContent !== "");
const loaded = requested.length;

let [messages, answers, offers, slowest] = [0, 0, 0, 0];
const start = performance.now();
for (let k = 0; k < Number(count); k++) {
  const link = makers[k % makers.length]();
  const began = performance.now();
  await page.evaluate((link) => (location.hash = `#${link}`), link);
  await page.evaluate(() => new Promise((resolve) => setTimeout(resolve, 30)));
  try {
    await page.waitForFunction(() => document.querySelector("#stop").hidden, undefined, { timeout: 120_000, polling: 50 });
  } catch {
    throw new Error(`link ${k} of kind ${k % makers.length} has no end: ${link.slice(0, 200)}`);
  }
  const state = await page.evaluate(() => ({
    problems: document.querySelectorAll("#problems li").length,
    state: document.querySelector("#state").textContent,
    offered: !document.querySelector("#compute").hidden,
    answered: !document.querySelector("#result").classList.contains("stale"),
    attacks: window.attacks,
    strange: document.querySelectorAll("main img:not(.cm-widgetBuffer), main iframe, main script, main svg:not(.path), header img").length,
  }));
  assert.equal(state.attacks, 0, `link ${k} was run: ${link.slice(0, 200)}`);
  assert.equal(state.strange, 0, `link ${k} made elements: ${link.slice(0, 200)}`);
  if (state.problems > 0) messages += 1;
  else if (state.answered) answers += 1;
  else if (state.offered) offers += 1;
  else if (state.state !== "") messages += 1;
  else throw new Error(`link ${k} of kind ${k % makers.length} has no message: ${link.slice(0, 300)}`);
  slowest = Math.max(slowest, performance.now() - began);
}
assert.equal(dialogs, 0, "no dialog was opened");
assert.deepEqual(requested.slice(loaded), [], "nothing was requested");
assert.deepEqual(spoken, [], "the console is silent");

// The page still works.
await page.evaluate(() => (location.hash = "#case=space_joints"));
await page.waitForFunction(() => /bar falls/.test(document.querySelector("#title").textContent) && !document.querySelector("#result").classList.contains("stale"), undefined, { timeout: 40_000 });
await browser.close();
close();
const seconds = ((performance.now() - start) / 1000).toFixed(0);
console.log(`${count} hostile links in ${seconds} s: ${messages} messages, ${answers} answers, ${offers} offers to compute; the slowest took ${(slowest / 1000).toFixed(1)} s`);
