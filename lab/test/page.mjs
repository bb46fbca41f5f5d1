// Opens pages of `flexion view` in Chromium, at the widths of a desk and of a telephone: no error on the console, no request, the
// picture moves, keys and lists act, the cursor of the curves follows the time, nothing is wider than the page.
//
//     node test/page.mjs CHROMIUM PAGE… [--pictures DIR]
import assert from "node:assert/strict";
import { basename, join, resolve } from "node:path";
import { launch, opened, screens } from "./open.mjs";

const marked = process.argv.indexOf("--pictures");
const pictures = marked > 0 ? process.argv.splice(marked, 2)[1] : undefined;
const [executablePath, ...pages] = process.argv.slice(2);
assert.ok(pages.length > 0, "usage: node test/page.mjs CHROMIUM PAGE… [--pictures DIR]");

const browser = await launch(executablePath);

for (const page of pages) {
  for (const screen of screens) {
    await look(page, screen);
    console.log(`${basename(page)} at ${screen.viewport.width} px, ${screen.colorScheme}: ok`);
  }
}
await browser.close();
console.log(`${pages.length * screens.length} passed, 0 failed`);

async function look(path, { name, viewport, colorScheme }) {
  const { page, spoken, requested, close } = await opened(browser, { viewport, colorScheme, deviceScaleFactor: 1 });
  const { width } = viewport;
  const address = `file://${resolve(path)}`;
  await page.goto(address);

  // It plays.
  const value = () => page.$eval("#scrubber", (scrubber) => Number(scrubber.value));
  const [low, high] = await page.$eval("#scrubber", (s) => [Number(s.min), Number(s.max)]);
  const pixels = () => page.locator("#canvas").screenshot();
  const [before, first] = [await value(), await pixels()];
  const far = async () => Math.abs((await value()) - before) > 0.03 * (high - low);
  for (let tries = 0; tries < 300 && !(await far()); tries++) await page.waitForTimeout(100);
  assert.ok(await far(), "time goes on");
  assert.ok(!first.equals(await pixels()), "the picture moves");

  // What touches or is loaded has arrows.
  if (/contact/.test(basename(path))) assert.match(await page.textContent("#note"), /Arrows are forces, the longest [\d.e]+ N\./);
  if (/loaded/.test(basename(path))) assert.match(await page.textContent("#note"), /Rows of arrows are forces per length, the longest 800 N\/m\./);

  // Space pauses, the arrows step.
  await page.locator("h1").click();
  await page.keyboard.press("Space");
  assert.equal(await page.getAttribute("#play", "aria-label"), "Play");
  await page.keyboard.press("Home");
  assert.equal(await value(), low);
  await page.keyboard.press("ArrowRight");
  const stepped = await value();
  assert.ok(stepped > low && stepped < low + 0.2 * (high - low), `one step leads to ${stepped}`);
  await page.keyboard.press("ArrowLeft");
  assert.equal(await value(), low);
  const start = await pixels();

  // The scrubber leads picture and cursor, and the cursor leads the scrubber.
  await page.$eval("#scrubber", (scrubber, time) => {
    scrubber.value = time;
    scrubber.dispatchEvent(new Event("input"));
  }, low + 0.4 * (high - low));
  assert.ok(!start.equals(await pixels()), "another time is another picture");
  const cursor = page.locator(".cursor").first();
  if ((await cursor.count()) > 0) {
    await cursor.scrollIntoViewIfNeeded();
    const plot = await page.locator(".u-over").first().boundingBox();
    const line = await cursor.boundingBox();
    assert.ok(Math.abs((line.x + line.width / 2 - plot.x) / plot.width - 0.4) < 0.02, "the cursor stands at 40 %");
    await page.mouse.click(plot.x + 0.7 * plot.width, plot.y + 0.5 * plot.height);
    const share = ((await value()) - low) / (high - low);
    assert.ok(Math.abs(share - 0.7) < 0.02, `the curve leads to ${share}`);
    const chosen = await page.locator(".panel").count();
    await page.locator("summary").click();
    await page.locator(".columns input:not(:checked)").first().check();
    assert.equal(await page.locator(".panel").count(), chosen + 1, "a column is added");
    await page.locator(".columns input:checked").first().uncheck();
    await page.locator("summary").click();
  } else {
    await page.locator("td input").nth(1).check();
    assert.ok(!start.equals(await pixels()), "another mode is another picture");
  }

  // Everything that acts has a name, and the page fits its width.
  const nameless = await page.$$eval("button, select, input", (all) =>
    all.filter((e) => !(e.ariaLabel || e.textContent.trim() && e.tagName === "BUTTON" || e.labels?.length)).length);
  assert.equal(nameless, 0, "controls without a name");
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= width, `the page is ${wide} px wide`);

  if (pictures) {
    await page.evaluate(() => scrollTo(0, 0));
    await page.waitForTimeout(100);
    await page.screenshot({ path: join(pictures, `${basename(path, ".html")}.${name}.png`), fullPage: name === "telephone" });
  }
  assert.deepEqual(spoken, [], "the console is silent");
  assert.deepEqual(requested, [address], "nothing is requested");
  await close();
}
