// The site of the documents from file://: node site_scenarios.mjs FOLDER. The search gives results, leads to the place, and
// nothing is asked of any server. By day and at night all figures are shown, and axe finds nothing.
import assert from "node:assert/strict";
import path from "node:path";
import {pathToFileURL} from "node:url";

const {chromium} = await import(pathToFileURL(path.join(process.env.PLAYWRIGHT_CORE, "index.mjs")));
const site = pathToFileURL(path.resolve(process.argv[2])).href;
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM, headless: true,
  args: [...(process.getuid?.() === 0 ? ["--no-sandbox"] : []), "--disable-gpu", "--disable-dev-shm-usage"],
});
const problems = [];

async function opened(name, options = {}) {
  const context = await browser.newContext({viewport: {width: 1280, height: 800}, ...options});
  const page = await context.newPage();
  page.setDefaultTimeout(20000);
  page.on("pageerror", (error) => problems.push(error.stack));
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || problems.push(`asked for ${request.url()}`));
  await page.goto(`${site}/${name}`);
  return page;
}

async function search(name, words, wanted) {
  const page = await opened(name);
  await page.click(".md-search__input");
  await page.keyboard.type(words);
  const result = page.locator(".md-search-result__link", {hasText: wanted}).first();
  await result.waitFor();
  await page.screenshot({path: path.join(process.env.ARTEFACTS, "site-search.png")});
  await result.click();
  await page.waitForURL(/\.html/);
  assert.ok((await page.locator("article").innerText()).toLowerCase().includes(words), `${page.url()} says nothing of ${words}`);
}

async function ground(name, colorScheme) {
  const page = await opened(name, {colorScheme});
  const broken = await page.locator("article img").evaluateAll(
    (images) => Promise.all(images.map((image) => image.decode().then(() => "", () => image.src))));
  assert.deepEqual(broken.filter(Boolean), [], "figures that are not shown");
  await page.screenshot({path: path.join(process.env.ARTEFACTS, `site-${colorScheme}.png`)});
  await page.addScriptTag({path: path.join(process.env.AXE_CORE, "axe.min.js")});
  const found = await page.evaluate(async () => (await axe.run({preload: false})).violations.map(({id, nodes}) => `${id}: ${nodes[0].html}`));
  assert.deepEqual(found, [], `axe, ${name}, ${colorScheme}`);
  const [red] = (await page.evaluate(() => getComputedStyle(document.body).backgroundColor)).match(/\d+/g).map(Number);
  return red;
}

try {
  await search("index.html", "watchdog", "Installation and service");
  await search("decisions/index.html", "passivity", "Haptic devices");
  for (const name of ["architecture.html", "haptics.html"]) {
    assert.ok(await ground(name, "light") > 200);
    assert.ok(await ground(name, "dark") < 100);
  }
  assert.deepEqual(problems, []);
} catch (error) {
  console.log(error.stack ?? error, problems);
  process.exitCode = 1;
} finally {
  await browser.close();
}
