// Opens a report of `flexion reproduce` in Chromium, at the widths of a desk and of a telephone: no error on the console, no request, the
// filters show what is asked, links lead where they say, tables sort, nothing is wider than the page; on paper no table is cut.
//
//     node test/report.mjs CHROMIUM REPORT [--pictures DIR]
import assert from "node:assert/strict";
import { join, resolve } from "node:path";
import { launch, opened, screens } from "./open.mjs";

const marked = process.argv.indexOf("--pictures");
const pictures = marked > 0 ? process.argv.splice(marked, 2)[1] : undefined;
const [executablePath, report] = process.argv.slice(2);
assert.ok(report, "usage: node test/report.mjs CHROMIUM REPORT [--pictures DIR]");

const browser = await launch(executablePath);
for (const screen of screens) {
  await look(screen);
  console.log(`the report at ${screen.viewport.width} px, ${screen.colorScheme}: ok`);
}
await browser.close();
console.log(`${screens.length} passed, 0 failed`);

async function look({ name, viewport, colorScheme }) {
  const { page, spoken, requested, close } = await opened(browser, { viewport, colorScheme, deviceScaleFactor: 1 });
  const { width, height } = viewport;
  const address = `file://${resolve(report)}`;
  await page.goto(address);

  // Nothing is wider than the page, and all is said by the filter.
  const shown = (selector) => page.locator(selector).filter({ visible: true }).count();
  const wide = () => page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok((await wide()) <= width, `the page is ${await wide()} px wide`);
  const [claims, items] = [await shown(".claim"), await shown("article")];
  assert.ok(claims > 0 && items > 0, "there are claims and items");
  assert.equal(await shown("#claims tbody tr"), claims);
  assert.match(await page.textContent("#shown"), new RegExp(`^${claims} of ${claims} `));

  // Verdicts one by one: together they are all claims, and items without a claim that is wanted are gone.
  const box = (kind, value) => page.locator(`#filter [data-${kind}="${value}"]`);
  const words = await page.$$eval("#filter [data-verdict]", (all) => all.map((of) => of.dataset.verdict));
  let sum = 0;
  for (const word of words) {
    for (const other of words) await box("verdict", other).setChecked(other === word);
    const of = await shown(".claim");
    assert.equal(of, await shown(`.claim[data-verdict="${word}"]`));
    assert.equal(of, await shown("#claims tbody tr"));
    assert.ok((await shown("article")) <= Math.max(of, 0), "items have a claim that is wanted");
    assert.equal(await shown("#contents li"), await shown("article"));
    sum += of;
  }
  assert.equal(sum, claims);
  for (const word of words) await box("verdict", word).check();
  assert.equal(await shown("article"), items);

  // Ours, and a paper.
  const ours = await shown('.claim[data-whose="ours"]');
  await box("whose", "ours").uncheck();
  assert.equal(await shown(".claim"), claims - ours);
  await box("whose", "ours").check();
  const papers = await page.$$eval("#filter [data-paper]", (all) => all.map((of) => of.dataset.paper));
  if (papers.length > 1) {
    await box("paper", papers[0]).uncheck();
    assert.equal(await shown(`article[data-paper="${papers[0]}"]`), 0);
    assert.ok((await shown(`article[data-paper="${papers[1]}"]`)) > 0);
    // A link to what is not shown shows it.
    await page.evaluate((to) => { location.hash = to; }, papers[0]);
    await page.waitForFunction(() => document.querySelectorAll(".out").length === 0);
  }

  // A run opens with its case; a head sorts.
  const link = page.locator("article td a").first();
  if (await link.count()) {
    await link.click();
    // Unfolded once the page has heard of its new place.
    await page.waitForFunction(() => document.getElementById(decodeURIComponent(location.hash.slice(1)))?.open, null, { timeout: 20000 });
  }
  const head = page.locator("#claims th button").first();
  await head.click();
  assert.equal(await page.locator("#claims th").first().getAttribute("aria-sort"), "ascending");

  // On paper tables are as wide as it.
  await page.emulateMedia({ media: "print" });
  await page.setViewportSize({ width: 700, height: 1000 });
  const cut = await page.$$eval(".wide:not(.broad)", (all) => all.filter((of) => of.scrollWidth > of.clientWidth + 1).map((of) => of.textContent.slice(0, 60)));
  await page.setViewportSize({ width: 1040, height: 700 });
  cut.push(...(await page.$$eval(".broad", (all) => all.filter((of) => of.scrollWidth > of.clientWidth + 1).map((of) => of.textContent.slice(0, 60)))));
  assert.deepEqual(cut, [], "tables that are cut on paper");
  if (pictures) {
    await page.emulateMedia({ media: null });
    await page.setViewportSize({ width, height });
    await page.screenshot({ path: join(pictures, `report-${name}.png`) });
    if (name === "desk") await page.pdf({ path: join(pictures, "report.pdf"), preferCSSPageSize: true });
  }
  assert.deepEqual(spoken, [], "the console says nothing");
  assert.deepEqual(requested.filter((url) => url !== address && !url.startsWith("data:")), [], "the page asks for nothing");
  await close();
}
