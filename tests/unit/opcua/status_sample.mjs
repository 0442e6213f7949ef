// A status with one robot of each kind, as docs/status.md describes it; without the parts that the bridge does not read.
export function joint(name, more = {}) {
  return {name, position: 0.5, velocity: 0.25, effort: 0, unit: "rad", range: [-Math.PI, Math.PI], beyond_range: false, state: "fresh", implausible: null, age_s: 0.002, ...more};
}

export function robot(id, more = {}) {
  return {id, mode: "mirrored", stream: {kind: "dds", state: "fresh", age_s: 0.002, details: {}}, joints: [joint("J_1"), joint("J_2", {unit: "m", position: 1.5})], ...more};
}

export function status(robots = [robot("A")], more = {}) {
  return {
    version: "1.2.3",
    cell: "cell",
    robots,
    programs: {loaded: []},
    collisions: {active: true, age_s: 0.01, sequence: 7, touching_count: 2, nearest: {a: "A.x", b: "B.y", distance_m: 0.25}},
    alarms: {unacknowledged: 3, highest_priority: "high"},
    problems: [{kind: "script_queue", text: "it is gone; start again"}],
    ...more,
  };
}
