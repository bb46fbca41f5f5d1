// How long the lab takes from an empty cache to the first curves, at 10 Mbit/s and on a processor that is four times slower: the median of some
// loads, and the times at which the page, the engine and the answer are there. Exits with 1 if it takes longer than LONGEST seconds.
//
//     [LONGEST=3] node test/load.mjs CHROMIUM [SITE/lab] [COUNT]
import { join } from "node:path";
import { launch, opened, serve } from "./open.mjs";

const [program, folder = join(import.meta.dirname, "../dist"), count = "5"] = process.argv.slice(2);
const LONGEST = Number(process.env.LONGEST ?? 3);
/** Bytes a second, and the time to the server and back [ms]. */
const [THROUGHPUT, LATENCY] = [10e6 / 8, 40];
const SLOWER = 4;

/** Notes when the answer first stands for the case, in the page. */
function watch() {
  document.addEventListener("DOMContentLoaded", () => {
    const result = document.querySelector("#result");
    const observer = new MutationObserver(() => {
      if (result.classList.contains("stale")) return;
      observer.disconnect();
      requestAnimationFrame(() => setTimeout(() => performance.mark("answer")));
    });
    observer.observe(result, { attributes: true });
  });
}

/** Times from the beginning of a load [s]. */
async function load(browser, address) {
  const { page, close } = await opened(browser);
  const session = await page.context().newCDPSession(page);
  await session.send("Network.enable");
  await session.send("Network.setCacheDisabled", { cacheDisabled: true });
  await session.send("Network.emulateNetworkConditions", { offline: false, latency: LATENCY, downloadThroughput: THROUGHPUT, uploadThroughput: THROUGHPUT });
  await session.send("Emulation.setCPUThrottlingRate", { rate: SLOWER });
  await page.addInitScript(watch);
  await page.goto(`${address}/index.html#case=p1_spin_up_4`);
  await page.waitForFunction(() => performance.getEntriesByName("answer").length > 0, undefined, { timeout: 60_000 });
  const times = await page.evaluate(() => {
    const end = (entry) => entry.responseEnd / 1000;
    const [navigation] = performance.getEntriesByType("navigation");
    const engine = performance.getEntriesByType("resource").find(({ name }) => name.endsWith("engine.wasm"));
    const [answer] = performance.getEntriesByName("answer");
    return { page: end(navigation), parsed: navigation.domContentLoadedEventEnd / 1000, engine: end(engine), answer: answer.startTime / 1000 };
  });
  await close();
  return times;
}

const browser = await launch(program);
const { address, close } = await serve(folder, { compressed: true });
const loads = [];
for (let k = 0; k < Number(count); k++) loads.push(await load(browser, address));
await browser.close();
close();
const median = (name) => loads.map((times) => times[name]).sort((a, b) => a - b)[Math.floor(loads.length / 2)];
const said = Object.entries({ page: "the page is there", parsed: "and runs", engine: "the engine is there", answer: "the first curves are drawn" });
console.log(said.map(([name, words]) => `${words} after ${median(name).toFixed(2)} s`).join(", "));
process.exit(median("answer") > LONGEST ? 1 : 0);
