import assert from "node:assert/strict";
import test from "node:test";

import {age_of, robots_of, silent_text, way_to_page, WallModel} from "./modules/wall_model.js";

const content = (cell, level = "ok", more = {}) => ({cell, title: "", host: "h", instance: "default", level, state: level, marks: [], ...more});
const tile = (number, of, pulse = {age_s: 0.1}) => ({number, content: of, pulse});
const changes = (from, tiles, removed = []) => ({from, to: from + 1, tiles, removed, totals: {}});
const whole = (to, tiles) => ({to, tiles, totals: {}});

test("changes count once the whole is there", () => {
  const model = new WallModel();
  assert.equal(model.take_changes(changes(4, [tile(1, content("A"))]), 0), false);
  assert.equal(model.take_whole(whole(4, [tile(1, content("A")), tile(2, content("B"))]), 0), true);
  assert.equal(model.tiles.size, 2);
  assert.equal(model.take_changes(changes(5, [], [2]), 0), true, "what was held goes before");
  assert.equal(model.tiles.size, 1);
});

test("a gap asks for the whole", () => {
  const model = new WallModel();
  model.take_whole(whole(1, []), 0);
  assert.equal(model.take_changes(changes(1, [tile(1, content("A"))]), 0), true);
  assert.equal(model.take_changes(changes(3, []), 0), false);
  assert.equal(model.take_changes(changes(4, []), 0), false, "until it has come");
  assert.equal(model.take_whole(whole(3, [tile(1, content("A"))]), 0), true);
  assert.equal(model.take_changes(changes(5, []), 0), true);
});

test("what is not said again stays, and tiles that are gone go", () => {
  const model = new WallModel();
  model.take_whole(whole(1, [tile(1, content("A")), tile(2, content("B"))]), 1000);
  model.take_changes(changes(1, [{number: 1, pulse: {age_s: 0.5, sequence: 9}}]), 2000);
  assert.equal(model.tiles.get(1).content.cell, "A");
  assert.equal(model.tiles.get(1).pulse.sequence, 9);
  assert.equal(age_of(model.tiles.get(1), 2500), 1);
  assert.equal(age_of(model.tiles.get(2), 2500), 1.6);
  model.take_whole(whole(7, [tile(2, content("B"))]), 3000);
  assert.deepEqual([...model.tiles.keys()], [2]);
});

test("a change without content of a tile that is not known is left out", () => {
  const model = new WallModel();
  model.take_whole(whole(1, []), 0);
  model.take_changes(changes(1, [{number: 1, pulse: {}}]), 0);
  assert.equal(model.tiles.size, 0);
});

test("the worst comes first, then names with numbers as people count", () => {
  const model = new WallModel();
  model.take_whole(whole(1, [tile(1, content("cell 10")), tile(2, content("cell 9")), tile(3, content("z", "fault")), tile(4, content("a", "attention"))]), 0);
  assert.deepEqual(model.ordered().map((one) => one.content.cell), ["z", "a", "cell 9", "cell 10"]);
  assert.deepEqual(model.ordered("CELL").map((one) => one.content.cell), ["cell 9", "cell 10"]);
  assert.deepEqual(model.counts(), {fault: 1, attention: 1, ok: 2});
});

test("the way to a page is a link, a tunnel, or told", () => {
  assert.deepEqual(way_to_page(content("A", "ok", {page: "http://127.0.0.1:9001/", page_port: 8420})), {href: "http://127.0.0.1:9001/"});
  assert.equal(way_to_page(content("A", "ok", {page: "", page_port: 8420, host: "press-pc"})).command, "ssh -L 8420:127.0.0.1:8420 press-pc");
  assert.equal(way_to_page(content("A", "ok", {page: "", page_port: 8420, host: "x; rm -rf ~"})).command, undefined, "a host is no command");
  assert.equal(way_to_page(content("A", "ok", {page: "", page_port: 8420, host: "-oProxyCommand=x"})).command, undefined);
  assert.equal(way_to_page(content("A", "ok", {page: "javascript:alert(1)", page_port: 0})).href, undefined);
  assert.equal(way_to_page(content("A", "ok", {page: ""})).text, "");
});

test("robots with something to tell come first", () => {
  const robots = ["fresh", "fresh", "lost", "stale"].map((state, i) => ({id: `r${i}`, mirrored: true, state}));
  const {shown, more} = robots_of(tile(1, content("A", "ok", {robots, robots_left_out: 2}), {robots_age_s: [1, 2, 3, null]}), 3);
  assert.deepEqual(shown.map((robot) => [robot.id, robot.age_s]), [["r2", 3], ["r3", null], ["r0", 1]]);
  assert.equal(more, 3);
});

test("silence has its day where that is not today", () => {
  const now = new Date(2026, 5, 2, 12, 0, 0);
  assert.match(silent_text(content("A", "fault", {silent_since_ms: +now - 1000}), now), /^since 11:59:59$/);
  assert.match(silent_text(content("A", "fault", {silent_since_ms: +now - 86400e3}), now), /^since 2026-06-01 12:00:00$/);
  assert.equal(silent_text(content("A"), now), "");
});
