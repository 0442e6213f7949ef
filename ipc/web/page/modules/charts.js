// Which charts there are and what they show. All values are recorded as they come; drawn is what can be seen, as much
// as fits into a small part of an update, in turns.
import {byId, element, setText, Visibility} from "./dom.js";
import {joint_unit, norm, scaled, shown_unit} from "./format.js";
import {History} from "./history.js";
import {StripChart} from "./strip_chart.js";

const kBudget_ms = 1.5;
const kMostDrawn = 2;
const kGap_s = 2;
const kMostCurves = 6;

const kQuantities = {
  position: {prefix: "q", unit: (unit) => unit},
  velocity: {prefix: "v", unit: (unit) => `${unit}/s`},
  effort: {prefix: "e", unit: null},
};

export function record(history, live) {
  history.add(live.time_s ?? 0, (put) => {
    for (const robot of live.robots ?? []) {
      for (const joint of robot.joints ?? []) {
        put(`q|${robot.id}|${joint.name}`, joint.position);
        put(`v|${robot.id}|${joint.name}`, joint.velocity);
      }
    }
    for (const pair of live.near ?? []) put(`near|${pair.a} – ${pair.b}`, pair.distance_m);
    for (const pair of live.touching ?? []) put(`near|${pair.a} – ${pair.b}`, 0);
    for (const range of live.ranges ?? []) put(`range|${range.id}`, range.distance_m);
    for (const force of live.forces ?? []) {
      put(`tcp|${force.robot}`, norm(force.tcp_force_n));
      for (const joint of force.joints ?? []) put(`e|${force.robot}|${joint.name}`, joint.effort);
    }
    put("loop|wake-up p99", live.loop?.latency_p99_us);
    put("loop|tick p99", live.loop?.compute_p99_us);
  });
}

const kShortPairs = new Map();

function short_pair(label) {
  if (kShortPairs.size > 1000) kShortPairs.clear();
  if (!kShortPairs.has(label)) {
    kShortPairs.set(label, label.split(" – ").map((path) => path.split(".").slice(-2).join(".")).join(" – "));
  }
  return kShortPairs.get(label);
}

export class Charts {
  constructor() {
    this.history_ = new History();
    this.robot_ = null;
    this.paused_ = false;
    this.turn_ = 0;
    this.nearest_ = [];
    const parent = byId("chart-list");
    this.charts_ = [
      {chart: new StripChart(parent, {title: "Joints", digits: 1}), show: (chart) => this.show_joints_(chart)},
      {chart: new StripChart(parent, {title: "Distances", digits: 0}), show: (chart) => this.show_nearest_(chart)},
      {chart: new StripChart(parent, {title: "Ranges", digits: 0}), show: (chart) => this.show_all_(chart, "range|", "mm", 1000)},
      {chart: new StripChart(parent, {title: "Forces at the TCP", digits: 1}), show: (chart) => this.show_all_(chart, "tcp|", "N", 1)},
      {chart: new StripChart(parent, {title: "Loop", digits: 0}), show: (chart) => this.show_all_(chart, "loop|", "µs", 1)},
    ];
    this.visibility_ = new Visibility();
    for (const {chart} of this.charts_) this.visibility_.watch(chart.node);
    this.robot_choice_ = byId("chart-robot");
    this.robot_choice_.addEventListener("change", () => this.select(this.robot_choice_.value));
    byId("chart-pause").addEventListener("click", (event) => {
      this.paused_ = !this.paused_;
      event.currentTarget.setAttribute("aria-pressed", String(this.paused_));
      setText(event.currentTarget, this.paused_ ? "Go on" : "Pause");
    });
    for (const id of ["chart-quantity", "chart-span"]) byId(id).addEventListener("change", () => this.draw_all_());
  }

  record(live) {
    const time = live.time_s ?? 0;
    const passed = time - (this.last_time_ ?? -Infinity);
    if (passed < -1) this.history_.clear();  // the clock was set back
    else if (passed <= 0) return;
    else if (passed > kGap_s) this.history_.add(time - 0.001, () => {});  // curves do not bridge what nobody saw
    this.last_time_ = time;
    record(this.history_, live);
    this.robots_ = live.robots ?? [];
  }

  select(robot) {
    this.robot_ = robot;
    this.robot_choice_.value = robot;
    this.draw_all_();
  }

  restyle() {
    for (const {chart} of this.charts_) chart.restyle();
    if (this.robots_) this.draw_all_();
  }

  update() {
    this.offer_robots_();
    if (this.paused_) return;
    const end = performance.now() + kBudget_ms;
    let drawn = 0;
    for (let looked = 0; looked < this.charts_.length && drawn < kMostDrawn; ++looked) {
      const {chart, show} = this.charts_[this.turn_];
      this.turn_ = (this.turn_ + 1) % this.charts_.length;
      if (!this.visibility_.sees(chart.node)) continue;
      show(chart);
      ++drawn;
      if (performance.now() > end) return;
    }
  }

  draw_all_() {
    for (const {chart, show} of this.charts_) show(chart);
  }

  offer_robots_() {
    const ids = this.robots_.map((robot) => robot.id);
    if (ids.join("\n") === this.offered_) return;
    this.offered_ = ids.join("\n");
    this.robot_choice_.replaceChildren(...ids.map((id) => element("option", {value: id}, id)));
    if (!ids.includes(this.robot_)) {
      const better = this.robots_.find((robot) => robot.mode === "mirrored") ?? this.robots_.find((robot) => robot.active);
      this.robot_ = better?.id ?? ids[0] ?? null;
    }
    if (this.robot_) this.robot_choice_.value = this.robot_;
  }

  get span_() {
    return Number(byId("chart-span").value);
  }

  show_joints_(chart) {
    const joints = this.robots_?.find((robot) => robot.id === this.robot_)?.joints ?? [];
    const quantity = kQuantities[byId("chart-quantity").value];
    const units = joints.map(joint_unit);
    const keys = joints.map((joint) => `${quantity.prefix}|${this.robot_}|${joint.name}`);
    const scales = units.map((unit) => (quantity.unit ? scaled(1, quantity.unit(unit)) : 1));
    const unit_texts = units.map((unit) => (quantity.unit ? shown_unit(quantity.unit(unit)) : unit === "m" ? "N" : "Nm"));
    this.show_(chart, joints.map((joint) => joint.name), unit_texts, keys, scales);
  }

  // The pairs that are nearest now.
  show_nearest_(chart) {
    const near = this.history_.keys("near|").map((key) => ({key, value: this.history_.newest(key), seen: this.history_.last_seen(key)}));
    near.sort((a, b) => (a.value ?? Infinity) - (b.value ?? Infinity) || b.seen - a.seen || (a.key < b.key ? -1 : 1));
    // One that was shown keeps its place while it is nearly among the nearest: curves must not come and go.
    const nearly = new Set(near.slice(0, 2 * kMostCurves).filter(({value}) => value !== null).map(({key}) => key));
    const kept = this.nearest_.filter((key) => nearly.has(key));
    const others = near.map(({key}) => key).filter((key) => !kept.includes(key));
    const keys = [...kept, ...others].slice(0, kMostCurves);
    this.nearest_ = keys;
    this.show_(chart, keys.map((key) => short_pair(key.slice(5))), keys.map(() => "mm"), keys, keys.map(() => 1000));
  }

  show_all_(chart, prefix, unit, scale) {
    const keys = this.history_.keys(prefix).filter((key) => prefix !== "tcp|" || this.ever_(key)).slice(0, 2 * kMostCurves);
    this.show_(chart, keys.map((key) => key.slice(prefix.length)), keys.map(() => unit), keys, keys.map(() => scale));
  }

  // Only robots at whose TCP something was ever known.
  ever_(key) {
    this.known_ ??= new Set();
    if (this.history_.newest(key) !== null) this.known_.add(key);
    return this.known_.has(key);
  }

  show_(chart, labels, units, keys, scales) {
    chart.show(labels, units, this.history_.window(keys, this.span_, scales), this.span_);
  }
}
