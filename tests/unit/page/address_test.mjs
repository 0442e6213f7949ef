import assert from "node:assert/strict";
import {test} from "node:test";

import {read_address, write_address} from "./modules/address.js";
import {csv_of} from "./modules/chart_export.js";
import {describe_key, found_keys} from "./modules/chart_keys.js";
import {short_labels} from "./modules/short_labels.js";
import {nearest} from "./modules/strip_chart.js";
import {distance_in_words} from "./modules/scene_tools.js";
import {take_token} from "./modules/token.js";

const nothing = {mode: null, choice: null, select: null, robot: null, quantity: null, span: null, values: []};

test("an address says again what was written", () => {
  const view = {viewpoint_m: [1, -2.5, 3], lookpoint_m: [0, 0, 0.5], twist_rad: 0.1, opening_angle_rad: 0.7};
  for (const state of [
    {...nothing, mode: "scene", choice: {kind: "free", view}, select: "Cell.Table 1.top&x=#", values: ["q|R 1|J_1", "near|a – b"]},
    {...nothing, mode: "picture", choice: {kind: "view", id: 6}, robot: "R,1", quantity: "effort", span: "120"},
    {...nothing, choice: {kind: "camera", name: "CAM: 5%"}},
  ]) {
    assert.deepEqual(read_address(write_address(state)), state);
  }
  assert.equal(write_address({...nothing, choice: {kind: "display"}, quantity: "position", span: "60"}), "");
  assert.deepEqual(read_address(""), nothing);
});

test("an address that makes no sense says nothing", () => {
  for (const hash of ["#see=view:9", "#see=free&at=1,2,3", "#see=free&at=1,2,3,4,5,6,NaN,8", "#see=free&at=1,2,3,4,5,6,7,1e9", "#see=camera:", "#mode=4d&span=7&quantity=x",
    "#view-panel", "#%E0%A4%A", `#see=${"a".repeat(10000)}`]) {
    const {values, ...rest} = read_address(hash);
    assert.deepEqual(values, []);
    assert.ok(Object.values(rest).every((value) => value === null), hash);
  }
  assert.equal(read_address(`#${"value=x&".repeat(100)}`).values.length, 24);
});

test("the token leaves the address, the rest stays", () => {
  const taken = (hash) => {
    let left = null;
    take_token({hash, pathname: "/", search: ""}, null, {replaceState: (_a, _b, to) => { left = to; }});
    return left;
  };
  assert.equal(taken("#token=abc"), "/");
  assert.equal(taken("#token=abc&mode=3d"), "/#mode=3d");
  assert.equal(taken("#mode=3d&token=abc"), "/#mode=3d");
  assert.equal(taken("#mode=3d"), null);
});

test("joints whose names begin alike are told apart", () => {
  const joints = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint"];
  assert.equal(new Set(short_labels(joints)).size, 3);
  assert.deepEqual(short_labels(["left_arm_shoulder_pan", "left_arm_shoulder_lift"]), ["…pan", "…lift"]);
  assert.deepEqual(short_labels(["J_1", "J_2"]), ["J_1", "J_2"]);
  assert.deepEqual(short_labels(["only_one_of_a_long_name"]), ["only_one_of_a_long_name"]);
  const same = ["aaaaaaaaaaaaa", "aaaaaaaaaaaab"];
  assert.deepEqual(short_labels(same), same);
});

test("keys are found by words, in any order", () => {
  const names = {of: (path) => path};
  const robots = [{id: "R", joints: [{name: "J_1", unit: "m"}]}];
  assert.deepEqual(describe_key("q|R|J_1", robots, names), {text: "R J_1 position", unit: "mm", scale: 1000});
  assert.equal(describe_key("e|R|J_1", robots, names).unit, "N");
  assert.equal(describe_key("queue|a|b", robots, names).text, "dropped of a|b");
  const words_of = (key) => describe_key(key, robots, names).text;
  assert.deepEqual(found_keys("position j_1", ["v|R|J_1", "q|R|J_1"], words_of).map(({key}) => key), ["q|R|J_1"]);
  assert.deepEqual(found_keys("  ", ["q|R|J_1"], words_of), []);
});

test("a table has a time and a column for each curve", () => {
  const columns = [[0, 0.5], [1, null]];
  const text = csv_of([{title: "T", labels: ['=a"b,c'], units: ["mm"], columns}, {title: "Empty", labels: [], units: [], columns: [[]]}]);
  assert.equal(text, 'time (UTC),"T: =a""b,c [mm]"\r\n1970-01-01T00:00:00.000Z,1\r\n1970-01-01T00:00:00.500Z,\r\n');
  assert.equal(csv_of([]), "time (UTC)\r\n");
});

test("the cursor is at the nearest sample", () => {
  assert.deepEqual([-5, 0.4, 0.6, 1.4, 9].map((time) => nearest([0, 1, 2], time)), [0, 0, 1, 1, 2]);
  assert.equal(distance_in_words([0, 0, 0], [0.003, 0.004, 0]), "5.0 mm (x 3.0 mm, y 4.0 mm, z 0.0 mm)");
});
