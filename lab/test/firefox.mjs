// Three journeys in Firefox as Debian has it, by its own remote control: open a link, move a slider, break the case and mend it.
//
//     node test/firefox.mjs FIREFOX [SITE/lab]
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { serve } from "./open.mjs";

const [program, folder = join(import.meta.dirname, "../dist")] = process.argv.slice(2);
const profile = mkdtempSync(join(tmpdir(), "flexion-firefox-"));
const port = 20000 + (process.pid % 20000);
writeFileSync(join(profile, "user.js"), [
  `user_pref("marionette.port", ${port});`,
  'user_pref("devtools.console.stdout.content", true);',
  'user_pref("browser.shell.checkDefaultBrowser", false);',
  'user_pref("datareporting.policy.dataSubmissionEnabled", false);',
].join("\n"));
const browser = spawn(program, ["--headless", "--marionette", "--profile", profile, "--no-remote"], { stdio: ["ignore", "pipe", "pipe"] });
let spoken = "";
for (const stream of [browser.stdout, browser.stderr]) stream.on("data", (data) => (spoken += data));

/** The remote control: messages of JSON behind their lengths. */
async function control() {
  let socket;
  for (let tries = 0; tries < 300 && !socket; tries++) {
    socket = await new Promise((resolve) => {
      const made = connect(port, "127.0.0.1", () => resolve(made));
      made.on("error", () => setTimeout(() => resolve(undefined), 100));
    });
  }
  assert.ok(socket, `Firefox does not answer: ${spoken}`);
  let [buffer, number] = [Buffer.alloc(0), 0];
  const waiting = new Map();
  socket.on("data", (data) => {
    buffer = Buffer.concat([buffer, data]);
    for (;;) {
      const colon = buffer.indexOf(":");
      const length = Number(buffer.subarray(0, Math.max(colon, 0)).toString());
      if (colon < 0 || buffer.length < colon + 1 + length) return;
      const message = JSON.parse(buffer.subarray(colon + 1, colon + 1 + length).toString());
      buffer = buffer.subarray(colon + 1 + length);
      // The first message says who speaks.
      if (!Array.isArray(message)) continue;
      const [, id, error, result] = message;
      const [resolve, reject] = waiting.get(id) ?? [];
      if (error) reject?.(new Error(`${error.error}: ${error.message}`));
      else resolve?.(result);
    }
  });
  const send = (name, parameters = {}) =>
    new Promise((resolve, reject) => {
      waiting.set((number += 1), [resolve, reject]);
      const text = JSON.stringify([0, number, name, parameters]);
      socket.write(`${Buffer.byteLength(text)}:${text}`);
    });
  return { send, end: () => socket.destroy() };
}

const { send, end } = await control();
const { address, close } = await serve(folder);
let passed = 0;
try {
  await send("WebDriver:NewSession", { capabilities: {} });
  const run = async (script, ...args) => (await send("WebDriver:ExecuteScript", { script, args })).value;
  const until = async (script, what, seconds = 60) => {
    for (let tries = 0; tries < 10 * seconds; tries++) {
      if (await run(`return ${script}`)) return;
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    throw new Error(`${what}: ${await run('return document.querySelector("#state").textContent + document.querySelector("#problems").textContent')}`);
  };
  const answered = (what) => until('!document.querySelector("#result").classList.contains("stale") && document.querySelector("#stop").hidden', what);
  const least = () => run('return Number(document.querySelector(".values td").firstChild.textContent.replace("−", "-"))');
  const done = (name) => {
    passed += 1;
    console.log(`Firefox, ${name}: ok`);
  };

  await send("WebDriver:Navigate", { url: `${address}/index.html#case=p1_spin_up_4` });
  await answered("the link is opened");
  const before = await least();
  assert.ok(Math.abs(before + 0.4003) < 1e-3, `the least deflection is ${before}`);
  done("a link is opened");

  await run(`const slider = document.querySelector('[aria-label="hub.motion.speed"]');
    slider.value = 150; slider.dispatchEvent(new Event("input")); slider.dispatchEvent(new Event("change"));`);
  await until('location.hash.includes("hub.motion.speed")', "the link follows the slider");
  await answered("the answer follows the slider");
  assert.ok((await least()) < 1.2 * before, "a higher speed bends it more");
  done("a slider moves the answer");

  await run(`const box = document.querySelector("#key-beam\\\\.length"); box.value = "10 kg"; box.dispatchEvent(new Event("change"));`);
  await until('document.querySelectorAll("#problems li").length > 0', "a mistake is reported");
  await run(`const box = document.querySelector("#key-beam\\\\.length"); box.value = "9 m"; box.dispatchEvent(new Event("change"));`);
  await until('document.querySelectorAll("#problems li").length === 0', "it is mended");
  await answered("and answered");
  done("a case is broken and mended by the message");
  const wrong = spoken.split("\n").filter((line) => /console\.(error|warn)|JavaScript error/.test(line) && line.includes("localhost"));
  assert.deepEqual(wrong, [], "the console is silent");
  console.log(`${passed} passed`);
} finally {
  end();
  close();
  browser.kill();
  await new Promise((resolve) => browser.on("exit", resolve));
  rmSync(profile, { recursive: true, force: true });
}
