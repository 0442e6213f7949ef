// The values of a cell for clients: what each is, how good it is, how old. Keys are those of the nodes (src/robot_nodes.mjs).
// `quality` is the name of a StatusCode of OPC 10000-4; `age_s` is before the request; a value that is not good has none, except
// an uncertain one, which is the last that is known.

const kDegrees = 180 / Math.PI;
const kMillimetres = 1000;

// What cellmirror cannot know.
export const kUnknown = Object.freeze({quality: "BadNotSupported"});
const kNotYet = Object.freeze({quality: "BadWaitingForInitialData"});

// The values of MotionDeviceCategoryEnumeration, AxisMotionProfileEnumeration: OPC 40010-1.
export const kCategories = Object.freeze({other: 0, articulated: 1, scara: 2, cartesian: 3, spherical: 4, parallel: 5, cylindrical: 6});
const kProfiles = Object.freeze({rotary: 1, rotary_endless: 2, linear: 3, linear_endless: 4});

// Of a stream's or joint's state (docs/status.md); a word that is not known yet is no promise.
function quality_of_state(state) {
  switch (state) {
    case "fresh":
      return "Good";
    case "lost":
      return "UncertainNoCommunicationLastUsableValue";
    case "none":
    case "off":
    case "":
      return "BadWaitingForInitialData";
    default: // stale, invalid, implausible, conflict: the last valid value is reported
      return "UncertainLastUsableValue";
  }
}

function value_of(value, quality, age_s) {
  if (quality.startsWith("Bad")) return {quality};
  return value === null || value === undefined ? kNotYet : {value, quality, age_s: age_s ?? 0};
}

export function to_unit(joint, value) {
  return value === null ? null : value * (joint.linear ? kMillimetres : kDegrees);
}

// A simulated robot is where the gateway puts it: its joints have no stream, and what they are is known at once.
export function joint_values(robot, joint) {
  const quality = robot.simulated ? "Good" : quality_of_state(joint.state);
  const age_s = robot.simulated ? 0 : joint.age_s;
  return {
    position: value_of(to_unit(joint, joint.position), quality, age_s),
    speed: value_of(to_unit(joint, joint.velocity), quality, age_s),
    range: joint.range ? {value: joint.range.map((bound) => to_unit(joint, bound)), quality: "Good"} : kUnknown,
    profile: {value: profile(joint), quality: "Good"},
  };
}

function profile(joint) {
  if (joint.linear) return joint.endless ? kProfiles.linear_endless : kProfiles.linear;
  return joint.endless ? kProfiles.rotary_endless : kProfiles.rotary;
}

// By the safety mode that a controller reports by RTDE: [emergency stop, protective stop], null where the mode does not say.
const kSafetyModes = new Map([
  ["normal", [false, false]],
  ["reduced", [false, false]],
  ["recovery", [false, false]],
  ["protective stop", [false, true]],
  ["safeguard stop", [false, true]],
  ["system emergency stop", [true, null]],
  ["robot emergency stop", [true, null]],
]);

function safety_values(robot) {
  const reported = robot.simulated || robot.safety === null ? [null, null] : kSafetyModes.get(robot.safety) ?? [null, null];
  const [emergency_stop, protective_stop] = reported.map((stop) => (stop === null ? kUnknown : value_of(stop, quality_of_state(robot.stream), robot.stream_age_s)));
  return {emergency_stop, protective_stop, operational_mode: kUnknown};
}

export function robot_values(robot) {
  return {
    mode: {value: robot.mode, quality: "Good"},
    stream: {value: robot.stream, quality: "Good"},
    on_path: robot.simulated && robot.program?.runs ? {value: true, quality: "Good"} : kUnknown,
    speed_override: kUnknown,
    program_name: {value: robot.program?.name ?? "", quality: "Good"},
    program_loaded: {value: robot.program !== null, quality: "Good"},
    ...safety_values(robot),
  };
}

// Of the cell as a whole.
export function cell_values(image) {
  const {collisions, alarms} = image;
  const tested = (value) => (collisions.known ? value_of(value, "Good", collisions.age_s) : {quality: collisions.active ? "BadWaitingForInitialData" : "BadOutOfService"});
  return {
    answers: {value: true, quality: "Good"},
    collisions_tested: {value: collisions.active, quality: "Good"},
    touching: tested(collisions.touching),
    nearest_distance: tested(collisions.nearest && collisions.nearest.distance_m * kMillimetres),
    nearest_pair: tested(collisions.nearest?.names ?? null),
    alarms: alarms.unacknowledged === null ? kNotYet : {value: alarms.unacknowledged, quality: "Good"},
    highest_priority: {value: alarms.highest, quality: "Good"},
    problems: {value: image.problems, quality: "Good"},
    version: {value: image.version, quality: "Good"},
  };
}

// Every value of `values` as it is reported while the gateway does not answer; what never was known stays so.
export function without_gateway(values, quality) {
  const reported = {};
  for (const [key, one] of Object.entries(values)) {
    if (one.quality === "BadNotSupported") reported[key] = one;
    else if (quality.startsWith("Bad")) reported[key] = {quality};
    else reported[key] = one.quality.startsWith("Bad") ? one : {...one, quality};
  }
  return reported;
}
