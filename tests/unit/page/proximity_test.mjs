// What the head of the page says of collisions.
import test from "node:test";
import assert from "node:assert/strict";
import {barrier_in_words, collisions_in_brief, cut_note, nothing_in_words, range_in_words, warned_count} from "./modules/proximity.js";
import {ShortNames} from "./modules/short_names.js";

const pair = {a: "Arm.J_1", b: "Table", depth_m: 0.01};

test("fresh results are shown as they are", () => {
  assert.deepEqual(collisions_in_brief({touching: [], collision_age_s: 0.003}), {text: "nothing touches", state: "fresh", title: null});
  assert.deepEqual(collisions_in_brief({touching: [pair], touching_count: 70, collision_age_s: 0.003}),
    {text: "70 touching", state: "lost", title: null});
});

test("nobody knows what touches where nothing is tested", () => {
  assert.deepEqual(collisions_in_brief({touching: null, touching_count: 0, collision_age_s: null}),
    {text: "collisions not known", state: "none", title: null});
});

test("an empty list says that nothing touches only while that is known", () => {
  const said = (live, quiet) => nothing_in_words(live, "Nothing touches.", quiet);
  assert.deepEqual(said({touching: [], collision_age_s: 0.003}), {text: "Nothing touches.", known: true});
  assert.deepEqual(said({touching: null}), {text: "Not known: nothing is tested.", known: false});
  assert.deepEqual(said({touching: [], collision_age_s: 3.14}), {text: "Not known: the newest result is 3.1 s old.", known: false});
  assert.deepEqual(said({touching: [], collision_age_s: 0.003}, true), {text: "Not known: no news from the gateway.", known: false});
});

test("what is old is said", () => {
  const old = collisions_in_brief({touching: [], collision_age_s: 3.14});
  assert.equal(old.state, "stale");
  assert.match(old.text, /nothing touches.*old/);
  assert.match(old.title, /3\.1 s/);
  assert.equal(collisions_in_brief({touching: [pair], collision_age_s: 0.6}).state, "stale");
});

test("a reading that may be wrong warns and says why", () => {
  const words = (range) => range_in_words(range, new ShortNames());
  assert.deepEqual(words({distance_m: 1.2, object: "Arm.J_1.J_2"}), {value: "1.200 m", more: "Arm.J_1.J_2", warns: false});
  assert.deepEqual(words({distance_m: null, object: "", doubtful: true}), {value: "no echo", more: "doubtful, may be nearer", warns: true});
  assert.match(words({distance_m: 0.01, object: "A.b", in_blind_zone: true, doubtful: true}).more, /A\.b; doubtful, may be nearer; in the blind zone/);
});

test("a light barrier says what interrupts it, and how often it was", () => {
  const words = (barrier) => barrier_in_words(barrier, new ShortNames());
  assert.deepEqual(words({interrupted: false, interruptions: 0, object: ""}), {value: "free", more: ""});
  assert.deepEqual(words({interrupted: true, interruptions: 1, object: "Arm.hand"}), {value: "interrupted", more: "Arm.hand; 1 interruption"});
  assert.deepEqual(words({interrupted: true, interruptions: 3, object: "", doubtful: true}), {value: "interrupted", more: "doubtful; 3 interruptions"});
});

test("pairs that the gateway left out are counted", () => {
  assert.equal(warned_count({near: Array(50).fill({within_warning: true}), within_warning_count: 180}), 180);
  assert.equal(warned_count({near: [{distance_m: 0.01}, {distance_m: 0.2}], warning_distance_m: 0.1}), 1);
  assert.equal(cut_note(40, 180), "the first 40 of 180");
  assert.equal(cut_note(40, 40), "");
});

test("bodies have the names that the gateway gives them, so that equal robots differ", () => {
  const sut = new ShortNames();
  const path = (i) => `Mantec_${i}.J_1.J_2.J_3`;
  sut.learn_from({touching: null, near: [{a: path(1), a_short: "Mantec_1.J_3", b: path(2), b_short: "Mantec_2.J_3"}],
    ranges: [{object: "Cell.Arm.link", object_short: "Arm.link"}, {object: ""}]});
  assert.deepEqual([path(1), path(2), "Cell.Arm.link", "unknown.path", ""].map((one) => sut.of(one)),
    ["Mantec_1.J_3", "Mantec_2.J_3", "Arm.link", "unknown.path", ""]);
});
