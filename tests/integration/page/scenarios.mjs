// What a person does with the page, in headless Chromium: node scenarios.mjs 2d|3d|without-webgl. Each line of standard input asks
// for scenarios, {"scenarios": "NAME[,NAME...]", "address": "...", "arguments": [...]}; the last line of the answer is "= passed" or
// "= failed". All have one browser, whose start costs a second, but contexts of their own, which end with them.
import assert from "node:assert/strict";
import path from "node:path";
import {createInterface} from "node:readline";
import {pathToFileURL} from "node:url";

import {scene_scenarios} from "./scene_scenarios.mjs";

const {chromium} = await import(pathToFileURL(path.join(process.env.PLAYWRIGHT_CORE, "index.mjs")));
const [drawing] = process.argv.slice(2);
let [scenario, address, rest] = ["", "", []];  // what is asked for
const kPatience_ms = 60000;
// A quarter of the pixels where what they show is drawn by the processor; the page is laid out as ever.
const kCoarse = {deviceScaleFactor: 0.5};

// Scenarios in 3D need WebGL, which a software renderer draws here; one has none, the others do as they like.
const kDrawing = {
  "without-webgl": ["--disable-gpu", "--disable-3d-apis"],
  "3d": ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  "2d": ["--disable-gpu"],
}[drawing];

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM, headless: true,
  args: [...(process.getuid?.() === 0 ? ["--no-sandbox"] : []), ...kDrawing, "--disable-dev-shm-usage"],
});
const problems = [];

// `wire`: what comes from the gateway goes through wire.live(message); null is dropped. wire.end() ends the connection, and every further one until wire.ended is false.
async function opened(options = {}, to = address, wire = null) {
  const context = await browser.newContext({viewport: {width: 1440, height: 900}, ...options});
  const page = await context.newPage();
  if (wire) await page.routeWebSocket(/\/live$/, (socket) => tap(socket, wire));
  page.setDefaultTimeout(kPatience_ms);
  page.on("pageerror", (error) => problems.push(`${error.message}\n${error.stack}`));
  page.on("console", (message) => {
    // A socket that cannot connect is what the page is made for.
    if (message.type() === "error" && !/WebSocket|ERR_CONNECTION|Failed to load resource/.test(message.text())) problems.push(message.text());
  });
  await page.addInitScript(() => {
    window.measured = [];
    new PerformanceObserver((list) => window.measured.push(...list.getEntries()
      .filter(({name}) => name.startsWith("cellmirror."))
      .map(({name, startTime, duration}) => ({name, startTime, duration})))).observe({entryTypes: ["measure", "mark"]});
  });
  await page.goto(to);
  return page;
}

function tap(socket, wire) {
  if (wire.ended) {
    socket.close();
    return;
  }
  const gateway = socket.connectToServer();
  wire.end = () => {
    wire.ended = true;
    return Promise.all([socket.close(), gateway.close()]);
  };
  gateway.onMessage((message) => {
    if (typeof message === "string" && message.startsWith('{"is": "live"')) {
      const changed = wire.live(JSON.parse(message));
      message = changed && JSON.stringify(changed);
    }
    if (message) socket.send(message);
  });
}

const shot = (page, name, whole = false) => page.screenshot({path: path.join(process.env.ARTEFACTS, `${name}.png`), fullPage: whole});
const text_of = (page, selector) => page.locator(selector).innerText();
const live = (page) => page.waitForFunction(() => document.getElementById("line-text").textContent === "live");
const picture = (page) => page.waitForFunction(() => document.getElementById("view-canvas").dataset.sequence);
// A small print of the picture: means of 32 x 24 parts.
const print_of = (page) => page.evaluate(() => {
  const small = new OffscreenCanvas(32, 24).getContext("2d");
  small.drawImage(document.getElementById("view-canvas"), 0, 0, 32, 24);
  return Array.from(small.getImageData(0, 0, 32, 24).data);
});
const difference = (a, b) => a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / a.length;

// Until pictures differ so much from an earlier print: the machine may be busy.
async function differs(page, before, least, why) {
  let found = 0;
  for (let i = 0; i < 240; ++i) {
    found = difference(before, await print_of(page));
    if (found > least) return;
    await page.waitForTimeout(250);
  }
  assert.fail(`${why}: ${found}`);
}

const value_is = (page, id, value) => page.waitForFunction(([name, wanted]) => document.getElementById(name).value === wanted, [id, value]);

async function newer_picture(page, count = 3) {
  const before = Number(await page.getAttribute("#view-canvas", "data-sequence"));
  await page.waitForFunction((least) => Number(document.getElementById("view-canvas").dataset.sequence) >= least, before + count);
}

async function run(page, command) {
  await page.fill("#console-input", command);
  await page.press("#console-input", "Escape");
  await page.press("#console-input", "Enter");
  const answer = page.locator("#console-log li").last().locator(".answer:not(.waiting)");
  await answer.waitFor();
  return answer.innerText();
}

const lines = createInterface({input: process.stdin})[Symbol.asyncIterator]();
async function outside(word) {
  console.log(`> ${word}`);
  return (await lines.next()).value;
}

const quantile = (values, part) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(part * values.length))];

const scenarios = {
  // The gateway's demo: arguments are a robot that moves, and a command that is refused.
  async gateway() {
    const [robot, refused] = rest;
    const page = await opened(kCoarse);
    await live(page);
    await picture(page);
    assert.equal(new URL(page.url()).hash, "", "the token stays in the address bar");
    const value = page.locator(`[data-robot="${robot}"] .joint .value`).first();
    const before = await value.innerText();
    const picture_before = await print_of(page);
    await page.waitForFunction(([id, text]) => document.querySelector(`[data-robot="${id}"] .joint .value`).textContent !== text, [robot, before]);
    await differs(page, picture_before, 0, "the picture does not move");
    await shot(page, "gateway-desk-light");

    const still = await print_of(page);
    await drag(page, 220, -60);
    await value_is(page, "view-choice", "free");
    await differs(page, still, 1, "an orbit does not change the picture");
    await shot(page, "gateway-orbit");
    await page.click("#view-home");

    assert.match(await run(page, "hot_message The page is here"), /^done/);
    await page.locator("#hot-message").waitFor();
    const why = await run(page, refused);
    assert.match(why, /^refused: .{10,}/);
    console.log(`refusal: ${why}`);
    await page.click("#tab-messages");
    await page.locator("#command-list li", {hasText: "hot_message The page is here"}).waitFor();
    await page.locator("#command-list li.warning", {hasText: refused}).waitFor();
    assert.ok(await page.locator("#problems").isHidden());
    await pick_something(page);
    await page.click("#tab-tree");
    await page.locator("#tree-list li").first().waitFor();
    await shot(page, "gateway-console");
    await page.click("#stop-all");
    await page.locator("#console-log li", {hasText: "STOP_ALL"}).locator(".answer", {hasText: /SCRIPT files? stopped/}).waitFor();

    await outside("gone");
    await page.locator("#gone").waitFor();
    assert.match(await text_of(page, "#gone"), /cellmirror status/);
    await page.locator("#view-note", {hasText: "old"}).waitFor();
    await shot(page, "gateway-gone");
    await outside("back");
    await page.locator("#gone").waitFor({state: "hidden"});
    await live(page);
    await newer_picture(page, 2).catch(() => picture(page));
    await page.locator("#message-list li", {hasText: "The gateway is new"}).waitFor({state: "attached"});
    await shot(page, "gateway-back");
    await page.context().close();
    // The other screens are those of screens(): what the gateway says has to fit into the narrowest.
    await screen("gateway-phone-light", kScreens.find(([name]) => name === "phone-light")[1]);
  },

  // As large as the page has to bear: the argument is the limit in ms.
  async performance() {
    const page = await opened();
    await live(page);
    await picture(page);
    await page.waitForTimeout(3000);
    const meter = await page.context().newCDPSession(page);
    // Time of the processor, not of the clock: the machine may be busy with something else.
    await meter.send("Performance.enable", {timeDomain: "threadTicks"});
    const script_s = async () => (await meter.send("Performance.getMetrics")).metrics.find(({name}) => name === "ScriptDuration").value;
    await page.evaluate(() => { window.early = window.measured; window.measured = []; });
    const before_s = await script_s();
    // As many as the mean needs: the busier the machine, the longer they take.
    const count = () => page.evaluate(() => window.measured.filter(({name}) => name === "cellmirror.update").length);
    for (let i = 0; i < 100 && await count() < 50; ++i) await page.waitForTimeout(500);
    const used_s = await script_s() - before_s;
    const measured = await page.evaluate(() => window.measured);
    const first = await page.evaluate(() => window.early.find(({name}) => name === "cellmirror.picture").startTime);
    const of = (name) => measured.filter((entry) => entry.name === name).map(({duration}) => duration);
    const updates = of("cellmirror.update");
    const records = of("cellmirror.record");
    assert.ok(updates.length >= 50, `only ${updates.length} updates in 50 s`);
    const figures = (values) => [0.5, 0.95, 1].map((part) => quantile(values, part).toFixed(2)).join(" / ");
    console.log(`updates ${updates.length}: p50 / p95 / max ${figures(updates)} ms; recording ${figures(records)} ms; first picture after ${first.toFixed(0)} ms`);
    const each = (1000 * used_s) / updates.length;
    console.log(`script in all, pictures too, by the processor's time: ${each.toFixed(2)} ms for each update`);
    assert.ok(each < Number(rest[0]), `an update takes ${each} ms of script`);
    await shot(page, "performance");
  },

  // From the address to the first picture, each time in a browser that knows nothing yet: the argument says how often.
  async first_picture() {
    const times_ms = [];
    for (let i = 0; i < Number(rest[0]); ++i) {
      const page = await opened();
      await page.waitForFunction(() => window.measured.some(({name}) => name === "cellmirror.picture"));
      times_ms.push(await page.evaluate(() => window.measured.find(({name}) => name === "cellmirror.picture").startTime));
      await page.context().close();
    }
    console.log(`first picture: ${times_ms.map((time) => time.toFixed(0)).join(" ")} ms`);
  },

  async screens() {
    for (const [name, options] of kScreens) await screen(name, options);
  },

  // The page by keyboard alone, and the console's completion.
  async keyboard() {
    const page = await opened();
    await live(page);
    await picture(page);
    await page.press("body", "/");
    assert.equal(await page.evaluate(() => document.activeElement.id), "console-input");
    await page.keyboard.type("robo");
    await page.keyboard.press("Tab");
    await page.keyboard.type("ROBOT_2 off");
    await page.keyboard.press("Tab");
    assert.equal(await page.inputValue("#console-input"), "ROBOT ROBOT_2 offline ");
    await page.keyboard.press("Enter");
    await page.locator("#console-log .done").waitFor();
    await page.keyboard.press("ArrowUp");
    assert.equal(await page.inputValue("#console-input"), "ROBOT ROBOT_2 offline");
    await page.focus("#view-canvas");
    const before = await print_of(page);
    for (const key of ["ArrowLeft", "ArrowLeft", "ArrowUp", "+", "Shift+ArrowRight"]) await page.keyboard.press(key);
    await differs(page, before, 0.5, "keys do not move the view");
    await page.keyboard.press("Home");
    await value_is(page, "view-choice", "display");
    await page.focus("#tab-near");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.getAttribute("#tab-alarms", "aria-selected"), "true");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.getAttribute("#tab-tree", "aria-selected"), "true");
    await page.locator("#tree-list li").first().focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowDown");
    assert.equal(await page.getAttribute("#tree-list li >> nth=1", "aria-selected"), "true");
    await run(page, "hot_message <b>ding</b>");
    const unread = (n) => page.waitForFunction((text) => document.getElementById("message-count").textContent === text, n);
    await unread("1");
    await page.waitForFunction(() => document.getElementById("hot-message").textContent === "<b>ding</b>");
    await page.waitForFunction(() => Number(document.documentElement.dataset.rung) > 0);
    await page.waitForFunction(() => getComputedStyle(document.getElementById("hot-message")).opacity === "0");
    await page.click("#tab-messages");
    await page.focus("#tab-near");
    await page.keyboard.press("Enter");
    await run(page, "hot_message again");
    await unread("1");
    assert.match(await page.locator("#near-list .end").first().innerText(), /^ROBOT_\d+\.link$/);
    // Pairs change places while they are near: the focus stays with what it was given to, or another try gives it again.
    let whole = null;
    for (let i = 0; i < 20 && await page.getAttribute("#tab-tree", "aria-selected") !== "true"; ++i) {
      whole = await page.evaluate(() => {
        const end = document.querySelectorAll("#near-list .end")[1];
        end.focus();
        return end.title;
      });
      await page.keyboard.press("Enter");
    }
    assert.equal(await page.getAttribute("#tab-tree", "aria-selected"), "true");
    await page.waitForFunction((path) => document.getElementById("tree-chosen").textContent.includes(path), whole);
    assert.equal(await page.evaluate(() => document.activeElement.dataset.path), whole);
    // Who reads further up in the console is not thrown to its end.
    for (let i = 0; i < 20; ++i) await run(page, `ROBACT ROBOT_${1 + i % 2}`);
    await page.evaluate(() => document.getElementById("console-log").scrollTo({top: 0, behavior: "instant"}));
    const answers = await page.locator("#console-log .done").count();
    await page.click('[data-robot="ROBOT_3"] .tools button:nth-child(2)');
    await page.waitForFunction((n) => document.querySelectorAll("#console-log .done").length > n, answers);
    assert.equal(await page.evaluate(() => document.getElementById("console-log").scrollTop), 0);
  },

  // Views and displays are called as the cell's layout file has it.
  async layout() {
    const page = await opened();
    await live(page);
    await page.waitForFunction(() => document.querySelector('#view-choice option[value="view:3"]').textContent === "View 3, angle 3");
    await page.waitForFunction(() => document.querySelector("#display-choice option").textContent === "1, layout 1");
    const titles = await page.locator("#display-choice option").allInnerTexts();
    assert.deepEqual(titles, [1, 2, 3, 4, 5, 6].map((id) => `${id}, layout ${id}`));
    await page.selectOption("#display-choice", "2");
    await page.locator("#console-log .done").waitFor();
    await picture(page);
    await page.focus("#view-canvas");
    await page.keyboard.press("ArrowLeft");
    await value_is(page, "view-choice", "free");
  },

  // What is not of now does not look like it: a pause, news that stop while pictures come, pictures that stop.
  async old() {
    const wire = {live: (message) => ({...message, near_count: 180, within_warning_count: 180})};
    const page = await opened({}, address, wire);
    await live(page);
    await picture(page);
    await page.waitForFunction(() => document.getElementById("near-badge").textContent === "180 near");
    assert.match(await text_of(page, "#near-note"), /the first \d+ of 180/);
    assert.match(await page.locator("#range-list li").nth(1).innerText(), /doubtful, may be nearer/);

    const values = () => page.locator(".chart:not([hidden]) .legend").first().innerText();
    await page.click("#chart-pause");
    let paused = await values();
    for (let before = null; before !== paused; paused = await values()) {  // the charts are drawn one after another
      before = paused;
      await page.waitForTimeout(500);
    }
    await page.waitForFunction((before) => document.querySelector("#robot-list .joint .value").textContent !== before,
      await page.locator("#robot-list .joint .value").first().innerText());
    await page.selectOption("#chart-span", "20");
    assert.equal(await values(), paused);
    await page.click("#chart-pause");

    wire.live = () => null;
    const at = Date.now();
    await page.waitForFunction(() => /^no news/.test(document.getElementById("line-text").textContent));
    await page.waitForFunction(() => getComputedStyle(document.getElementById("touching-badge")).visibility === "hidden");
    await page.waitForFunction(() => /until \d\d:\d\d:\d\d/.test(document.querySelector(".chart:not([hidden]) figcaption").textContent));
    await newer_picture(page);
    await shot(page, "old-news");

    await wire.end();
    await page.locator("#gone").waitFor();
    const told = /as of (\d\d:\d\d:\d\d)/.exec(await text_of(page, "#gone-since"))[1];
    const times = await page.evaluate((then) => [-2, -1, 0, 1].map((s) => new Date(then + 1000 * s).toTimeString().slice(0, 8)), at);
    assert.ok(times.includes(told), `${told} is none of ${times}`);
  },

  // The panel of deformable objects: there with the first, gone with the last, and its buttons send commands.
  async tissue() {
    const tissue = {calculating: true, network_shown: false, rate_hz: 1000, step_p50_us: 210, step_p99_us: 290, late_steps: 0,
      objects: [{name: "liver<b>", nodes: 2200, elements: 10000, contacts: 3, parts: 2, coagulated_share: 0, frozen: false}],
      instruments: [{robot: "GRASPER", kind: "gripper", acting: true, contacts: 3, held: 4, force_n: 1.25}],
      vessels: [{object: "liver<b>", name: "cystic_artery", kind: "artery", clips: 2, severed: true, bleeding_ml_min: 12.5}],
      events: [1, 2].map((number) => ({number, kind: number === 1 ? "grip" : "clip", robot: "GRASPER", object: "liver<b>",
        part: "", limit: "", at_m: [0.1, 0.2, 0.3], value: 1, age_s: 3 - number})),
      effects: {PULSE: true, BLEEDING: false, POOL_RIPPLES: false, SUCTION: false, IRRIGATION: false},
      bleeding_ml_min: 12.5, blood_loss_ml: 3, excesses: 0, connections: 0, connections_torn: 0, pool_level_m: 0, smoke: 0, lens_fog: 0};
    const wire = {live: (message) => ({...message, tissue: null})};
    const page = await opened({}, address, wire);
    await live(page);
    assert.ok(await page.locator("#tab-tissue").isHidden(), "a tab without tissue");
    wire.live = (message) => ({...message, tissue});
    await page.click("#tab-tissue");
    await page.locator("#tissue-events li").first().waitFor();
    assert.match(await text_of(page, "#tissue-step"), /1000 Hz, a step 210 µs, p99 290 µs/);
    assert.match(await text_of(page, "#tissue-objects"), /liver<b>[^]*2\u202f200 nodes, 3 contacts, cut into 2 parts/);
    assert.match(await text_of(page, "#tissue-instruments"), /GRASPER[^]*1\.25 N[^]*gripper, acting, holds 4 points/);
    assert.match(await text_of(page, "#tissue-vessels"), /cystic_artery[^]*2 clips, cut, bleeds 12\.5 ml\/min/);
    assert.match((await page.locator("#tissue-events li").allInnerTexts()).join("|"), /^1\.0 s ago\s*clip by GRASPER[^|]*\|2\.0 s ago\s*grip/);
    await shot(page, "tissue");
    const sends = async (selector, command) => {
      await page.click(selector);
      await page.locator("#console-log li", {hasText: command}).locator(".answer:not(.waiting)").waitFor();
    };
    await sends("#tissue-calc", "eladyn_calc off");
    await sends("#tissue-reset", "eladyn_model_reset");
    await sends("#tissue-network", "eladyn_show_def 1");
    await sends('[data-effect="PULSE"]', "EFFECTS PULSE OFF");
    await sends('[data-effect="BLEEDING"]', "EFFECTS BLEEDING ON");
    await sends("#tissue-reset-pool", "EFFECTS RESET_POOL");
    await sends("#tissue-clean-lens", "EFFECTS CLEAN_ENDOSCOPIC_LENSE");
    wire.live = (message) => ({...message, tissue: {...tissue, calculating: false}});
    await page.waitForFunction(() => document.getElementById("tissue-calc").textContent === "Calculate");
    wire.live = (message) => ({...message, tissue: null});
    await page.waitForFunction(() => document.getElementById("tab-tissue").hidden && !document.getElementById("near-panel").hidden);
  },

  // The panel of voxel volumes: there with the first, gone with the last, and its controls send commands.
  async volume() {
    const plane = (i) => ({plane: `CLP${i + 1}`, side: "off", framed: false, elevation_rad: 0, azimuth_rad: 0, distance_m: 0});
    const other = [1, 1, 2, 0.785];
    const volume = {name: "table.head<b>", shown: true, table: "MEDICAL_LUT", isosurface: false, iso_value: 300,
      parameters: {MEDICAL_LUT: [0, 0.1, 0.3, 1], LIN_LUT: other, EXP_LUT: other, RAINBOW_LUT: other, USER1_LUT: other, USER2_LUT: other},
      planes: Array.from({length: 6}, (_, i) => plane(i))};
    const content = {name: volume.name, voxels: [256, 256, 180], half_extent_m: [0.1, 0.1, 0.09], unit: "HU",
      histogram: {low: -1024, high: 3071, counts: Array.from({length: 128}, (_, i) => (i < 4 ? 1e6 : 1000 * (i % 7)))}};
    const wire = {live: (message) => ({...message, volumes: null})};
    const page = await opened({}, address, wire);
    await page.route("**/api/tree", async (route) => {
      const tree = await (await route.fetch()).json();
      await route.fulfill({json: {...tree, volumes: [content]}});
    });
    await live(page);
    assert.ok(await page.locator("#tab-volume").isHidden(), "a tab without a volume");
    wire.live = (message) => ({...message, tree_revision: 1000, volumes: [volume]});
    await page.click("#tab-volume");
    await page.locator("#volume-planes li").nth(5).waitFor();
    await page.waitForFunction(() => document.getElementById("volume-facts").textContent.includes("256 × 256 × 180 voxels"));
    assert.match(await text_of(page, "#volume-histogram-part"), /1024 HU\s+3071 HU/);
    assert.ok((await page.locator("#volume-histogram").boundingBox()).height > 30, "no histogram");
    assert.ok(await page.locator("#volume-choice-part").isHidden(), "a choice of one volume");
    await shot(page, "volume");
    const sent = (command) => page.locator("#console-log li", {has: page.locator("code", {hasText: new RegExp(`^${command}$`)})})
      .last().locator(".answer:not(.waiting)").waitFor();
    const slid = (label, value) => page.getByLabel(label, {exact: true}).fill(value);
    await page.selectOption("#volume-table", "RAINBOW_LUT");
    await sent("VV_SET_LUT RAINBOW_LUT");
    await page.click("#volume-reload");
    await sent("VV_RELOAD_LUTS");
    await slid("bone of MEDICAL_LUT", "0.5");
    await sent("VV_SET_LUT_PAR MEDICAL_LUT 0 0.1 0.3 0.5");
    await page.selectOption('[data-plane="CLP2"] select', "reverse");
    await sent("VV_CLIP CLP2 reverse");
    // Clicked rather than checked: these volumes stay as they are, so the page soon shows them again.
    await page.click('[data-plane="CLP3"] input[type=checkbox]');
    await sent("VV_CLIP CLP3 visible");
    await slid("elevation of CLP1", "-30");
    await sent("VV_CLIP_POS CLP1 ELE -30 AZI 0 DIST 0");
    await page.click("#volume-surface");
    await sent("VV_ISO on VALUE 300");
    assert.equal(await page.getByLabel("distance of CLP1").getAttribute("max"), "168");
    // What another client sets is seen here.
    const set = {...plane(0), side: "active", azimuth_rad: Math.PI / 4, distance_m: -0.0125};
    wire.live = (message) => ({...message, volumes: [{...volume, table: "EXP_LUT", planes: [set, ...volume.planes.slice(1)]}]});
    await page.waitForFunction(() => document.querySelector('[data-plane="CLP1"] select').value === "active");
    assert.equal(await page.getByLabel("azimuth of CLP1").inputValue(), "45");
    await page.getByLabel("window of EXP_LUT").waitFor();
    // Two volumes: commands are for all, or for the one that is chosen.
    wire.live = (message) => ({...message, volumes: [volume, {...volume, name: "part"}]});
    await page.locator("#volume-choice-part").waitFor();
    await page.selectOption("#volume-choice", "part");
    await page.selectOption("#volume-table", "LIN_LUT");
    await sent("VV_SET_LUT LIN_LUT part");
    wire.live = (message) => ({...message, volumes: null});
    await page.waitForFunction(() => document.getElementById("tab-volume").hidden && !document.getElementById("near-panel").hidden);
  },

  // Fingers on a phone.
  async touch() {
    const page = await opened(kScreens.find(([name]) => name === "phone-light")[1]);
    await live(page);
    await picture(page);
    const before = await print_of(page);
    const box = await page.locator("#view-canvas").boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const fingers = await page.context().newCDPSession(page);
    const touch = (type, ...points) => fingers.send("Input.dispatchTouchEvent", {
      type, touchPoints: points.map(([px, py], id) => ({x: px, y: py, id}))});
    await touch("touchStart", [x - 40, y], [x + 40, y]);
    for (let i = 1; i <= 6; ++i) await touch("touchMove", [x - 40 - 8 * i, y], [x + 40 + 8 * i, y]);
    await touch("touchEnd");
    await value_is(page, "view-choice", "free");
    await differs(page, before, 0.5, "a pinch does not zoom");
    await page.touchscreen.tap(box.x + box.width * 0.75, y);
    await page.locator("#picked-path").waitFor();
    const wide = await page.evaluate(() => document.documentElement.scrollWidth > window.innerWidth + 1);
    assert.ok(!wide, "the page is wider than the phone");
    await run(page, "hot_message small");
    await page.waitForFunction(() => document.getElementById("hot-message").textContent === "small");
    assert.equal(await page.evaluate(() => getComputedStyle(document.getElementById("hot-message")).opacity), "1", "drawn too small to be read");
    await page.setViewportSize({width: 844, height: 390});
    await newer_picture(page);
    for (const button of ["#view-home", "#chart-pause", "#tab-near"]) {
      const {height} = await page.locator(button).boundingBox();
      assert.ok(height >= 34, `${button} is ${height} px high on a phone held sideways`);
    }
  },

  // Somebody without a token, and a wrong one.
  // What is wrong around the gateway, and who commanded what; the stand-in makes both up.
  async surroundings() {
    const page = await opened();
    await live(page);
    await page.locator("#problems li", {hasText: "the SCRIPT input queue"}).waitFor();
    await page.click("#tab-messages");
    await page.locator("#command-list li").first().waitFor();
    const rows = await page.locator("#command-list li").allInnerTexts();
    assert.equal(rows.length, 3);
    assert.match(rows[0], /hot_message <b>x<\/b>[^]*page session 3, uid 1000: done/);
    assert.match(rows[1], /ROBACT nobody[^]*process 12 of uid 1000: refused, there is no robot nobody/);
    assert.match(rows[2], /ROBACT ROBOT_1[^]*scripts\/a\.spt:12: done/);
    assert.equal(await page.locator("#command-list li.warning").count(), 1);
    await shot(page, "surroundings");
  },

  async looking() {
    for (const [token, name] of [["", "none"], ["#token=wrong", "wrong"]]) {
      const page = await opened({}, address.replace(/#.*/, token));
      await live(page);
      await picture(page);
      assert.match(await text_of(page, "#right-text"), /looking only|read-only/, name);
      assert.match(await run(page, "hot_message no"), /^refused: .*(cellmirror page|read-only)/);
      await page.focus("#display-choice");
      await page.selectOption("#display-choice", "3");
      await page.waitForFunction(() => document.getElementById("display-choice").value === "1");
      assert.equal(await page.evaluate(() => document.activeElement.id), "display-choice");
      await page.context().close();
    }
  },
};

const kScreens = [
  ["desk-light", {}],
  ["desk-dark", {colorScheme: "dark"}],
  ["wide-dark", {viewport: {width: 1920, height: 1080}, colorScheme: "dark"}],
  ["tablet-light", {viewport: {width: 1000, height: 760}}],
  ["phone-light", {viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true, deviceScaleFactor: 2}],
  ["phone-dark", {viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true, deviceScaleFactor: 2, colorScheme: "dark"}],
];

async function screen(name, options) {
  const page = await opened(options);
  await live(page);
  await picture(page);
  await page.waitForFunction(() => window.measured.filter(({name}) => name === "cellmirror.record").length > 5);  // charts have begun
  await shot(page, name);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth > window.innerWidth + 1);
  assert.ok(!wide, `${name}: the page is wider than the screen`);
  if (options.isMobile) {
    await page.locator("#chart-panel").scrollIntoViewIfNeeded();
    await page.waitForTimeout(200);
    await shot(page, `${name}-charts`);
    await page.locator("#console-panel").scrollIntoViewIfNeeded();
    await shot(page, `${name}-console`);
  }
  await page.context().close();
}

async function drag(page, dx, dy, canvas = "#view-canvas") {
  const box = await page.locator(canvas).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + dx, y + dy, {steps: 12});
  await page.mouse.up();
}

// Somewhere in the picture there is a thing.
async function pick_something(page) {
  const box = await page.locator("#view-canvas").boundingBox();
  for (const [x, y] of [[0.5, 0.5], [0.4, 0.55], [0.6, 0.55], [0.3, 0.6], [0.7, 0.6], [0.5, 0.7], [0.5, 0.9]]) {
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
    await page.locator("#picked").waitFor();
    const path_of = await text_of(page, "#picked-path");
    if (path_of !== "nothing is there") {
      console.log(`picked: ${path_of}`);
      return;
    }
  }
  assert.fail("nothing could be picked");
}

async function pass() {
  Object.assign(scenarios, scene_scenarios({opened, kCoarse, live, picture, shot, text_of, run, drag, address}));
  problems.length = 0;
  try {
    for (const name of scenario.split(",")) {
      await scenarios[name]();
      assert.deepEqual(problems, []);
      for (const context of browser.contexts()) await context.close();
    }
    return true;
  } catch (error) {
    console.log(error.stack ?? error);
    const page = browser.contexts().at(-1)?.pages().at(-1);
    await page?.screenshot({path: path.join(process.env.ARTEFACTS, `failed-${scenario}.png`)}).catch(() => {});
    return false;
  }
}

try {
  for (let asked = await lines.next(); !asked.done; asked = await lines.next()) {
    ({scenarios: scenario, address, arguments: rest} = JSON.parse(asked.value));
    console.log(await pass() ? "= passed" : "= failed");
  }
} finally {
  await browser.close();
}
