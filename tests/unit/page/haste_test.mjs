import assert from "node:assert/strict";
import {test} from "node:test";
import {Haste} from "./modules/haste.js";

function turn(haste, from, frames, interval) {
  const out = [];
  for (let i = 0; i < frames; ++i) {
    haste.turned(from + i * interval);
    out.push(haste.drawing(from + i * interval));
  }
  return out;
}

test("a slow renderer is coarse while the view is turned, and sharp at rest", () => {
  const haste = new Haste();
  assert.deepEqual(turn(haste, 0, 6, 100), [false, false, false, true, true, true]);
  assert.equal(haste.drawing(900), false, "it rests");
  assert.equal(turn(haste, 5000, 1, 100)[0], true, "known to be slow");
  assert.deepEqual(turn(haste, 5100, 10, 45), new Array(10).fill(true), "no flicker between both");
});

test("a quick renderer draws all pixels, and one that became quick again too", () => {
  const haste = new Haste();
  assert.ok(turn(haste, 0, 100, 16).every((coarse) => !coarse));
  turn(haste, 10000, 10, 100);
  assert.equal(turn(haste, 11000, 20, 16).at(-1), false);
});

test("bodies that move do not make it coarse", () => {
  const haste = new Haste();
  for (let at = 0; at < 3000; at += 100) assert.equal(haste.drawing(at), false);
});
