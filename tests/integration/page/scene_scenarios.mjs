// What a person does with the 3D view, the charts and links; `kit`: the steps of scenarios.mjs.
import assert from "node:assert/strict";
import {readFile} from "node:fs/promises";
import path from "node:path";

const kSizes = [
  ["desk-light", {}],
  ["desk-dark", {colorScheme: "dark"}],
  ["phone-light", {viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true}],
  ["phone-dark", {viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true, colorScheme: "dark"}],
];

export function scene_scenarios({opened, kCoarse, live, picture, shot, text_of, run, drag, address}) {
  const with_hash = (more) => `${address}&${more}`;
  const drawn = (page, least = 1) => page.waitForFunction((n) => Number(document.getElementById("scene-canvas").dataset.sequence) >= n, least);
  // The bodies are there: poses come before the file.
  const triangles = (page, least) => page.waitForFunction((n) => Number(document.getElementById("scene-canvas").dataset.triangles) > n, least);
  // What is drawn, as an image that the browser has composed, without what lies over it.
  const show_over = (page, visibility) => page.evaluate((value) => {
    for (const id of ["scene-tools", "scene-labels", "scene-note", "view-age"]) document.getElementById(id).style.visibility = value;
  }, visibility);
  async function seen(page) {
    await show_over(page, "hidden");
    const image = await page.locator("#scene-canvas").screenshot();
    await show_over(page, "");
    return image;
  }
  // Within some seconds: the machine may be busy.
  async function changes(page, before, why) {
    for (let i = 0; i < 240; ++i) {
      if (!before.equals(await seen(page))) return;
      await page.waitForTimeout(250);
    }
    assert.fail(why);
  }
  // What is drawn when nothing has changed for a second and a half: on a busy machine bodies and readings come late.
  async function rests(page, why) {
    for (let i = 0; i < 30; ++i) {
      const before = await seen(page);
      await page.waitForTimeout(1500);
      const after = await seen(page);
      if (before.equals(after)) return after;
    }
    return assert.fail(why);
  }
  let axe_text = null;

  // Findings of axe-core, none expected; evaluated from outside, since the page's policy refuses foreign scripts.
  async function axe(page, state) {
    axe_text ??= await readFile(path.join(process.env.AXE_CORE, "axe.min.js"), "utf8");
    await page.evaluate(axe_text);
    const found = await page.evaluate(async () => (await window.axe.run(document, {resultTypes: ["violations"]})).violations.map(
      ({id, help, nodes}) => `${id}: ${help}\n${nodes.slice(0, 5).map(({html, any}) => `    ${html.slice(0, 160)} ${any[0]?.message ?? ""}`).join("\n")}`));
    assert.deepEqual(found, [], `${state}: ${found.join("\n")}`);
  }

  // A body of the scene somewhere on the canvas, but not `other`: its path, and where.
  async function pick_a_body(page, other = null) {
    const box = await page.locator("#scene-canvas").boundingBox();
    for (let y = 0.3; y < 0.9; y += 0.05) {
      for (let x = 0.1; x < 0.9; x += 0.04) {
        await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
        const found = await page.evaluate(() => document.getElementById("picked-path").textContent);
        if (found && found !== "nothing is there" && found !== other) return {path: found, x: box.x + x * box.width, y: box.y + y * box.height};
      }
    }
    return assert.fail("nothing could be picked in 3D");
  }

  const colour_at = (page, id) => page.evaluate((name) => getComputedStyle(document.getElementById(name)).backgroundColor, id);

  return {
    async scene() {
      const page = await opened(kCoarse, with_hash("mode=3d"));
      await live(page);
      await drawn(page, 3);
      assert.equal(await page.getAttribute("#mode-scene", "aria-pressed"), "true");
      assert.ok(await page.locator("#view-canvas").isHidden());
      const first = await seen(page);
      assert.ok(first.length > 8000, `a drawing of ${first.length} bytes is empty`);
      const pictures = () => page.evaluate(() => document.getElementById("view-canvas").dataset.sequence ?? "");
      const before_3d = await pictures();  // those that came before WebGL was there
      await changes(page, first, "joints move, and the view does not");
      assert.equal(await pictures(), before_3d, "pictures go on being drawn");

      await page.click("#scene-fit");
      await page.waitForFunction(() => document.getElementById("view-choice").value === "free");
      const fitted = await seen(page);
      await drag(page, 160, -40, "#scene-canvas");
      await changes(page, fitted, "a drag does not turn the view");
      await page.waitForFunction(() => /see=free&at=/.test(location.hash));

      const picked = await pick_a_body(page);
      await page.waitForFunction((wanted) => document.querySelector('#tree-list [aria-selected="true"]')?.dataset.path === wanted, picked.path);
      await page.waitForFunction((wanted) => new URLSearchParams(location.hash.slice(1)).get("select") === wanted, picked.path);
      await shot(page, "scene-picked");
      await page.click("#picked-close");

      await page.selectOption("#view-choice", "camera:CAMERA_5");
      await page.waitForFunction(() => /see=camera:CAMERA_5/.test(location.hash));
      await page.selectOption("#view-choice", "view:3");
      await page.waitForFunction(() => /see=view:3/.test(location.hash));

      await page.click("#mode-picture");
      await picture(page);
      assert.ok(await page.locator("#scene-canvas").isHidden());
      await page.click("#mode-scene");
      const before = Number(await page.getAttribute("#scene-canvas", "data-sequence"));
      await drawn(page, before + 3);
    },

    // Nothing moves: what is drawn changes by the tools alone.
    async scene_tools() {
      const page = await opened(kCoarse, with_hash("mode=3d"));
      await live(page);
      await drawn(page, 3);
      await page.click("#scene-fit");
      await triangles(page, 200);
      await rests(page, "nothing moves, and the view does");
      const first = await pick_a_body(page);
      const second = await pick_a_body(page, first.path);
      await page.click("#picked-close");
      await page.click("#scene-measure");
      const measured = (pattern) => page.locator("#scene-measured", {hasText: pattern}).waitFor();
      await measured(/first/);
      await page.mouse.click(first.x, first.y);
      await measured(/second/);
      await page.mouse.click(second.x, second.y);
      await measured(/^[\d.]+ m?m \(x .* y .* z .*\)$/);
      assert.ok(await page.locator("#picked").isHidden(), "a point that is measured is not named");
      await page.click("#scene-measure");
      assert.equal(await text_of(page, "#scene-measured"), "");

      const uncut = await seen(page);
      await page.selectOption("#scene-cut", "x");
      await page.locator("#scene-cut-at").fill("20");
      await changes(page, uncut, "the cut changes nothing");
      const cut = await seen(page);
      await page.click("#scene-cut-flip");
      await changes(page, cut, "the other side is the same");
      await shot(page, "scene-cut");
      await page.selectOption("#scene-cut", "");
      assert.ok(await page.locator("#scene-cut-at").isHidden());
    },

    // A sheet of tissue moves and is cut; the gateway's picture of volumes is in the corner.
    async scene_tissue() {
      const page = await opened(kCoarse, with_hash("mode=3d"));
      await live(page);
      await page.waitForFunction(() => Number(document.getElementById("scene-canvas").dataset.tissue) > 500);
      await triangles(page, 1000);
      const whole = Number(await page.getAttribute("#scene-canvas", "data-triangles"));
      await changes(page, await seen(page), "the tissue does not move");
      await page.waitForFunction((before) => Number(document.getElementById("scene-canvas").dataset.triangles) !== before, whole);
      await page.waitForFunction(() => document.getElementById("view-area").classList.contains("with-inset"));
      assert.match(await text_of(page, "#scene-note"), /volumes are only in the gateway's picture/);
      const shown = () => page.evaluate(() => Number(document.getElementById("view-canvas").dataset.sequence ?? 0));
      await page.waitForFunction(() => Number(document.getElementById("view-canvas").dataset.sequence ?? 0) > 2);
      const [inset, area] = await Promise.all(["#view-canvas", "#view-area"].map((id) => page.locator(id).boundingBox()));
      assert.ok(inset.width < 0.45 * area.width, `a picture ${inset.width} px wide covers what lies below`);
      await shot(page, "scene-tissue");
      // Another viewpoint is that of the picture too.
      const before = await shown();
      await page.selectOption("#view-choice", "view:3");
      await page.waitForFunction((n) => Number(document.getElementById("view-canvas").dataset.sequence) > n, before);
      await page.click("#mode-picture");
      await page.waitForFunction(() => !document.getElementById("view-area").classList.contains("with-inset"));
      await page.waitForFunction(() => document.getElementById("view-canvas").width > 500 * window.devicePixelRatio);
    },

    // What is old does not look new, and a connection that is back goes on.
    async scene_old() {
      const wire = {live: (message) => message};
      const page = await opened(kCoarse, with_hash("mode=3d"), wire);
      await live(page);
      await drawn(page, 3);
      await wire.end();
      await page.locator("#gone").waitFor();
      await page.waitForFunction(() => document.getElementById("view-area").classList.contains("stale"));
      await page.waitForFunction(() => /gateway is gone.*old/.test(document.getElementById("view-note").innerText));
      wire.ended = false;
      await page.waitForFunction(() => !document.getElementById("view-area").classList.contains("stale"));
    },

    async scene_without_webgl() {
      const page = await opened({}, with_hash("mode=3d"));
      await live(page);
      await picture(page);
      assert.equal(await page.getAttribute("#mode-picture", "aria-pressed"), "true");
      assert.match(await text_of(page, "#scene-note"), /WebGL.*pictures are shown/);
      await axe(page, "without WebGL");
      const plain = await opened();
      await live(plain);
      await picture(plain);
      assert.ok(await plain.locator("#scene-note").isHidden(), "nobody asked for 3D");
    },

    async scene_axe() {
      for (const [name, options] of kSizes) {
        const page = await opened(options, with_hash("mode=3d&value=loop%7Cwake-up%20p99"));
        await live(page);
        await drawn(page, 3);
        await axe(page, `${name}, 3D`);
        await shot(page, `scene-${name}`);
        if (!options.isMobile) {
          await page.click("#scene-measure");
          await page.selectOption("#scene-cut", "z");
          await page.fill("#chart-search", "position");
          await page.locator("#chart-found button").first().waitFor();
          await axe(page, `${name}, tools and search`);
          await page.press("#chart-search", "Escape");
        }
        if (options.isMobile) await page.locator(".robot > summary").first().click();
        await page.locator(".robot .tools button", {hasText: "Take offline"}).first().click();
        await page.locator("#confirm-dialog").waitFor();
        await axe(page, `${name}, a question`);
        await page.click("#confirm-no");
        await page.click("#tab-alarms");
        await page.locator("#alarm-list li").first().waitFor();
        await axe(page, `${name}, alarms`);
        if (options.isMobile) await page.locator("#side-panel").scrollIntoViewIfNeeded();
        await shot(page, `alarms-${name}`);
        await page.click("#mode-picture");
        await picture(page);
        await axe(page, `${name}, pictures`);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth > window.innerWidth + 1);
        assert.ok(!wide, `${name}: the page is wider than the screen`);
        await page.context().close();
      }
      const [light, dark] = await Promise.all([{}, {colorScheme: "dark"}].map(async (options) => colour_at(await opened(options), "scene-tools")));
      assert.notEqual(light, dark, "the tools have the same colour in dark mode");
    },

    // A recording that is played: where collisions and faults began, and the way there by keys alone.
    async playback() {
      const page = await opened();
      await page.waitForFunction(() => document.getElementById("line-text").textContent === "replay, not live");
      await page.locator("#replay-bar").waitFor();
      await page.locator("#replay-marks i").nth(2).waitFor({state: "attached"});
      const drawn = await page.locator("#replay-marks i").evaluateAll((marks) => marks.map((mark) => [mark.dataset.kind, mark.style.left]));
      assert.deepEqual(drawn.map(([kind]) => kind), ["fault", "fault", "collision"], "two that are too near to be told apart are one");
      assert.equal(drawn[1][1], "50%");
      const [mark, slider] = await Promise.all(["#replay-marks i >> nth=1", "#replay-slider"].map((name) => page.locator(name).boundingBox()));
      assert.ok(Math.abs(mark.x + mark.width / 2 - (slider.x + slider.width / 2)) < 4, "a mark is not above its time");
      const texts = await page.locator("#replay-events option").allInnerTexts();
      assert.equal(texts.length, 5);
      assert.equal(texts[0], "4 events");
      assert.match(texts[1], /:\d\d\.500 collision: ROBOT_1\.link, <b>table<\/b>$/);
      await page.locator("#replay-events").focus();
      await page.keyboard.press("ArrowDown");
      await page.keyboard.press("ArrowDown");
      await page.waitForFunction(() => document.getElementById("replay-slider").value === "12.6" || document.getElementById("replay-slider").value === "12.5");
      await page.selectOption("#replay-events", {label: texts[4]});
      await page.waitForFunction(() => document.getElementById("replay-slider").value === "48.25");
      await axe(page, "a recording that is played");
      await shot(page, "playback");
      await page.context().close();
    },

    // Alarms: how many wait, who has acknowledged what; two people see the same.
    async alarms() {
      const page = await opened();
      const other = await opened();
      await live(page);
      await live(other);
      await page.waitForFunction(() => document.getElementById("alarm-badge").textContent === "3 alarms");
      assert.equal(await page.getAttribute("#alarm-badge", "data-state"), "lost", "one of them is of high priority");
      await page.click("#alarm-badge");
      assert.equal(await page.getAttribute("#tab-alarms", "aria-selected"), "true");
      await page.locator("#alarm-list li").nth(2).waitFor();
      assert.match(await page.locator("#alarm-list li").nth(0).innerText(), /high[^]*the data of ROBOT_7 are lost[^]*active for/);
      assert.match(await page.locator("#alarm-list li").nth(1).innerText(), /3 times since/);
      assert.match(await page.locator("#alarm-list li").nth(2).innerText(), /<b>liver<\/b> tears[^]*over since/);
      assert.match(await page.locator("#alarm-history li").innerText(), /the disk was full[^]*acknowledged by Ada Lovelace at/);
      await axe(page, "alarms");
      await shot(page, "alarms");

      // A name is asked for once; whoever does not tell it acknowledges nothing.
      const acknowledge = (n) => page.locator("#alarm-list li").nth(n).locator("button").click();
      await acknowledge(0);
      await page.locator("#name-dialog").waitFor();
      await axe(page, "asked for a name");
      await page.click("#name-cancel");
      assert.equal(await page.locator("#console-log li").count(), 0);
      await acknowledge(0);
      await page.fill("#name-input", "12");
      await page.press("#name-input", "Enter");
      await page.locator("#name-note", {hasText: "begins with a letter"}).waitFor();
      await page.fill("#name-input", " Åsa  Berg; ");
      await page.press("#name-input", "Enter");
      await page.locator("#console-log li", {hasText: "ALARM_ACK Åsa_Berg 4"}).locator(".done").waitFor();
      await page.locator('#alarm-list [data-alarm="4"]', {hasText: /acknowledged by Åsa Berg at/}).waitFor();
      assert.ok(await page.locator('#alarm-list [data-alarm="4"] button').isHidden(), "acknowledged twice");
      await other.waitForFunction(() => document.getElementById("alarm-badge").textContent === "2 alarms");
      assert.equal(await other.getAttribute("#alarm-badge", "data-state"), "stale");
      await other.click("#alarm-badge");
      await other.locator('#alarm-list [data-alarm="4"]', {hasText: "acknowledged by Åsa Berg"}).waitFor();

      await page.click("#alarm-all");
      await page.locator("#alarm-badge").waitFor({state: "hidden"});
      await page.locator('#alarm-history [data-alarm="2"]').waitFor();
      assert.equal(await page.locator("#alarm-list li").count(), 2, "what is active stays");
      await other.locator('#alarm-history [data-alarm="2"]', {hasText: "acknowledged by Åsa Berg"}).waitFor();
      assert.equal(await text_of(page, "#alarm-name"), "You are Åsa Berg");
      await page.reload();
      await live(page);
      await page.click("#tab-alarms");
      assert.equal(await text_of(page, "#alarm-name"), "You are Åsa Berg", "the name was forgotten");
    },

    // Taking a robot offline asks first.
    async offline() {
      const page = await opened();
      await live(page);
      const card = page.locator('[data-robot="ROBOT_1"]');
      await card.locator("button", {hasText: "Take offline"}).click();
      await page.locator("#confirm-dialog").waitFor();
      assert.match(await text_of(page, "#confirm-title"), /ROBOT_1 offline\?/);
      await page.keyboard.press("Escape");
      assert.equal(await page.locator("#console-log li").count(), 0, "a no is a no");
      await card.locator("button", {hasText: "Take offline"}).click();
      await page.click("#confirm-yes");
      await page.locator("#console-log li", {hasText: "ROBOT ROBOT_1 offline"}).locator(".done").waitFor();
      await card.locator("button", {hasText: "Take online"}).click();
      await page.locator("#console-log li", {hasText: "ROBOT ROBOT_1 online"}).locator(".done").waitFor();
    },

    async charts() {
      const page = await opened({acceptDownloads: true});
      await live(page);
      await page.waitForFunction(() => window.measured.filter(({name}) => name === "cellmirror.record").length > 35);
      const plot = page.locator(".chart .plot", {has: page.locator("canvas")}).nth(1);
      let box = await plot.boundingBox();
      // Values under the cursor.
      await page.mouse.move(box.x + box.width - 20, box.y + box.height / 2);
      await page.waitForFunction(() => [...document.querySelectorAll(".chart figcaption")].some(({textContent}) => /at \d\d:\d\d:\d\d/.test(textContent)));
      // A part of the time, then all again.
      box = await plot.boundingBox();  // captions may have moved it
      await page.mouse.move(box.x + 0.7 * box.width, box.y + 30);
      await page.mouse.down();
      await page.mouse.move(box.x + 0.97 * box.width, box.y + 32, {steps: 6});
      await page.mouse.up();
      await page.locator("#chart-unzoom").waitFor();
      assert.equal(await page.getAttribute("#chart-pause", "aria-pressed"), "true", "what is looked at runs away");
      await page.click("#chart-unzoom");
      assert.ok(await page.locator("#chart-unzoom").isHidden());
      await page.click("#chart-pause");
      assert.equal(await text_of(page, "#chart-pause"), "Pause");

      await page.fill("#chart-search", "robot_2 j_3 vel");
      await page.press("#chart-search", "Enter");
      await page.fill("#chart-search", "dropped sensor");
      await page.locator("#chart-found button").first().click();
      assert.equal(await page.locator("#chart-chosen li").count(), 2);
      await page.waitForFunction(() => new URLSearchParams(location.hash.slice(1)).getAll("value").length === 2);
      await page.fill("#chart-search", "nothing like this");
      await page.locator("#chart-found", {hasText: "nothing of that name"}).waitFor();
      await page.press("#chart-search", "Escape");

      const [table] = await Promise.all([page.waitForEvent("download"), page.click("#chart-csv")]);
      const lines = (await readFile(await table.path(), "utf8")).trim().split("\r\n");
      assert.match(lines[0], /^time \(UTC\),Chosen: .*ROBOT_2 J_3 velocity.*Joints: J_1/);
      assert.ok(lines.length > 20, `${lines.length} lines`);
      const columns = lines[0].split(",").length;
      assert.ok(lines.every((line) => line.split(",").length === columns));
      assert.match(lines[1], /^\d{4}-\d\d-\d\dT[\d:.]+Z,/);
      const [image] = await Promise.all([page.waitForEvent("download"), page.click("#chart-png")]);
      const bytes = await readFile(await image.path());
      assert.equal(bytes.subarray(1, 4).toString(), "PNG");
      assert.ok(bytes.length > 8000, `a picture of ${bytes.length} bytes`);
      await shot(page, "charts");

      // The link shows another person the same.
      const link = page.url();
      const other = await opened({}, link);
      await live(other);
      assert.equal(await other.locator("#chart-chosen li").count(), 2);
      await page.locator("#chart-chosen button").first().click();
      await page.locator("#chart-chosen button").first().click();
      await page.waitForFunction(() => location.hash === "");
    },

    // Frames a second while the view turns, and those of a bare scene of three.js with the same file, canvas and kind of material.
    async scene_bench() {
      const kSeconds = 6;
      const page = await opened({}, with_hash("mode=3d"));
      await live(page);
      await drawn(page, 3);
      await page.click("#scene-fit");
      await page.waitForTimeout(1500);
      const {width, height} = await page.locator("#scene-canvas").boundingBox();
      const triangles = Number(await page.getAttribute("#scene-canvas", "data-triangles"));
      const of_page = await page.evaluate((seconds) => new Promise((resolve) => {
        const canvas = document.getElementById("scene-canvas");
        window.measured = [];
        const until = performance.now() + 1000 * seconds;
        const turn = () => {
          canvas.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowRight"}));
          if (performance.now() < until) requestAnimationFrame(turn);
          else setTimeout(() => resolve(window.measured.filter(({name}) => name === "cellmirror.scene").length / seconds), 200);
        };
        turn();
      }), kSeconds);
      await page.context().close();
      const bare = await opened({}, new URL("page/icon.svg", address).href);
      await bare.route("**/bare.html", (route) => route.fulfill({contentType: "text/html", body: "<!doctype html><body></body>"}));
      await bare.goto(new URL("bare.html", address).href);
      const of_bare = await bare.evaluate(async ([seconds, wide, high]) => {
        const THREE = await import("/page/lib/three/build/three.module.js");
        const {GLTFLoader} = await import("/page/lib/three/examples/jsm/loaders/GLTFLoader.js");
        const renderer = new THREE.WebGLRenderer({antialias: true});
        renderer.setSize(wide, high);
        document.body.append(renderer.domElement);
        const file = await new Promise((resolve, reject) => new GLTFLoader().load("/scene.glb", resolve, undefined, reject));
        const scene = new THREE.Scene();
        scene.add(file.scene, new THREE.HemisphereLight(0xffffff, 0x888888, 0.6), new THREE.DirectionalLight(0xffffff, 0.5));
        let i = 0;
        file.scene.traverse((node) => {
          if (!node.isMesh) return;
          node.material = new THREE.MeshLambertMaterial({color: 0x6688aa});
          node.position.set(0.4 * (i % 10), 0.4 * Math.floor(i / 10), 0);
          ++i;
        });
        const camera = new THREE.PerspectiveCamera(40, wide / high, 0.05, 100);
        const box = new THREE.Box3().setFromObject(file.scene);
        const middle = box.getCenter(new THREE.Vector3());
        const reach = box.getSize(new THREE.Vector3()).length() / 2 / Math.sin(camera.fov * Math.PI / 360);
        let frames = 0;
        const begin = performance.now() + 1500;
        await new Promise((resolve) => {
          const turn = () => {
            const angle = 0.13 * frames;
            camera.position.set(middle.x + reach * Math.cos(angle), middle.y + reach * 0.5, middle.z + reach * Math.sin(angle));
            camera.lookAt(middle);
            renderer.render(scene, camera);
            if (performance.now() >= begin) ++frames;
            if (performance.now() < begin + 1000 * seconds) requestAnimationFrame(turn);
            else resolve();
          };
          turn();
        });
        return {rate: frames / seconds, triangles: renderer.info.render.triangles};
      }, [kSeconds, width, height]);
      console.log(`scene: ${of_page.toFixed(1)} frames a second with ${triangles} triangles at ${width} x ${height}; bare: ${of_bare.rate.toFixed(1)} with ${of_bare.triangles}`);
    },

    // The figure of the documentation, of the running demo.
    async scene_figure() {
      const page = await opened({viewport: {width: 1440, height: 900}}, with_hash("mode=3d"));
      await live(page);
      await drawn(page, 3);
      await page.waitForTimeout(25000);  // charts fill
      await pick_a_body(page, "HTL_UMGEBUNG");  // its walls and floor hide what stands out
      await page.click("#picked-node");
      await page.waitForTimeout(1000);
      await shot(page, "monitor_page_3d");
    },

    // The pictures of the gateway, at night; and the same page on a telephone.
    async page_figure() {
      const page = await opened({viewport: {width: 1440, height: 900}, colorScheme: "dark"}, with_hash("mode=pictures"));
      await live(page);
      await picture(page);
      await page.waitForTimeout(25000);  // charts fill
      await shot(page, "monitor_page");
      const phone = await opened({viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true}, with_hash("mode=pictures"));
      await live(phone);
      await picture(phone);
      await phone.waitForTimeout(3000);
      await shot(phone, "monitor_page_phone");
    },

    // A running gateway: what is drawn changes when a joint moves, and the body that is clicked is the gateway's.
    async scene_gateway() {
      const page = await opened(kCoarse, with_hash("mode=3d"));
      await live(page);
      await triangles(page, 1000);
      const still = await rests(page, "nothing moves, and the view does");
      assert.match(await run(page, "POS_ROB PUMA_762 JOINT_INC 20"), /^done/);
      await changes(page, still, "a joint moved, and the view did not");
      const picked = await pick_a_body(page);
      console.log(`picked: ${picked.path}`);
      await page.waitForFunction((wanted) => document.querySelector('#tree-list [aria-selected="true"]')?.dataset.path === wanted, picked.path);
      await shot(page, "scene-gateway");
    },

    // A link: view, selection and chart are those of the address.
    async link() {
      const page = await opened({}, with_hash("see=view:2&select=Cell.Table_3.top&robot=ROBOT_3&quantity=velocity&span=20"));
      await live(page);
      await picture(page);
      assert.equal(await page.inputValue("#view-choice"), "view:2");
      assert.equal(await page.inputValue("#chart-robot"), "ROBOT_3");
      assert.equal(await page.inputValue("#chart-quantity"), "velocity");
      assert.equal(await page.inputValue("#chart-span"), "20");
      await page.waitForFunction(() => document.querySelector('#tree-list [aria-selected="true"]')?.dataset.path === "Cell.Table_3.top");
      assert.equal(await text_of(page, "#right-text"), "may command", "the token was lost");
      assert.ok(!/token/.test(page.url()));
      await page.evaluate(() => { location.hash = "#see=view:4"; });
      await page.waitForFunction(() => document.getElementById("view-choice").value === "view:4");
      await page.evaluate(() => { location.hash = "#see=view:77&at=x&select=&robot=%00"; });
      await page.waitForTimeout(200);
      assert.equal(await page.inputValue("#view-choice"), "view:4");
      await run(page, "hot_message still here");
    },
  };
}
