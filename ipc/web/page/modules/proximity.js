// What touches, what is near, what sensors read, which forces act.
import {byId, element, setText, setAttribute, KeyedRows} from "./dom.js";
import {age, length, norm, number} from "./format.js";
import {place_in_range} from "./robots.js";

export const kMostRows = 40;

const pair_key = (pair) => `${pair.a}\n${pair.b}`;
const warned_of = (pair, limit_m) => pair.within_warning ?? pair.distance_m <= (limit_m ?? 0);
const end = () => element("button", {type: "button", class: "end"});

function pair_row() {
  const row = {a: end(), b: end(), value: element("span", {class: "value"}), more: element("span", {class: "more"})};
  const ends = element("span", {class: "ends"}, row.a, element("span", {"aria-hidden": "true"}, "–"), row.b);
  row.node = element("li", {class: "pair"}, ends, row.value, row.more);
  return row;
}

// What is beside the head of a list of which only the first are shown.
export function cut_note(shown, all) {
  return all > shown ? `the first ${shown} of ${all}` : "";
}

const kOld_s = 0.5;

const kNoNews = "Not known: no news from the gateway.";

// Text of an empty list of pairs, and true in `known` if the list is really empty. `said`: text for current results;
// `quiet`: the gateway sends no data.
export function nothing_in_words(live, said, quiet = false) {
  if (quiet) return {text: kNoNews, known: false};
  if (!Array.isArray(live.touching)) return {text: "Not known: nothing is tested.", known: false};
  if (live.collision_age_s > kOld_s) return {text: `Not known: the newest result is ${age(live.collision_age_s)} old.`, known: false};
  return {text: said, known: true};
}

// The collisions in the head. Untested and outdated are shown as such.
export function collisions_in_brief(live) {
  if (!Array.isArray(live.touching)) return {text: "collisions not known", state: "none", title: null};
  const touching = live.touching_count ?? live.touching.length;
  const text = touching ? `${touching} touching` : "nothing touches";
  if (live.collision_age_s > kOld_s) {
    return {text: `${text} (old)`, state: "stale", title: `found ${age(live.collision_age_s)} ago`};
  }
  return {text, state: touching ? "lost" : "fresh", title: null};
}

// How many pairs are within the warning distance: also those that the gateway left out of its list.
export function warned_count(live) {
  return live.within_warning_count ?? (live.near ?? []).filter((pair) => warned_of(pair, live.warning_distance_m)).length;
}

export class Proximity {
  // `names`: ShortNames.
  constructor({show_node, names}) {
    const opened = (event) => {
      const pressed = event.target.closest?.(".end");
      if (pressed) show_node(pressed.title);
    };
    for (const id of ["touching-list", "near-list"]) byId(id).addEventListener("click", opened);
    const show_ends = (row, pair) => {
      for (const side of ["a", "b"]) {
        setText(row[side], names.of(pair[side]));
        setAttribute(row[side], "title", pair[side]);
      }
    };
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
    this.ranges_ = new KeyedRows(byId("range-list"), range_row, (row, range) => update_range(row, range, names));
    this.barriers_ = new KeyedRows(byId("barrier-list"), barrier_row, (row, barrier) => update_barrier(row, barrier, names));
    this.forces_ = new KeyedRows(byId("force-list"), force_row, update_force);
  }

  update(live, visible) {
    const touching = live.touching ?? [];
    const near = live.near ?? [];
    this.warning_m_ = live.warning_distance_m;
    this.show_counts_(live);
    if (!visible) return;
    this.touching_.show(touching.slice(0, kMostRows), pair_key);
    this.near_.show(near.slice(0, kMostRows), pair_key);
    this.ranges_.show((live.ranges ?? []).slice(0, kMostRows), (range) => range.id);
    this.barriers_.show((live.light_barriers ?? []).slice(0, kMostRows), (barrier) => barrier.name);
    this.forces_.show((live.forces ?? []).slice(0, kMostRows), (force) => force.robot);
    byId("no-touching").hidden = touching.length > 0;
    byId("no-near").hidden = near.length > 0;
    this.live_ = live;
    this.show_nothing_();
    byId("range-part").hidden = (live.ranges ?? []).length === 0;
    byId("barrier-part").hidden = (live.light_barriers ?? []).length === 0;
    byId("force-part").hidden = (live.forces ?? []).length === 0;
    const warning = Number.isFinite(this.warning_m_) ? `nearest first; warning below ${length(this.warning_m_)}` : "nearest first";
    const shown = (list) => Math.min(kMostRows, list?.length ?? 0);
    const near_cut = cut_note(shown(near), live.near_count ?? near.length);
    setText(byId("near-note"), near_cut ? `${warning}; ${near_cut}` : warning);
    setText(byId("touching-note"), cut_note(shown(touching), live.touching_count ?? touching.length));
    setText(byId("range-note"), cut_note(shown(live.ranges), live.ranges?.length ?? 0));
    setText(byId("barrier-note"), cut_note(shown(live.light_barriers), live.light_barriers?.length ?? 0));
    setText(byId("force-note"), cut_note(shown(live.forces), live.forces?.length ?? 0));
  }

  // `quiet`: the gateway sends no data.
  show_quiet(quiet) {
    this.quiet_ = quiet;
    this.show_nothing_();
  }

  show_nothing_() {
    for (const [id, said] of [["no-touching", "Nothing touches."], ["no-near", "Nothing is near."]]) {
      if (!this.live_) continue;  // the initial text of the page already says so
      const {text, known} = nothing_in_words(this.live_, said, this.quiet_);
      setText(byId(id), text);
      byId(id).classList.toggle("unknown", !known);
    }
  }

  show_counts_(live) {
    const badge = byId("touching-badge");
    const brief = collisions_in_brief(live);
    setText(badge, brief.text);
    setAttribute(badge, "data-state", brief.state);
    setAttribute(badge, "title", brief.title);
    const warned = warned_count(live);
    const near_badge = byId("near-badge");
    setText(near_badge, `${warned} near`);
    near_badge.hidden = warned === 0;
    setText(byId("near-tab-count"), warned ? String(warned) : "");
  }
}

function range_row(range) {
  const row = {value: element("span", {class: "value"}), object: element("span", {class: "more"}), mark: element("span", {class: "mark"})};
  row.node = element("li", {class: "range"}, element("span", {class: "name"}, range.id),
    element("span", {class: "bar"}, row.mark), row.value, row.object);
  return row;
}

// What a reading is worth, and what it hit; `warns` where something nearer may be there, or is.
export function range_in_words(range, names) {
  const known = Number.isFinite(range.distance_m);
  const words = [known && range.object ? names.of(range.object) : ""];
  if (range.doubtful) words.push("doubtful, may be nearer");
  if (known && range.in_blind_zone) words.push("in the blind zone: a real sensor could not measure it");
  return {value: known ? length(range.distance_m) : "no echo", more: words.filter(Boolean).join("; "),
    warns: Boolean(range.doubtful || (known && range.in_blind_zone))};
}

function update_range(row, range, names) {
  const known = Number.isFinite(range.distance_m);
  const {value, more, warns} = range_in_words(range, names);
  setText(row.value, value);
  setText(row.object, more);
  setAttribute(row.object, "title", range.object || null);
  row.node.classList.toggle("warning", warns);
  const place = known ? place_in_range(range.distance_m, 0, range.range_m) : 0;
  row.mark.style.setProperty("transform", `translateX(${((place ?? 0) * 100 - 100).toFixed(1)}%)`);
}

function barrier_row(barrier) {
  const row = {value: element("span", {class: "value"}), more: element("span", {class: "more"})};
  row.node = element("li", {class: "barrier"}, element("span", {class: "name"}, barrier.name), row.value, row.more);
  return row;
}

export function barrier_in_words(barrier, names) {
  const count = barrier.interruptions ?? 0;
  const words = [barrier.object ? names.of(barrier.object) : "", barrier.doubtful ? "doubtful" : "",
    count ? `${count} interruption${count === 1 ? "" : "s"}` : ""];
  return {value: barrier.interrupted ? "interrupted" : "free", more: words.filter(Boolean).join("; ")};
}

function update_barrier(row, barrier, names) {
  const {value, more} = barrier_in_words(barrier, names);
  setText(row.value, value);
  setText(row.more, more);
  setAttribute(row.more, "title", barrier.object || null);
  row.node.classList.toggle("warning", Boolean(barrier.interrupted || barrier.doubtful));
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
