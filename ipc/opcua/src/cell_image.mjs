// What the status of a gateway says about its robots, with everything checked: a status is text from outside. What is not as
// docs/status.md says is left out or null, and counted where it is a robot or a joint.
import {Refusal} from "./refusal.mjs";

export const kMostRobots = 256; // kMaxRobots, kMaxJointsPerRobot of rt_core/base/capacity.hpp; 50 kB of memory a joint
export const kMostJoints = 16;
export const kLongestName = 256; // characters
const kMostProblems = 16;
const kLargest = 1e9; // of any quantity in SI units; beyond that dates and units overflow
const kUnlimited = 1e5; // rad; no limit of a joint is as large, and continuous joints have 1e6 (config/urdf_joint.cpp)

export function plain_object(value) {
  return typeof value === "object" && value !== null && !Array.isArray(value) ? value : {};
}

function list(value) {
  return Array.isArray(value) ? value : [];
}

function number(value) {
  return typeof value === "number" && Math.abs(value) <= kLargest ? value : null;
}

// Not negative: an age, a distance.
function amount(value) {
  const found = number(value);
  return found === null || found < 0 ? null : found;
}

// A number of things, reported as UInt32.
function count(value) {
  return Number.isInteger(value) && value >= 0 ? Math.min(value, 0xffff_ffff) : null;
}

// Cut to its length and well-formed, control characters replaced: it is shown by clients.
export function plain_text(value, longest = kLongestName) {
  if (typeof value !== "string") return "";
  return Buffer.from(value.slice(0, longest), "utf8").toString("utf8").replace(/[\u0000-\u001f\u007f-\u009f\u2028\u2029]/g, "\ufffd");
}

// At most `most` of those that `read` makes something of, each name once; `left_out` counts the others.
function named(values, most, name_of, read, left_out) {
  const found = new Map();
  for (const value of list(values)) {
    const one = read(plain_object(value), left_out);
    if (one === null || name_of(one) === "" || found.has(name_of(one)) || found.size >= most) left_out.count++;
    else found.set(name_of(one), one);
  }
  return [...found.values()];
}

function joint(value) {
  if (value.unit !== "rad" && value.unit !== "m") return null;
  const [least, greatest] = list(value.range).map(number);
  const bounded = typeof least === "number" && typeof greatest === "number" && least < greatest;
  return {
    name: plain_text(value.name),
    linear: value.unit === "m",
    position: number(value.position),
    velocity: number(value.velocity),
    range: bounded ? [least, greatest] : null,
    endless: bounded && greatest - least > kUnlimited,
    state: plain_text(value.state),
    age_s: amount(value.age_s),
  };
}

function robot(value, left_out) {
  const stream = plain_object(value.stream);
  const details = plain_object(stream.details);
  return {
    id: plain_text(value.id),
    mode: plain_text(value.mode),
    simulated: value.mode === "simulated",
    stream: plain_text(stream.state),
    stream_age_s: amount(stream.age_s),
    // The safety mode in words, where the stream reports it.
    safety: stream.kind === "rtde" && typeof details.safety === "string" ? plain_text(details.safety) : null,
    joints: named(value.joints, kMostJoints, (one) => one.name, joint, left_out),
    program: null,
  };
}

function add_programs(robots, programs) {
  const by_id = new Map(robots.map((one) => [one.id, one]));
  for (const value of list(plain_object(programs).loaded).slice(0, 4 * kMostRobots)) {
    const {robot: id, program, state} = plain_object(value);
    const owner = by_id.get(plain_text(id));
    if (!owner || typeof program !== "string") continue;
    // A robot may have several; the one that runs is reported.
    const runs = state === "running" || state === "waiting";
    if (owner.program === null || runs) owner.program = {name: plain_text(program), runs};
  }
}

function collisions(value) {
  const {active, age_s, sequence, touching_count, nearest} = plain_object(value);
  const pair = plain_object(nearest);
  const known = active === true && amount(sequence) > 0;
  return {
    active: active === true,
    known,
    age_s: amount(age_s),
    touching: count(touching_count),
    nearest: amount(pair.distance_m) === null ? null : {distance_m: pair.distance_m, names: [plain_text(pair.a), plain_text(pair.b)]},
  };
}

function alarms(value) {
  const {unacknowledged, highest_priority} = plain_object(value);
  return {unacknowledged: count(unacknowledged), highest: plain_text(highest_priority)};
}

// Refusal where the document is not the status of a gateway.
export function cell_image(document) {
  const status = plain_object(document);
  if (!Array.isArray(status.robots) || typeof status.version !== "string") {
    throw new Refusal("the gateway's answer is not a status", "use a bridge of the gateway's version");
  }
  const left_out = {count: 0};
  const robots = named(status.robots, kMostRobots, (one) => one.id, robot, left_out);
  add_programs(robots, status.programs);
  return {
    cell: plain_text(status.cell),
    version: plain_text(status.version),
    robots,
    left_out: left_out.count,
    collisions: collisions(status.collisions),
    alarms: alarms(status.alarms),
    problems: list(status.problems).slice(0, kMostProblems).map((one) => plain_text(plain_object(one).text, 1024)),
  };
}
