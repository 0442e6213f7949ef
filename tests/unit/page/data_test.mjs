// Pictures, histories, the tree, tokens, numbers: what the page knows before it shows anything.
import test from "node:test";
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {left_out_in_words, record} from "./modules/charts.js";
import * as format from "./modules/format.js";
import {History} from "./modules/history.js";
import {picture_size, PictureOrder, stamp_of, start_of_free_view, text_is_readable, request_of} from "./modules/live_view.js";
import {decode_picture} from "./modules/picture_format.js";
import {state_text, time_text} from "./modules/programs.js";
import {place_in_range, state_of} from "./modules/robots.js";
import {kColours} from "./modules/strip_chart.js";
import * as token from "./modules/token.js";
import {TreeModel} from "./modules/tree_model.js";
import {choice_of, value_of} from "./modules/view_choice.js";

test("a picture is read as the protocol has it", () => {
  // By hand from docs/monitor-page.md: CMP1, sequence 7, 640 x 480, 0, age 0.25 s, 0, then the JPEG.
  const bytes = Uint8Array.from([0x43, 0x4d, 0x50, 0x31, 7, 0, 0, 0, 0x80, 2, 0xe0, 1, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0xd0, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xd8, 0xff]);
  const picture = decode_picture(bytes.buffer);
  assert.deepEqual([picture.sequence, picture.width, picture.height, picture.age_s], [7, 640, 480, 0.25]);
  assert.deepEqual([...picture.jpeg], [0xff, 0xd8, 0xff]);
});

test("robot programs are told by state, what they wait for, and time", () => {
  assert.equal(state_text({state: "waiting", waits_for: "semaphore TABLE", direction: "forward"}), "waiting for semaphore TABLE");
  assert.equal(state_text({state: "running", waits_for: "", direction: "backward"}), "running, backward");
  assert.equal(time_text({runs: 0, elapsed_s: 0, expected_s: null}), "");
  assert.equal(time_text({runs: 1, elapsed_s: 12.34, expected_s: null}), "12.3 s");
  assert.equal(time_text({runs: 2, elapsed_s: 2, expected_s: 45.6}), "2.0 s of 45.6 s");
});

test("the curve of a robot without data ends", () => {
  const history = new History();
  const live = (time_s, state) => ({time_s, collision_age_s: state === "lost" ? 9 : 0.01,
    near: [{a: "A", b: "B", distance_m: 0.2}],
    robots: [{id: "R", mode: "mirrored", state, joints: [{name: "J", position: 1.5, velocity: 0, state}]},
      {id: "S", mode: "simulated", joints: [{name: "J", position: 2.5, velocity: 0, state: "none"}]}]});
  ["fresh", "stale", "lost", "implausible", "fresh"].forEach((state, i) => record(history, live(i, state)));
  const [, mirrored, simulated, near] = history.window(["q|R|J", "q|S|J", "near|A – B"], 10);
  assert.deepEqual(mirrored, [1.5, 1.5, null, null, 1.5]);
  assert.deepEqual(simulated, Array(5).fill(2.5));
  assert.deepEqual(near.map((value) => value !== null), [true, true, false, true, true]);
});

test("the page shows unknown states before the first data", () => {
  const page = readFileSync(new URL("./index.html", import.meta.url), "utf8");
  for (const id of ["no-touching", "no-near", "no-alarms", "no-alarm-history", "no-robots", "no-tissue-events"])
    assert.match(page, new RegExp(`id="${id}" class="empty unknown">Not known yet`), id);
});

test("what is no picture is refused", () => {
  assert.equal(decode_picture(new ArrayBuffer(32)), null);
  assert.equal(decode_picture(new ArrayBuffer(64)), null);
  assert.equal(decode_picture("text"), null);
});

test("pictures are as large as the room, within what is worth drawing", () => {
  assert.deepEqual(picture_size(640, 480, 1), [640, 480]);
  const [width, height] = picture_size(2000, 1000, 2);
  assert.ok(width * height <= 1280 * 960 * 1.01);
  assert.ok(Math.abs(width / height - 2) < 0.01);
  assert.ok(picture_size(3000, 400, 2)[0] <= 1920);
  assert.deepEqual(picture_size(1, 1, 1), [64, 64]);
});

test("a request names what is to be seen, and nothing else", () => {
  const request = (choice) => request_of(choice, [640, 480]);
  assert.deepEqual([request({kind: "display"}).view, request({kind: "display"}).camera], [undefined, undefined]);
  assert.equal(request({kind: "view", id: 0}).view, 0);
  assert.equal(request({kind: "camera", name: "CAMERA_5"}).camera, "CAMERA_5");
  assert.deepEqual(choice_of(value_of({kind: "camera", name: "a:b"})), {kind: "camera", name: "a:b"});
});

test("a free view begins where the picture is", () => {
  const views = [0, 1, 2].map((id) => ({id, viewpoint_m: [id, -5, 1], lookpoint_m: [0, 0, 0], twist_rad: 0, opening_angle_rad: 0.5, camera: id === 2 ? "C" : ""}));
  assert.equal(start_of_free_view({kind: "view", id: 1}, {views}).viewpoint_m[0], 1);
  assert.equal(start_of_free_view({kind: "camera", name: "C"}, {views}).viewpoint_m[0], 2);
  assert.equal(start_of_free_view({kind: "display"}, {views}).viewpoint_m[0], 0);
  const displays = [{id: 1, name: "a", views: [2]}, {id: 2, name: "b", views: [1, 0]}];
  assert.equal(start_of_free_view({kind: "display"}, {views, display: 2, displays}).viewpoint_m[0], 1);
  assert.equal(start_of_free_view({kind: "display"}, {views, display: 1, displays}).viewpoint_m[0], 2);
  assert.ok(start_of_free_view({kind: "display"}, null).opening_angle_rad > 0);
});

test("a history keeps the newest and knows gaps", () => {
  const sut = new History(5, 10);
  for (let i = 0; i < 23; ++i) sut.add(i, (put) => i % 2 && put("odd", i));
  const [times, odd] = sut.window(["odd"], 100);
  assert.deepEqual(times, [18, 19, 20, 21, 22]);
  assert.deepEqual(odd, [null, 19, null, 21, null]);
  assert.deepEqual(sut.window(["odd"], 2, [10]), [[20, 21, 22], [null, 210, null]]);
  assert.deepEqual(sut.window(["unknown"], 2)[1], [null, null, null]);
  assert.deepEqual(sut.window(["odd"], 1, [], 20), [[19, 20], [19, null]], "up to an earlier time");
});

test("a history is bounded in series, and lets go of those that ended", () => {
  const sut = new History(4, 3);
  for (let i = 0; i < 40; ++i) sut.add(i, (put) => put(`series ${i}`, 1));
  assert.ok(sut.keys("series").length <= 3);
  sut.add(41, (put) => put("new", 5));
  assert.equal(sut.newest("new"), 5);
});

test("everything that charts show is recorded", () => {
  const sut = new History();
  record(sut, {time_s: 1, loop: {latency_p99_us: 40, compute_p99_us: 9},
    robots: [{id: "R", joints: [{name: "J_1", position: 0.5, velocity: -1}]}], near: [{a: "a", b: "b", distance_m: 0.2}],
    ranges: [{id: "U", distance_m: null}], forces: [{robot: "R", tcp_force_n: [3, 4, 0], joints: [{name: "J_1", effort: 7}]}]});
  assert.equal(sut.newest("q|R|J_1"), 0.5);
  assert.equal(sut.newest("tcp|R"), 5);
  assert.equal(sut.newest("e|R|J_1"), 7);
  assert.equal(sut.newest("range|U"), null);
  assert.deepEqual(sut.keys("range|"), [], "what never had a value takes no place");
  record(sut, {time_s: 2, ranges: [{id: "V", distance_m: 0.5}, {id: "W", distance_m: 0.5, doubtful: true}]});
  assert.deepEqual(["V", "W"].map((id) => sut.newest(`range|${id}`)), [0.5, null]);
  record(sut, {time_s: 3, near: [{a: "a", b: "b", distance_m: 0.2}]});
  assert.ok(Math.abs(sut.newest("near|a – b") - 0.2) < 1e-6);
});

test("in a large cell all but joints are recorded, and what is not is said", () => {
  const joints = (value) => Array.from({length: 10}, (_, k) => ({name: `J_${k}`, ...value}));
  const robots = Array.from({length: 64}, (_, i) => ({id: `R${i}`, joints: joints({position: 1, velocity: 0})}));
  const live = {robots, loop: {latency_p99_us: 40, compute_p99_us: 9}, near: Array.from({length: 50}, (_, i) => ({a: `a${i}`, b: "b", distance_m: 1})),
    ranges: [{id: "U", distance_m: 1}], forces: robots.map(({id}) => ({robot: id, tcp_force_n: [1, 0, 0], joints: joints({effort: 1})}))};
  const sut = new History();
  for (let i = 1; i < 4; ++i) record(sut, {...live, time_s: i});
  record(sut, {...live, near: live.near.map((pair) => ({...pair, b: "another"})), time_s: 5});
  assert.deepEqual(["loop|", "near|", "range|", "tcp|"].map((prefix) => sut.keys(prefix).length), [2, 100, 1, 64]);
  assert.equal(sut.newest("q|R63|J_9"), 1);
  assert.match(left_out_in_words(sut.left_out()), /not recorded: \d+ velocities, 640 efforts$/);
  assert.equal(left_out_in_words([]), "");
});

test("an older picture is not drawn over a newer one", () => {
  const sut = new PictureOrder();
  assert.deepEqual([1, 3, 2, 4].map((sequence) => sut.is_newer(sequence)), [true, true, false, true]);
  const before = sut.connection;
  sut.begin();
  assert.notEqual(sut.connection, before);
  assert.equal(sut.is_newer(1), true, "each connection counts from the beginning");
});

test("a picture grows older while no other one comes", () => {
  assert.deepEqual([0, 1.5].map((since_s) => stamp_of({age_s: 0.05}, since_s)), ["picture 50 ms", "picture 1.6 s"]);
});

test("text in a picture is readable where its pixels are not much smaller than the page's", () => {
  assert.equal(text_is_readable(640, 640), true);
  assert.equal(text_is_readable(1170, 390), false);
});

// WCAG 2.1, 1.4.11: 3 to 1, over the panels of style/theme.css.
test("curves stand out from light and dark", () => {
  const luminance = (colour) => [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16) / 255)
    .map((part) => (part <= 0.03928 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4))
    .reduce((sum, part, i) => sum + part * [0.2126, 0.7152, 0.0722][i], 0);
  for (const colour of kColours) {
    for (const ground of ["#ffffff", "#171c1f"]) {
      const [dark, light] = [luminance(colour), luminance(ground)].sort((a, b) => a - b);
      assert.ok((light + 0.05) / (dark + 0.05) >= 3, `${colour} on ${ground}`);
    }
  }
});

const nodes = [
  {path: "A", name: "A", parent: null}, {path: "A.b", name: "b", parent: "A"}, {path: "A.b.c", name: "c", parent: "A.b"},
  {path: "D", name: "D", parent: ""}, {path: "lost", name: "lost", parent: "nobody"},
];

test("the tree shows what is open", () => {
  const sut = new TreeModel();
  sut.set(nodes);
  assert.deepEqual(sut.rows().map(({node}) => node.path), ["A", "D", "lost"]);
  sut.reveal("A.b.c");
  assert.deepEqual(sut.rows().map(({node, level}) => [node.path, level]), [["A", 1], ["A.b", 2], ["A.b.c", 3], ["D", 1], ["lost", 1]]);
  assert.deepEqual(sut.rows("B.C").map(({node}) => node.path), ["A.b.c"]);
});

test("the world, which has no name, is no row", () => {
  const sut = new TreeModel();
  sut.set([{path: "", name: "", parent: null}, {path: "A", name: "A", parent: ""}]);
  assert.deepEqual(sut.rows().map(({node}) => node.path), ["A"]);
});

test("a ring of parents does not hang the page", () => {
  const sut = new TreeModel();
  sut.set([{path: "a", name: "a", parent: "b"}, {path: "b", name: "b", parent: "a"}, {path: "c", name: "c", parent: "c"}]);
  sut.reveal("a");
  assert.ok(sut.rows().length <= 3);
});

test("a token comes from the address and leaves it", () => {
  const kept = new Map();
  const store = {setItem: (key, value) => kept.set(key, value), getItem: (key) => kept.get(key) ?? null, removeItem: (key) => kept.delete(key)};
  const history = {replaceState: (...given) => (history.given = given)};
  assert.equal(token.take_token({hash: "#token=abc%20d", pathname: "/", search: ""}, store, history), "abc d");
  assert.equal(history.given[2], "/");
  assert.equal(token.kept_token(store), "abc d");
  assert.equal(token.token_in("#tok=abc"), null);
  assert.equal(token.token_in("#token=%"), null);
});

test("where the browser forbids storage, the token lasts as long as the page", (context) => {
  const before = globalThis.window;
  context.after(() => {
    token.keep_token("");
    globalThis.window = before;
  });
  globalThis.window = {
    get sessionStorage() {
      throw new Error("The operation is insecure.");
    },
    location: {hash: "#token=abc", pathname: "/", search: ""},
    history: {replaceState: () => {}},
  };
  assert.equal(token.take_token(), "abc");
  window.location.hash = "";
  assert.equal(token.take_token(), "abc");
  token.keep_token("");
  assert.equal(token.kept_token(), null);
});

test("a store that takes nothing loses no token", (context) => {
  const full = {setItem: () => {
    throw new Error("QuotaExceededError");
  }, getItem: () => null, removeItem: () => {}};
  context.after(() => token.keep_token("", full));
  token.keep_token("abc", full);
  assert.equal(token.kept_token(full), "abc");
});

test("bars stand within their range", () => {
  assert.equal(place_in_range(0, -1, 1), 0.5);
  assert.equal(place_in_range(9, -1, 1), 1);
  assert.equal(place_in_range(0, null, 1), null);
  assert.equal(place_in_range(0, 1, 1), null);
});

test("a robot that is not mirrored has no doubtful data", () => {
  assert.equal(state_of({mode: "simulated", state: "lost"}), "simulated");
  assert.equal(state_of({mode: "mirrored", state: "stale"}), "stale");
  assert.equal(state_of({mode: "mirrored"}), "none");
});

test("numbers are readable", () => {
  assert.equal(format.number(-0.04, 1), "0.0");
  assert.equal(format.number(-1.25, 1), "\u22121.3");
  assert.equal(format.number(null, 1), "–");
  assert.equal(format.joint_value(Math.PI, "rad"), "180.0");
  assert.equal(format.joint_unit({kind: "prismatic"}), "m");
  assert.equal(format.length(0.0031), "3.1 mm");
  assert.equal(format.length(1.5), "1.500 m");
  assert.equal(format.age(0.0042), "4 ms");
  assert.equal(format.age(75), "1 min 15 s");
  assert.equal(format.count(1234567), "1\u202f234\u202f567");
});
