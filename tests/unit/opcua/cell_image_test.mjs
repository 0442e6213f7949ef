import assert from "node:assert/strict";
import {test} from "node:test";

import {cell_image, kLongestName, kMostJoints, kMostRobots} from "../../../ipc/opcua/src/cell_image.mjs";
import {cell_values, joint_values, robot_values} from "../../../ipc/opcua/src/cell_values.mjs";
import {joint, robot, status} from "./status_sample.mjs";

test("a status is read as it is documented", () => {
  const image = cell_image(status());
  assert.equal(image.version, "1.2.3");
  assert.deepEqual(image.robots.map((one) => one.id), ["A"]);
  const [first, second] = image.robots[0].joints;
  assert.deepEqual([first.name, first.linear, first.position, first.state, first.endless], ["J_1", false, 0.5, "fresh", false]);
  assert.equal(second.linear, true);
  assert.deepEqual(image.problems, ["it is gone; start again"]);
  assert.equal(image.left_out, 0);
});

test("what is no status is refused", () => {
  for (const document of [null, 1, "status", [], {}, {robots: {}}, {robots: [], version: 1}, {error: "no"}]) {
    assert.throws(() => cell_image(document), /not a status/);
  }
});

test("robots and joints that have no name of their own or shown are left out and counted", () => {
  const image = cell_image(status([robot("A"), robot("A"), robot(""), 7, null, robot("B", {joints: [joint("J"), joint("J"), joint("K", {unit: "inch"}), "x"]})]));
  assert.deepEqual(image.robots.map((one) => [one.id, one.joints.length]), [["A", 2], ["B", 1]]);
  assert.equal(image.left_out, 4 + 3);
});

test("numbers of robots and joints, and lengths of names, are bounded", () => {
  const many = Array.from({length: 5000}, (_, i) => robot(`R${i}`, {joints: Array.from({length: 200}, (_unused, j) => joint(`J${j}`))}));
  const image = cell_image(status(many.slice(0, 300)));
  assert.equal(image.robots.length, kMostRobots);
  assert.ok(image.robots.every((one) => one.joints.length === kMostJoints));
  assert.equal(cell_image(status([robot("x".repeat(100_000))])).robots[0].id.length, kLongestName);
});

test("names keep their letters, but no control characters or halves of characters", () => {
  const [one] = cell_image(status([robot("Gr\u00f6\u00dfe \u{1f916}/.;=\u0000\n\u2028\ud800")])).robots;
  assert.equal(one.id, "Gr\u00f6\u00dfe \u{1f916}/.;=\ufffd\ufffd\ufffd\ufffd");
});

test("the program that runs is reported before others of its robot", () => {
  const loaded = [{robot: "A", program: "first", state: "ended"}, {robot: "A", program: "second", state: "running"}, {robot: "A", program: "third", state: "loaded"}, {robot: "?", program: "x"}, null];
  const [one] = cell_image(status([robot("A")], {programs: {loaded}})).robots;
  assert.deepEqual(one.program, {name: "second", runs: true});
});

// A small generator, so that a failure can be repeated.
function random_from(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

const kRubbish = [null, undefined, true, -1, NaN, Infinity, 1e308, "", "x", "\ud800", [], {}, [[]], {length: 1e9}, {__proto__: null}, 2n ** 70n];

function spoil(value, random) {
  if (random() < 0.08) return kRubbish[Math.floor(random() * kRubbish.length)];
  if (Array.isArray(value)) return value.map((one) => spoil(one, random));
  if (typeof value === "object" && value !== null) return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, spoil(one, random)]));
  return value;
}

test("a spoilt status is refused or shown, never more than that", () => {
  const random = random_from(7);
  let shown = 0;
  for (let round = 0; round < 3000; ++round) {
    const spoilt = spoil(status([robot("A"), robot("B", {mode: "simulated"})], {programs: {loaded: [{robot: "A", program: "p", state: "running"}]}}), random);
    let image;
    try {
      image = cell_image(spoilt);
    } catch (error) {
      assert.match(error.message, /not a status/);
      continue;
    }
    ++shown;
    for (const number of [image.collisions.touching, image.alarms.unacknowledged]) assert.ok(number === null || (Number.isInteger(number) && number >= 0 && number < 2 ** 32), `${number}`);
    const values = Object.values(cell_values(image)).concat(image.robots.flatMap((one) => [robot_values(one), ...one.joints.map((j) => joint_values(one, j))]).flatMap((all) => Object.values(all)));
    for (const {value, quality, age_s} of values) {
      assert.match(quality, /^(Good|Bad|Uncertain)/);
      assert.ok(quality.startsWith("Bad") === (value === undefined), `${quality} ${value}`);
      assert.ok(age_s === undefined || (Number.isFinite(age_s) && age_s >= 0));
      for (const one of [value].flat(2)) assert.ok(typeof one !== "number" || Number.isFinite(one), `${one}`);
    }
  }
  assert.ok(shown > 1000, `${shown}`);
});
