// The wall in headless Chromium: node wall_scenarios.mjs ADDRESS SCENARIO [ARGUMENT...]. A scenario asks for what happens outside
// the page by printing `> LINE`, for the plant; an answer is one line.
import assert from "node:assert/strict";
import {readFile} from "node:fs/promises";
import path from "node:path";
import {createInterface} from "node:readline";
import {pathToFileURL} from "node:url";

const {chromium} = await import(pathToFileURL(path.join(process.env.PLAYWRIGHT_CORE, "index.mjs")));
const [address, scenario, ...rest] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM, headless: true,
  args: [...(process.getuid?.() === 0 ? ["--no-sandbox"] : []), "--disable-gpu", "--disable-dev-shm-usage"],
});
const problems = [];
const lines = createInterface({input: process.stdin})[Symbol.asyncIterator]();

async function outside(line) {
  console.log(`> ${line}`);
  return (await lines.next()).value;
}

async function opened(options = {}) {
  const context = await browser.newContext({viewport: {width: 1440, height: 900}, ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(60000);
  page.on("pageerror", (error) => problems.push(error.stack));
  page.on("console", (message) => message.type() === "error" && !/WebSocket|ERR_CONNECTION|Failed to load resource/.test(message.text()) && problems.push(message.text()));
  page.on("request", (request) => request.url().startsWith(address) || request.url().startsWith(address.replace("http", "ws")) || problems.push(`asked for ${request.url()}`));
  await page.goto(address);
  return page;
}

const tile = (page, name) => page.locator(".tile").filter({has: page.locator("h3", {hasText: new RegExp(`^${name}$`)})});
const says = (page, name, text) => tile(page, name).filter({hasText: text}).first().waitFor();
const shot = (page, name) => page.screenshot({path: path.join(process.env.ARTEFACTS, `${name}.png`)});

async function axe(page, state) {
  await page.evaluate(await readFile(path.join(process.env.AXE_CORE, "axe.min.js"), "utf8"));
  const found = await page.evaluate(async () => (await window.axe.run(document, {resultTypes: ["violations"]})).violations.map(
    ({id, nodes}) => `${id}: ${nodes[0].html} ${nodes[0].failureSummary}`));
  assert.deepEqual(found, [], `axe, ${state}`);
}

const quantile = (values, part) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(part * values.length))];

const scenarios = {
  async cells() {
    const page = await opened();
    await page.waitForFunction(() => document.querySelectorAll(".tile").length === 8);
    await page.waitForFunction(() => document.querySelectorAll('.tile[data-level="ok"]').length === 7);
    await says(page, "Paint shop", "never seen");
    await says(page, "cell_002", "robot_3: fresh");
    await says(page, "cell_002", "1000 Hz, on time");
    await says(page, "cell_002", "robot_1/forearm and robot_2/gripper");
    await outside("fault 5 the loop is late");
    await outside("touch 4 ");
    await outside("close 3 ");
    await says(page, "cell_005", "the loop is late");
    await says(page, "cell_004", "1: robot_1/gripper and table");
    await says(page, "cell_003", /silent since \d\d:\d\d:\d\d \(/);
    await says(page, "cell_003", "robot_3: was fresh");
    const order = await page.locator(".tile h3").allInnerTexts();
    assert.deepEqual(order.slice(0, 4), ["cell_003", "cell_005", "Paint shop", "cell_004"], "the worst first");
    assert.match(await page.locator("#count-fault").innerText(), /^3 fault/);
    assert.equal(await tile(page, "cell_001").locator("a").getAttribute("href"), "http://127.0.0.1:9001/");
    assert.match(await tile(page, "cell_002").locator(".tile-foot").innerText(), /^ssh -L 8420:127\.0\.0\.1:8420 host-002, then its page$/);
    const picture = () => tile(page, "cell_001").locator("img").evaluate((image) => image.naturalWidth);
    for (let i = 0; i < 240 && !await picture(); ++i) {  // a picture that comes before the reader is found is lost
      await outside(`jpeg 1 ${rest[0]}`);
      await page.waitForTimeout(250);
    }
    assert.ok(await picture() > 100, "there is no picture");
    await axe(page, "by day");
    await page.setViewportSize({width: 1440, height: 800});
    await shot(page, "wall-light");
    await page.fill("#search", "paint");
    await page.waitForFunction(() => document.querySelectorAll(".tile").length === 1);
    await page.fill("#search", "");
    const dark = await opened({colorScheme: "dark", viewport: {width: 390, height: 844}});
    await says(dark, "cell_005", "the loop is late");
    await axe(dark, "by night, on a phone");
    assert.ok(await dark.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), "it is wider than the phone");
    await shot(dark, "wall-phone-dark");
  },

  async lies() {
    const page = await opened();
    await page.waitForFunction(() => document.querySelectorAll('.tile[data-level="ok"]').length === 7);
    await outside("call 1 cell_002");
    await outside("version 3 2");
    await outside("clock 4 3600");
    await outside("call 5 <img src=x onerror=alert(1)>");
    await says(page, "cell_002", "called itself cell_001 before");
    await page.waitForFunction(() => document.querySelectorAll(".tile").length >= 9);
    await says(page, "cell_002", "two gateways say that they are this cell");
    await says(page, "cell_003", "summaries have version 2");
    await says(page, "cell_004", /its clock is 3(600|599) s ahead of that of the wall/);
    await says(page, "<img src=x onerror=alert\\(1\\)>", "not in the list");
    assert.equal(await page.locator(".tile h3 img").count(), 0, "a name became markup");
    await axe(page, "lies");
  },

  async gone() {
    const page = await opened();
    await page.waitForFunction(() => document.querySelectorAll(".tile").length === 8);
    await outside("wall away");
    await page.locator("#gone").waitFor();
    assert.equal(await page.locator(".tile").count(), 8, "what was last known stays");
    await outside("wall back");
    await page.locator("#gone").waitFor({state: "hidden"});
    await page.waitForFunction(() => document.querySelectorAll('.tile[data-level="ok"]').length === 7);
  },

  // For SECONDS: what age is seen, and how long a summary takes from its gateway to the page. One line of JSON.
  async age() {
    const [seconds, cells] = rest.map(Number);
    const page = await opened();
    await page.waitForFunction((n) => document.querySelectorAll(".tile").length >= n, cells);
    await page.waitForTimeout(3000);
    const seen = await page.evaluate(async (duration_s) => {
      const {model} = await import("/page/modules/wall_main.js");
      const [ages, delays, sequences, first] = [[], [], new Map(), Date.now()];
      performance.clearMeasures();
      await new Promise((resolve) => {
        const timer = setInterval(() => {
          const now = Date.now();
          for (const {number, pulse} of model.tiles.values()) {
            if (pulse.time_ms === undefined) continue;
            ages.push(now - pulse.time_ms);
            if (sequences.has(number) && sequences.get(number) !== pulse.sequence) delays.push(now - pulse.time_ms);
            sequences.set(number, pulse.sequence);
          }
          if (now - first < 1000 * duration_s) return;
          clearInterval(timer);
          resolve();
        }, 20);
      });
      return {ages, delays, updates: performance.getEntriesByName("cellmirror.wall").map(({duration}) => duration)};
    }, seconds);
    const told = (values) => ({p50: quantile(values, 0.5), p95: quantile(values, 0.95), count: values.length});
    console.log(JSON.stringify({age_ms: told(seen.ages), delay_ms: told(seen.delays), update_ms: told(seen.updates)}));
    if (process.env.WALL_PICTURE) await page.screenshot({path: process.env.WALL_PICTURE});
  },
};

let status = 0;
try {
  await scenarios[scenario]();
  assert.deepEqual(problems, []);
} catch (error) {
  console.log(error.stack ?? error);
  const page = browser.contexts().at(-1)?.pages().at(-1);
  await page?.screenshot({path: path.join(process.env.ARTEFACTS, `failed-wall-${scenario}.png`)}).catch(() => {});
  status = 1;
} finally {
  await browser.close();
}
process.exit(status);
