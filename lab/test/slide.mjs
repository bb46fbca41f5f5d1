// How long the lab takes from a move of a slider to the drawn answer, for P1 with the first-order coupling and its ten elements, on a processor that is four times slower: the
// median of some moves, one after the other. Exits with 1 if it takes longer than LONGEST milliseconds.
//
//     [LONGEST=100] node test/slide.mjs CHROMIUM [SITE/lab] [COUNT]
import { join } from "node:path";
import { answered, launch, opened, serve } from "./open.mjs";

const [program, folder = join(import.meta.dirname, "../dist"), count = "40"] = process.argv.slice(2);
const LONGEST = Number(process.env.LONGEST ?? 100);
const SLOWER = 4;

const browser = await launch(program);
const { address, close } = await serve(folder);
const { page } = await opened(browser);
await page.goto(`${address}/index.html#case=p1_spin_up_4`);
await answered(page);
const session = await page.context().newCDPSession(page);
await session.send("Emulation.setCPUThrottlingRate", { rate: SLOWER });
const times = await page.$eval('input[type=range][aria-label="hub.motion.speed"]', async (slider, count) => {
  const result = document.querySelector("#result");
  const drawn = () =>
    new Promise((resolve) => {
      const observer = new MutationObserver(() => {
        if (result.classList.contains("stale")) return;
        observer.disconnect();
        resolve(performance.now());
      });
      observer.observe(result, { attributes: true });
    });
  const times = [];
  for (let k = 0; k < count; k++) {
    slider.value = String(Number(slider.max) / 2 + (k % 40));
    const start = performance.now();
    const next = drawn();
    slider.dispatchEvent(new Event("input"));
    times.push((await next) - start);
    // Less than the pause after which errors are estimated.
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  return times;
}, Number(count));
await browser.close();
close();
// The first ones make what the others keep.
const rest = times.slice(5).sort((a, b) => a - b);
const [median, slow] = [0.5, 0.9].map((share) => rest[Math.floor(share * rest.length)]);
console.log(`from a move of a slider to its answer: ${median.toFixed(0)} ms (median), ${slow.toFixed(0)} ms (nine of ten)`);
process.exit(median > LONGEST ? 1 : 0);
