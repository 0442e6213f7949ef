// What the head of the page says of collisions.
import test from "node:test";
import assert from "node:assert/strict";
import {collisions_in_brief} from "./modules/findings.js";

const pair = {a: "Arm.J_1", b: "Table", depth_m: 0.01};

test("fresh findings are told as they are", () => {
  assert.deepEqual(collisions_in_brief({touching: [], collision_age_s: 0.003}), {text: "nothing touches", state: "fresh", title: null});
  assert.deepEqual(collisions_in_brief({touching: [pair], touching_count: 70, collision_age_s: 0.003}),
    {text: "70 touching", state: "lost", title: null});
});

test("nobody knows what touches where nothing is tested", () => {
  assert.deepEqual(collisions_in_brief({touching: null, touching_count: 0, collision_age_s: null}),
    {text: "collisions not known", state: "none", title: null});
});

test("what is old is said", () => {
  const old = collisions_in_brief({touching: [], collision_age_s: 3.14});
  assert.equal(old.state, "stale");
  assert.match(old.text, /nothing touches.*old/);
  assert.match(old.title, /3\.1 s/);
  assert.equal(collisions_in_brief({touching: [pair], collision_age_s: 0.6}).state, "stale");
});
