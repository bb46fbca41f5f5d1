// Journeys to answers that are old, too long or of no case: what stands there must be said, and nothing of the user is lost.
import assert from "node:assert/strict";
import { deflateRawSync } from "node:zlib";
import { answered } from "./open.mjs";

const link = (text) => `#c=${deflateRawSync(text).toString("base64url")}`;
const plain = (page) => page.textContent("#text .plain");
const stale = (page) => page.evaluate(() => document.querySelector("#result").classList.contains("stale"));
/** Waits until nothing is computed. */
const idle = (page) => page.waitForFunction(() => document.querySelector("#stop").hidden && document.querySelector("#state").textContent !== "opening …");

/** Sets a box of the form, as if it were typed and left. */
const put = (page, key, value) =>
  page.$eval(`[id="key-${key}"]`, (box, value) => {
    box.value = value;
    box.dispatchEvent(new Event("change"));
  }, value);

async function copied(page, what) {
  await page.evaluate(() => document.querySelector("#said").classList.remove("on"));
  await page.click("#copy summary");
  await page.click(`[data-copy=${what}]`);
  await page.waitForSelector("#said.on");
  return page.evaluate(() => navigator.clipboard.readText());
}

export const standing = ({ lab, slide, edit, fragment }) => ({
  async "an old answer stays faded until its own comes"(page) {
    for (const wait of [0, 40]) {
      await page.goto("about:blank");
      await page.goto(`${lab}#case=p1_spin_up_4`);
      await answered(page);
      // The first is answered, the second is over the limit.
      await put(page, "hub.motion.speed", "8 rad/s");
      await page.waitForTimeout(wait);
      await put(page, "run.duration", "4000 s");
      await page.waitForSelector("#compute:not([hidden])");
      await page.waitForTimeout(300);
      assert.ok(await stale(page), `after ${wait} ms the answer of 20 s does not stand for 4000 s`);
    }
    await page.click("#pin");
    await page.click("#pin");
    assert.ok(await stale(page), "to pin an answer makes it no younger");
    await page.waitForFunction(() => location.hash.includes("run.duration=4000"));
    // What is pinned is the answer, not the text beside it.
    await page.click("#pin");
    await put(page, "run.duration", "10 s");
    await page.waitForFunction(() => /with .*run\.duration=20 s/.test(document.querySelector("#notes .pinned")?.textContent ?? ""));
  },
  async "a tab keeps the change before it"(page) {
    for (const [kind, wait] of [["modes", 0], ["campbell", 5], ["statics", 20]]) {
      await page.goto("about:blank");
      await page.goto(`${lab}#case=p1_spin_up_4`);
      await answered(page);
      await page.evaluate(async ([kind, wait]) => {
        const box = document.getElementById("key-hub.motion.speed");
        box.value = "9 rad/s";
        box.dispatchEvent(new Event("change"));
        await new Promise((resolve) => setTimeout(resolve, wait));
        document.querySelector(`[data-kind=${kind}]`).click();
      }, [kind, wait]);
      await page.waitForFunction(() => /speed = "9 rad\/s"/.test(document.querySelector("#text .plain").textContent));
      await page.waitForFunction((kind) => location.hash.includes("speed=9") && location.hash.includes(`do=${kind}`), kind);
      if (kind === "statics") {
        await page.waitForFunction(() => /no load/.test(document.querySelector("#state").textContent));
        assert.ok(await stale(page), "there are no equilibria, and the run is none");
      } else {
        await answered(page);
        assert.equal(await page.inputValue("#rotation"), "9 rad/s");
      }
    }
  },
  async "a Campbell diagram is that of the text"(page) {
    await page.goto(`${lab}#case=p1_spin_up_4&do=campbell&speed=60 rev/min&most=20 rad/s`);
    await answered(page);
    // 60 revolutions a minute are 2π rad/s, in every unit that the engine takes.
    assert.equal(await page.textContent("#curves h2"), "Modes at 6.28 rad/s");
    assert.ok(Math.abs((await page.getAttribute(".campbell .u-over", "aria-valuenow")) - 2 * Math.PI) < 1e-3);
    assert.match(await copied(page, "python"), /case\.campbell\(\[f"\{20 \* k \/ 30\} rad\/s" for k in range\(31\)\]\)/);
    // As wide as its place, which it becomes in the frame behind its answer.
    const sized = () => page.waitForFunction(() => Math.abs(document.querySelector(".campbell canvas").clientWidth - document.querySelector(".campbell").clientWidth) < 2);
    const picture = () => sized().then(() => page.$eval(".campbell canvas", (canvas) => canvas.toDataURL()));
    await edit(page, "70 GPa", "7 GPa");
    await page.waitForTimeout(300);
    await answered(page);
    const soft = await picture();
    for (const wait of [300, 400, 550]) {
      await edit(page, "7 GPa", "700 GPa");
      await page.waitForTimeout(wait);
      await edit(page, "700 GPa", "7 GPa");
      await page.waitForTimeout(300);
      await answered(page);
      assert.equal(await picture(), soft, `${wait} ms after a stiffer one`);
    }
    await page.click("[data-kind=modes]");
    await answered(page);
    assert.match(await copied(page, "python"), /case\.modes\("60 rev\/min"\)/);
    // Unpinned, its modes stay.
    await page.click("[data-kind=run]");
    await answered(page);
    await page.click("#pin");
    await page.click("[data-kind=campbell]");
    await answered(page);
    await page.click("#pin");
    assert.equal(await page.textContent("#curves h2"), "Modes at 6.28 rad/s");
    assert.ok((await page.locator("#curves table tbody tr").count()) > 0, "the modes are listed");
  },
  async "what takes long is offered by a click"(page) {
    // Errors by counted work.
    await page.goto(`${lab}#case=space_p1_spin_up`);
    await answered(page);
    await page.waitForSelector("#compute:not([hidden])");
    assert.match(await page.textContent("#notes"), /Errors are not known: it takes more work/);
    assert.doesNotMatch(await page.textContent("#notes"), /by the user/);
    // By the clock: its patience is short here.
    await page.evaluate(() => {
      const later = window.setTimeout;
      window.setTimeout = (act, time, ...rest) => later(act, time === 15_000 ? 20 : time, ...rest);
    });
    await put(page, "run.duration", "19 s");
    await page.waitForFunction(() => /takes more than 15 s/.test(document.querySelector("#state").textContent));
    assert.ok(await page.locator("#compute").isVisible(), "a click lifts the limit");
    await page.click("#compute");
    await page.waitForSelector("#stop:not([hidden])");
    await page.waitForTimeout(500);
    await page.click("#stop");
    assert.match(await page.textContent("#state"), /^Stopped/);
  },
  async "a link with a mistake leaves nothing of the case before"(page) {
    await page.goto(`${lab}#case=p1_spin_up_4`);
    await answered(page);
    const text = (await plain(page)).replace(/title = .*/, 'title = """a title"""');
    await page.evaluate((hash) => void (location.hash = hash), link(text));
    await page.waitForFunction(() => document.querySelector("#title").textContent === "a title");
    await answered(page);
    const broken = link(text.replace('"10 m"', "nan"));
    await page.evaluate((hash) => void (location.hash = hash), broken);
    await page.waitForSelector("#problems li");
    assert.equal(await page.locator("#form input[type=range], #form input[type=text]").count(), 0, "no slider of the case before");
    assert.equal(await page.locator(".values tr").count(), 0, "no values of the case before");
    await page.waitForTimeout(500);
    assert.match(await fragment(page), /^#c=/);
    // A link that leads nowhere has nothing to be taken along, and stays.
    await page.evaluate(() => void (location.hash = "#case=nothing"));
    await page.waitForFunction(() => document.querySelector("#title").textContent === "This link cannot be opened");
    assert.equal(await page.locator("[data-copy]:enabled, [data-save]:enabled, [data-kind]:enabled, #pin:enabled").count(), 0);
    await page.waitForTimeout(500);
    assert.equal(await fragment(page), "#case=nothing");
    await page.evaluate(() => void (location.hash = "#case=p1_spin_up_4"));
    await page.waitForFunction(() => /spin-up/.test(document.querySelector("#title").textContent));
    await answered(page);
    assert.equal(await page.locator("[data-copy]:disabled, [data-save]:disabled, [data-kind]:disabled, #pin:disabled").count(), 0);
  },
  async "the opening of a link is stopped, and goes on"(page) {
    await page.goto(`${lab}#case=p1_spin_up_4`);
    await answered(page);
    // Its file comes late.
    await page.route("**/files/**", async (route) => {
      await new Promise((resolve) => setTimeout(resolve, 800));
      await route.continue();
    });
    await page.evaluate(() => void (location.hash = "#case=free_hub_recorded_torque"));
    await page.waitForFunction(() => document.querySelector("#state").textContent === "opening …");
    await page.click("#stop");
    await page.waitForTimeout(1200);
    assert.match(await page.textContent("#title"), /spin-up/);
    assert.match(await page.textContent("#state"), /^Stopped/);
    await page.click("#compute");
    await page.waitForFunction(() => !/spin-up to 4/.test(document.querySelector("#title").textContent));
    await answered(page);
    assert.match(await copied(page, "python"), /^# The case reads torque\.csv/m);
  },
  async "a case that takes long to be read says so, and is stopped"(page) {
    await page.goto(`${lab}#case=p1_spin_up_4`);
    await answered(page);
    const large = (await plain(page)).replace(/elements = \d+/, "elements = 200000");
    await page.evaluate((hash) => void (location.hash = hash), link(large));
    await page.waitForSelector("#compute:not([hidden])");
    await page.click("#compute");
    await page.waitForFunction(() => document.querySelector("#state").textContent === "reading the case …");
    await page.click("#stop");
    await page.waitForSelector("#compute:not([hidden])");
    await page.waitForTimeout(500);
    assert.match(await page.textContent("#state"), /^Stopped/);
  },
  async "nothing long is computed before a click"(page) {
    const text = (elements) => `[beam]\nlength = "1 m"\n[section]\nkind = "uniform"\nmodulus = "70 GPa"\ndensity = 2700\narea = "1 cm^2"\nsecond-moment = "1e-10 m^4"\n[basis]\nkind = "finite-elements"\nelements = ${elements}\n[run]\nduration = "1 s"\n`;
    // Modes by their work.
    await page.goto(`${lab}${link(text(12_000))}&do=modes&speed=1 rad/s`);
    await page.waitForSelector("#compute:not([hidden])");
    assert.match(await page.textContent("#state"), /takes more than two seconds/);
    assert.ok(await stale(page), "no modes are shown");
    // Reading by the clock, for nothing is counted before it: the machine is as slow as it has to be.
    await page.evaluate(() => {
      const later = window.setTimeout;
      window.setTimeout = (act, time, ...rest) => later(act, time === 3000 ? 20 : time, ...rest);
    });
    const offered = () => page.waitForFunction(() => document.querySelector("#state").textContent === "This takes more than 3 s." && !document.querySelector("#compute").hidden);
    await page.evaluate((hash) => void (location.hash = hash), link(text(30_000)));
    await offered();
    await page.click("#compute");
    await page.waitForFunction(() => document.querySelector("#form input[type=range]") !== null, undefined, { timeout: 60_000 });
    if (await page.locator("#stop").isVisible()) await page.click("#stop");
    // A link whose changes take long leads to them by a click.
    await page.evaluate(() => void (location.hash = "#case=p1_spin_up_4&set=basis.elements=20000"));
    await offered();
    assert.match(await fragment(page), /^#case=p1_spin_up_4&set=basis\.elements=20000/);
    await page.click("#compute");
    await page.waitForFunction(() => /elements = 20000/.test(document.querySelector("#text .plain").textContent), undefined, { timeout: 60_000 });
    await page.waitForFunction(() => document.querySelector("#stop").hidden || /computing|reading/.test(document.querySelector("#state").textContent));
    if (await page.locator("#stop").isVisible()) await page.click("#stop");
  },
  async "files that take long are told, and stopped"(page) {
    await page.goto(`${lab}#case=p1_spin_up_4`);
    await answered(page);
    await put(page, "run.duration", "4000 s");
    await page.waitForSelector("#compute:not([hidden])");
    const before = await page.textContent("#state");
    const save = async () => {
      await page.click("#save summary");
      await page.click("[data-save=files]");
      await page.waitForFunction(() => document.querySelector("#state").textContent === "making the files …" && !document.querySelector("#stop").hidden);
    };
    await save();
    await page.waitForFunction(() => document.querySelector("#progress").value > 0);
    await page.click("#stop");
    await page.waitForFunction(() => /stopped/i.test(document.querySelector("#said").textContent));
    assert.match(await page.textContent("#state"), /^Stopped/);
    // What was offered before is offered behind them.
    await put(page, "run.duration", "3999 s");
    await page.waitForFunction((before) => document.querySelector("#state").textContent === before, before);
    await page.evaluate(() => {
      const post = window.Worker.prototype.postMessage;
      window.Worker.prototype.postMessage = function (data) {
        post.call(this, data.request ? { request: data.request.replace('3999 s', '1 s') } : data);
      };
    });
    const saved = page.waitForEvent("download");
    await save();
    await saved;
    assert.equal(await page.textContent("#state"), before);
    assert.ok(await page.locator("#compute").isVisible());
  },
  async "a path without errors says why"(page) {
    await page.goto(`${lab}#case=distributed_load&do=statics`);
    await answered(page);
    assert.match(await page.textContent("#curves table"), /±/);
    assert.doesNotMatch(await page.textContent("#notes"), /Errors are not known/);
    await page.goto(`${lab}#case=distributed_load&do=statics&set=basis.elements=400`);
    await answered(page);
    assert.doesNotMatch(await page.textContent("#curves table"), /±/);
    assert.match(await page.textContent("#notes"), /Errors are not known: the path took/);
  },
  async "what was chosen in a picture stays while another is looked at"(page) {
    await page.goto(`${lab}#case=space_elbow`);
    await answered(page);
    const joints = page.locator("#options button", { hasText: "Joint forces" });
    await joints.click();
    await page.click("[data-kind=modes]");
    await answered(page);
    await page.click("[data-kind=run]");
    await answered(page);
    assert.equal(await joints.getAttribute("aria-pressed"), "false");
    await page.goto(`${lab}#case=p1_spin_up_4&do=campbell&most=1e308 rad/s`);
    await page.waitForFunction(() => /speeds ascend/.test(document.querySelector("#state").textContent));
    assert.doesNotMatch(await page.textContent("#state"), /\d{25}/);
  },

  async "labels of axes are whole"(page) {
    await page.addInitScript(() => {
      window.cut = [];
      const draw = CanvasRenderingContext2D.prototype.fillText;
      CanvasRenderingContext2D.prototype.fillText = function (words, x, ...more) {
        if (this.textAlign === "right" && x < this.measureText(words).width) window.cut.push(words);
        return draw.call(this, words, x, ...more);
      };
    });
    await page.goto(`${lab}#case=initial_static`);
    await answered(page);
    assert.deepEqual(await page.evaluate(() => window.cut), []);
    // They tell the values apart.
    await page.goto(`${lab}#case=initial_static&do=statics`);
    await answered(page);
    const figures = await page.$$eval("svg.path", (all) => all.map((svg) => [...svg.querySelectorAll("text[text-anchor=middle]:not(.name)")].map((text) => text.textContent)));
    assert.ok(figures.length >= 3 && figures.every((labels) => new Set(labels).size === labels.length), JSON.stringify(figures));
  },

  async "the first picture is that of its time"(page) {
    await page.emulateMedia({ reducedMotion: "reduce" });
    for (const name of ["contact_hill", "roll_up"]) {
      await page.goto("about:blank");
      await page.goto(`${lab}#case=${name}`);
      await answered(page);
      // Two frames behind its curves.
      await page.waitForFunction(() => document.querySelector("#scale").textContent !== "");
      await page.waitForTimeout(300);
      const seen = () => page.$eval("#stage canvas", (canvas) => canvas.toDataURL());
      const first = await seen();
      await page.$eval("#scrubber", (scrubber) => scrubber.dispatchEvent(new Event("input")));
      assert.equal(await seen(), first, name);
    }
    await page.emulateMedia({ reducedMotion: null });
  },

  async "what is no picture or no film is not saved"(page) {
    await page.goto(`${lab}#case=initial_static&do=statics`);
    await answered(page);
    const said = async (what) => {
      await page.click("#save summary");
      await page.click(`[data-save=${what}]`);
      await page.waitForSelector("#said.on");
      return page.textContent("#said");
    };
    assert.match(await said("picture"), /no picture/);
    await page.goto(`${lab}#case=contact_hill`);
    await answered(page);
    await said("film");
    await page.waitForTimeout(500);
    await page.evaluate(() => (location.hash = "#case=p1_spin_up_4"));
    await page.waitForFunction(() => document.querySelector("#said").textContent.includes("ended early"));
  },
});
