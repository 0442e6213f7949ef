// A card for each robot: mode, state and age of its data, joints as bars within their ranges.
import {confirmed} from "./confirm.js";
import {byId, element, setText, setAttribute, KeyedRows, Visibility} from "./dom.js";
import {short_labels} from "./short_labels.js";
import {age, joint_unit, joint_value, number, scaled, shown_unit} from "./format.js";

// Where the value stands within the range: 0 to 1; null where there is no range.
export function place_in_range(value, lower, upper) {
  if (![value, lower, upper].every(Number.isFinite) || upper <= lower) return null;
  return Math.max(0, Math.min(1, (value - lower) / (upper - lower)));
}

// The state of a robot's data as one word: that of its worst joint where the robot reports none.
export function state_of(robot) {
  if (robot.mode !== "mirrored") return "simulated";
  return robot.state && robot.state !== "none" ? robot.state : "none";
}

const kStateTexts = {
  simulated: "simulated", fresh: "fresh", stale: "stale", lost: "lost", invalid: "invalid",
  implausible: "implausible", conflict: "two senders", none: "no data",
};

export class Robots {
  constructor({select, command, may_command}) {
    this.select_ = select;
    this.command_ = command;
    this.may_command_ = may_command;
    this.list_ = byId("robot-list");
    this.visibility_ = new Visibility(null);
    this.cards_ = new KeyedRows(this.list_, (robot) => this.make_card_(robot), (card, robot) => this.update_card_(card, robot));
    byId("stop-all").addEventListener("click", () => this.command_("STOP_ALL"));
    this.chosen_ = null;
    this.narrow_ = window.matchMedia("(max-width: 759px)").matches;  // a phone shows the list first
  }

  update(live) {
    const robots = live.robots ?? [];
    this.cards_.show(robots, (robot) => robot.id);
    byId("no-robots").hidden = robots.length > 0;
    setText(byId("no-robots"), "The cell has no robots.");
    byId("no-robots").classList.remove("unknown");
    const doubtful = robots.filter((robot) => !["fresh", "simulated"].includes(state_of(robot))).length;
    setText(byId("robot-count"), doubtful ? `${robots.length}, ${doubtful} not fresh` : String(robots.length));
  }

  highlight(id) {
    this.chosen_ = id;
    for (const card of this.list_.children) card.classList.toggle("chosen", card.dataset.robot === id);
    const card = this.cards_.get(id);
    if (!card) return;
    card.node.open = true;
    card.node.scrollIntoView({block: "nearest"});
  }

  make_card_(robot) {
    const card = {
      badge: element("span", {class: "badge"}),
      age: element("span", {class: "age", title: "age of the newest data"}),
      flags: element("span", {class: "flags"}),
      note: element("p", {class: "note", hidden: true}),
      joints: element("div", {class: "joints", role: "list"}),
      online: element("button", {type: "button", class: "small"}),
      stop: element("button", {type: "button", class: "small"}, "Stop"),
      charts: element("button", {type: "button", class: "small"}, "Chart"),
      activate: element("button", {type: "button", class: "small"}, "Activate"),
    };
    card.activate.addEventListener("click", () => this.command_(`ROBACT ${robot.id}`));
    card.charts.addEventListener("click", () => this.select_(robot.id));
    card.stop.addEventListener("click", () => this.command_(`STOP_ROB ${robot.id}`));
    card.online.addEventListener("click", () => this.switch_(robot.id, card.online.dataset.to));
    const tools = element("div", {class: "tools"}, card.charts, card.activate, card.stop, card.online);
    card.node = element("details", {class: "robot", open: !this.narrow_, "data-robot": robot.id},
      element("summary", {}, element("span", {class: "name"}, robot.id), card.flags, card.age, card.badge),
      card.note, card.joints, tools);
    card.node.classList.toggle("chosen", robot.id === this.chosen_);
    card.rows = new KeyedRows(card.joints, make_joint, update_joint);
    card.names = "";
    this.visibility_.watch(card.node);
    return card;
  }

  // Offline, the mirrored robot stands still whatever the real one does: nobody should do that by a slip.
  async switch_(id, to) {
    if (to === "offline" && !(await confirmed(`Take ${id} offline?`,
      "The mirrored robot then no longer follows the real one: collisions and distances are those of where it stands.", "Take offline"))) return;
    this.command_(`ROBOT ${id} ${to}`);
  }

  update_card_(card, robot) {
    const state = state_of(robot);
    setAttribute(card.node, "data-state", state);
    setText(card.badge, kStateTexts[state] ?? state);
    setText(card.age, robot.mode === "mirrored" ? age(robot.age_s) : "");
    setText(card.flags, [robot.active ? "active" : "", robot.moving ? "moving" : "", refusals_of(robot)].filter(Boolean).join(", "));
    const note = typeof robot.condition === "string" ? robot.condition : "";
    setText(card.note, note);
    card.note.hidden = note === "" || state === "fresh" || state === "simulated";
    card.online.dataset.to = robot.mode === "mirrored" ? "offline" : "online";
    setText(card.online, robot.mode === "mirrored" ? "Take offline" : "Take online");
    card.online.hidden = robot.mode !== "mirrored" && robot.has_stream === false;
    card.activate.disabled = robot.active === true;
    // A closed or scrolled-away card costs nothing.
    if (card.node.open && this.visibility_.sees(card.node)) this.show_joints_(card, robot.joints ?? []);
  }

  show_joints_(card, joints) {
    card.rows.show(joints, (joint) => joint.name);
    const names = joints.map((joint) => joint.name);
    const text = names.join("\n");
    if (text === card.names) return;
    card.names = text;
    short_labels(names).forEach((label, i) => setText(card.rows.get(names[i]).name, label));
  }
}

// Steps beyond its limits, for which the robot stood.
function refusals_of(robot) {
  const count = robot.refused_setpoints ?? 0;
  return count > 0 ? `${count} ${count === 1 ? "step" : "steps"} refused` : "";
}

function make_joint(joint) {
  const row = {
    value: element("span", {class: "value"}),
    unit: element("span", {class: "unit"}, shown_unit(joint_unit(joint))),
    mark: element("span", {class: "mark"}),
    name: element("span", {class: "name", title: joint.name}, joint.name),
  };
  row.bar = element("span", {class: "bar"}, row.mark);
  row.node = element("div", {class: "joint", role: "listitem"},
    row.name, row.bar, row.value, row.unit);
  return row;
}

function update_joint(row, joint) {
  const unit = joint_unit(joint);
  setText(row.value, joint_value(joint.position, unit));
  if (row.state !== joint.state) {
    row.state = joint.state;
    setAttribute(row.node, "data-state", joint.state ?? "none");
  }
  const place = place_in_range(joint.position, joint.lower, joint.upper);
  const key = place === null ? -1 : Math.round(place * 1000);
  if (row.key === key) return;
  const first = row.key === undefined;
  row.key = key;
  const look = place === null ? "bar without" : place < 0.03 || place > 0.97 ? "bar near-end" : "bar";
  if (row.look !== look) row.bar.className = row.look = look;
  if (place !== null) row.mark.style.transform = `translateX(${key / 10 - 100}%)`;
  if (first && place !== null) {
    const ends = [joint.lower, joint.upper].map((end) => number(scaled(end, unit), 1));
    setAttribute(row.bar, "title", `${ends[0]} to ${ends[1]} ${shown_unit(unit)}`);
  }
}
