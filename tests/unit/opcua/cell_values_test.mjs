import assert from "node:assert/strict";
import {test} from "node:test";

import {cell_image} from "../../../ipc/opcua/src/cell_image.mjs";
import {cell_values, joint_values, robot_values, without_gateway} from "../../../ipc/opcua/src/cell_values.mjs";
import {joint, robot, status} from "./status_sample.mjs";

function first(document) {
  const [one] = cell_image(document).robots;
  return {robot: one, joint: one.joints[0]};
}

function of_joint(more, of_robot = {}) {
  const found = first(status([robot("A", {joints: [joint("J", more)], ...of_robot})]));
  return joint_values(found.robot, found.joint);
}

function near(value, expected) {
  assert.ok(Math.abs(value - expected) < 1e-9, `${value} is not ${expected}`);
}

test("angles are degrees, lengths millimetres", () => {
  const angle = of_joint({position: Math.PI / 2, velocity: -Math.PI, range: [-Math.PI, Math.PI / 4]});
  near(angle.position.value, 90);
  near(angle.speed.value, -180);
  near(angle.range.value[0], -180);
  near(angle.range.value[1], 45);
  const length = of_joint({unit: "m", position: 1.25, velocity: 0.5, range: [0, 2]});
  assert.deepEqual([length.position.value, length.speed.value, length.range.value], [1250, 500, [0, 2000]]);
});

test("the profile of an axis follows from its unit and range", () => {
  assert.equal(of_joint({}).profile.value, 1);
  assert.equal(of_joint({range: [-1e6, 1e6]}).profile.value, 2);
  assert.equal(of_joint({unit: "m", range: [0, 1]}).profile.value, 3);
  assert.equal(of_joint({unit: "m", range: [-1e6, 1e6]}).profile.value, 4);
});

test("the quality of a mirrored position is the state of its joint, its age that of the joint", () => {
  for (const [state, quality] of [["fresh", "Good"], ["stale", "UncertainLastUsableValue"], ["invalid", "UncertainLastUsableValue"], ["implausible", "UncertainLastUsableValue"],
    ["conflict", "UncertainLastUsableValue"], ["lost", "UncertainNoCommunicationLastUsableValue"], ["none", "BadWaitingForInitialData"], ["a word of tomorrow", "UncertainLastUsableValue"]]) {
    const {position, speed} = of_joint({state, age_s: 0.75});
    assert.equal(position.quality, quality, state);
    assert.equal(speed.quality, quality, state);
    assert.equal(position.age_s, quality.startsWith("Bad") ? undefined : 0.75);
    assert.equal(position.value === undefined, quality.startsWith("Bad"));
  }
});

test("a simulated robot is good although its joints have no stream", () => {
  const {position} = of_joint({state: "none", age_s: null}, {mode: "simulated"});
  assert.deepEqual([position.quality, position.age_s], ["Good", 0]);
});

test("a number that is none is not reported as one", () => {
  assert.deepEqual(of_joint({position: null}).position, {quality: "BadWaitingForInitialData"});
});

test("what cellmirror does not know it does not report", () => {
  const values = robot_values(first(status()).robot);
  for (const key of ["speed_override", "operational_mode", "emergency_stop", "protective_stop", "on_path"]) assert.deepEqual(values[key], {quality: "BadNotSupported"}, key);
});

test("safety is reported where a controller reports it, and as old as its report", () => {
  const of_mode = (safety, more = {}) => robot_values(first(status([robot("A", {stream: {kind: "rtde", state: "fresh", age_s: 0.125, details: {safety}, ...more}})])).robot);
  for (const [mode, emergency, protective] of [["normal", false, false], ["reduced", false, false], ["protective stop", false, true], ["safeguard stop", false, true], ["robot emergency stop", true, undefined],
    ["system emergency stop", true, undefined], ["fault", undefined, undefined], ["violation", undefined, undefined], ["safety mode 77", undefined, undefined]]) {
    const {emergency_stop, protective_stop} = of_mode(mode);
    assert.equal(emergency_stop.value, emergency, mode);
    assert.equal(protective_stop.value, protective, mode);
  }
  assert.deepEqual(of_mode("normal").emergency_stop, {value: false, quality: "Good", age_s: 0.125});
  assert.equal(of_mode("normal", {state: "stale"}).emergency_stop.quality, "UncertainLastUsableValue");
  assert.equal(of_mode("normal", {kind: "dds"}).emergency_stop.quality, "BadNotSupported");
});

test("a simulated robot is on its path while its program runs", () => {
  const values = (state) => robot_values(first(status([robot("A", {mode: "simulated"})], {programs: {loaded: [{robot: "A", program: "p", state}]}})).robot);
  assert.deepEqual(values("running").on_path, {value: true, quality: "Good"});
  assert.equal(values("held").on_path.quality, "BadNotSupported");
  assert.deepEqual([values("held").program_name.value, values("held").program_loaded.value], ["p", true]);
});

test("collisions that are not tested are not reported as none", () => {
  const reported = cell_values(cell_image(status()));
  assert.deepEqual([reported.touching.value, reported.nearest_distance.value, reported.nearest_pair.value], [2, 250, ["A.x", "B.y"]]);
  const off = cell_values(cell_image(status([], {collisions: {active: false, sequence: 7, touching_count: 0}})));
  assert.equal(off.touching.quality, "BadOutOfService");
  const not_yet = cell_values(cell_image(status([], {collisions: {active: true, sequence: 0, touching_count: 0, nearest: null}})));
  assert.equal(not_yet.touching.quality, "BadWaitingForInitialData");
});

test("without the gateway nothing stays good", () => {
  const values = {known: {value: 1, quality: "Good", age_s: 0.5}, waiting: {quality: "BadWaitingForInitialData"}, unknown: {quality: "BadNotSupported"}};
  const late = without_gateway(values, "UncertainNoCommunicationLastUsableValue");
  assert.deepEqual(late.known, {value: 1, quality: "UncertainNoCommunicationLastUsableValue", age_s: 0.5});
  assert.deepEqual(late.waiting, values.waiting);
  const gone = without_gateway(values, "BadNoCommunication");
  assert.deepEqual(gone, {known: {quality: "BadNoCommunication"}, waiting: {quality: "BadNoCommunication"}, unknown: {quality: "BadNotSupported"}});
});
