// What touches, what is near, what sensors read, which forces act.
import {byId, element, setText, setAttribute, KeyedRows} from "./dom.js";
import {age, length, norm, number} from "./format.js";
import {place_in_range} from "./robots.js";

const kMostRows = 40;

const pair_key = (pair) => `${pair.a}\n${pair.b}`;
const warned_of = (pair, limit_m) => pair.within_warning ?? pair.distance_m <= (limit_m ?? 0);
const last_part = (path) => String(path ?? "").split(".").slice(-2).join(".");

function pair_row() {
  const row = {a: element("span", {class: "end"}), b: element("span", {class: "end"}), value: element("span", {class: "value"}),
    more: element("span", {class: "more"})};
  row.node = element("li", {class: "pair"}, element("span", {class: "ends"}, row.a, row.b), row.value, row.more);
  return row;
}

function show_ends(row, pair) {
  setText(row.a, last_part(pair.a));
  setText(row.b, last_part(pair.b));
  setAttribute(row.a, "title", pair.a);
  setAttribute(row.b, "title", pair.b);
}

const kOld_s = 0.5;

// What the head says of collisions. Nobody knows what touches where nothing is tested, and what is old is said.
export function collisions_in_brief(live) {
  if (!Array.isArray(live.touching)) return {text: "collisions not known", state: "none", title: null};
  const touching = live.touching_count ?? live.touching.length;
  const text = touching ? `${touching} touching` : "nothing touches";
  if (live.collision_age_s > kOld_s) {
    return {text: `${text} (old)`, state: "stale", title: `found ${age(live.collision_age_s)} ago`};
  }
  return {text, state: touching ? "lost" : "fresh", title: null};
}

export class Findings {
  constructor({show_node}) {
    const opened = (event) => {
      const end = event.target.closest?.(".end");
      if (end) show_node(end.title);
    };
    for (const id of ["touching-list", "near-list"]) byId(id).addEventListener("click", opened);
    this.touching_ = new KeyedRows(byId("touching-list"), pair_row, (row, pair) => {
      show_ends(row, pair);
      setText(row.value, `${length(pair.depth_m)} deep`);
    });
    this.near_ = new KeyedRows(byId("near-list"), pair_row, (row, pair) => {
      show_ends(row, pair);
      setText(row.value, length(pair.distance_m));
      setText(row.more, Number.isFinite(pair.time_to_contact_s) ? `contact in ${age(pair.time_to_contact_s)}` : "");
      row.node.classList.toggle("warning", warned_of(pair, this.warning_m_));
    });
    this.ranges_ = new KeyedRows(byId("range-list"), range_row, update_range);
    this.forces_ = new KeyedRows(byId("force-list"), force_row, update_force);
  }

  update(live, visible) {
    const touching = live.touching ?? [];
    const near = live.near ?? [];
    this.warning_m_ = live.warning_distance_m;
    this.tell_counts_(live.touching_count ?? touching.length, near.length, live);
    if (!visible) return;
    this.touching_.show(touching.slice(0, kMostRows), pair_key);
    this.near_.show(near.slice(0, kMostRows), pair_key);
    this.ranges_.show((live.ranges ?? []).slice(0, kMostRows), (range) => range.id);
    this.forces_.show((live.forces ?? []).slice(0, kMostRows), (force) => force.robot);
    byId("no-touching").hidden = touching.length > 0;
    setText(byId("no-touching"), live.touching ? "Nothing touches." : "Not known: nothing is tested.");
    byId("no-near").hidden = near.length > 0;
    setText(byId("no-near"), live.touching ? "Nothing is near." : "Not known: nothing is tested.");
    byId("range-part").hidden = (live.ranges ?? []).length === 0;
    byId("force-part").hidden = (live.forces ?? []).length === 0;
    const warning = Number.isFinite(this.warning_m_) ? `nearest first; warning below ${length(this.warning_m_)}` : "nearest first";
    setText(byId("near-note"), near.length > kMostRows ? `${warning}; the first ${kMostRows} of ${live.near_count ?? near.length}` : warning);
  }

  tell_counts_(touching, near, live) {
    const badge = byId("touching-badge");
    const brief = collisions_in_brief(live);
    setText(badge, brief.text);
    setAttribute(badge, "data-state", brief.state);
    setAttribute(badge, "title", brief.title);
    const warned = (live.near ?? []).filter((pair) => warned_of(pair, live.warning_distance_m)).length;
    const near_badge = byId("near-badge");
    setText(near_badge, `${warned} near`);
    near_badge.hidden = warned === 0;
    setText(byId("near-tab-count"), touching + near ? String(touching + near) : "");
  }
}

function range_row(range) {
  const row = {value: element("span", {class: "value"}), object: element("span", {class: "more"}), mark: element("span", {class: "mark"})};
  row.node = element("li", {class: "range"}, element("span", {class: "name"}, range.id),
    element("span", {class: "bar"}, row.mark), row.value, row.object);
  return row;
}

function update_range(row, range) {
  const known = Number.isFinite(range.distance_m);
  setText(row.value, known ? length(range.distance_m) : "no echo");
  setText(row.object, known && range.object ? last_part(range.object) : "");
  const place = known ? place_in_range(range.distance_m, 0, range.range_m) : 0;
  row.mark.style.setProperty("transform", `translateX(${((place ?? 0) * 100 - 100).toFixed(1)}%)`);
}

function force_row(force) {
  const row = {value: element("span", {class: "value"}), joints: element("span", {class: "efforts"})};
  row.node = element("li", {class: "force"}, element("span", {class: "name"}, force.robot), row.value, row.joints);
  return row;
}

function update_force(row, force) {
  const newtons = norm(force.tcp_force_n);
  setText(row.value, newtons === null ? "" : `${number(newtons, 1)} N at the TCP`);
  const joints = force.joints ?? [];
  const efforts = joints.map((joint) => `${joint.name}\u00a0${number(joint.effort, 1)}`).join("   ");
  const beyond = joints.filter((joint) => joint.beyond_limit).map((joint) => joint.name);
  setText(row.joints, beyond.length ? `${efforts}   beyond the limit: ${beyond.join(", ")}` : efforts);
  row.node.classList.toggle("warning", beyond.length > 0);
}
