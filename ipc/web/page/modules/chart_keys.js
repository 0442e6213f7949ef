// What the keys of recorded values mean: words, unit and scale. Pure.
import {joint_unit, scaled, shown_unit} from "./format.js";

const kQuantities = {q: "position", v: "velocity", e: "effort"};

function joint_of(robots, robot, name) {
  return robots.find(({id}) => id === robot)?.joints?.find((joint) => joint.name === name);
}

// {text, unit, scale}: the value times the scale is shown in the unit. `names`: ShortNames.
export function describe_key(key, robots, names) {
  const [kind, ...rest] = key.split("|");
  const name = rest.join("|");
  if (kQuantities[kind]) {
    const [robot, joint] = [rest[0], rest.slice(1).join("|")];
    const unit = joint_unit(joint_of(robots, robot, joint) ?? {});
    const text = `${robot} ${joint} ${kQuantities[kind]}`;
    if (kind === "e") return {text, unit: unit === "m" ? "N" : "Nm", scale: 1};
    const quantity = kind === "q" ? unit : `${unit}/s`;
    return {text, unit: shown_unit(quantity), scale: scaled(1, quantity)};
  }
  if (kind === "near") return {text: `distance ${name.split(" – ").map((path) => names.of(path)).join(" – ")}`, unit: "mm", scale: 1000};
  if (kind === "range") return {text: `range ${name}`, unit: "mm", scale: 1000};
  if (kind === "tcp") return {text: `force at the TCP of ${name}`, unit: "N", scale: 1};
  if (kind === "queue") return {text: `dropped of ${name}`, unit: "", scale: 1};
  return {text: `loop ${name}`, unit: /p99/.test(name) ? "µs" : "", scale: 1};
}

// Keys whose words have all the words of `text` in them, the shortest first.
export function found_keys(text, keys, words_of, most = 12) {
  const wanted = text.toLowerCase().split(/\s+/).filter(Boolean);
  if (wanted.length === 0) return [];
  const found = keys.map((key) => ({key, words: words_of(key)})).filter(({words}) => wanted.every((word) => words.toLowerCase().includes(word)));
  found.sort((a, b) => a.words.length - b.words.length || (a.words < b.words ? -1 : 1));
  return found.slice(0, most);
}
