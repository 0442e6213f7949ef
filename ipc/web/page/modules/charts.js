// Which charts there are and what they show. All values are recorded as they come; drawn is what can be seen, as much
// as fits into a small part of an update, in turns.
import {csv_of, picture_of, save} from "./chart_export.js";
import {describe_key} from "./chart_keys.js";
import {ChartSearch} from "./chart_search.js";
import {byId, element, setText, Visibility} from "./dom.js";
import {clock_time, joint_unit, norm, scaled, shown_unit} from "./format.js";
import {History} from "./history.js";
import {short_labels} from "./short_labels.js";
import {StripChart} from "./strip_chart.js";

const kBudget_ms = 1.5;
const kMostDrawn = 2;
const kGap_s = 2;
const kMostCurves = 6;
const kLongest_s = 130;  // as long as is recorded
const kShortestZoom_s = 0.3;
const kSpare = 300;  // places that joints leave to what there is little of

const kQuantities = {
  position: {prefix: "q", unit: (unit) => unit},
  velocity: {prefix: "v", unit: (unit) => `${unit}/s`},
  effort: {prefix: "e", unit: null},
};

const kOld_s = 0.5;

// Records rare values first: in a large cell not all joints get a place.
export function record(history, live) {
  history.add(live.time_s ?? 0, (put) => {
    put("loop|wake-up p99", live.loop?.latency_p99_us);
    put("loop|tick p99", live.loop?.compute_p99_us);
    put("loop|missed periods", live.loop?.missed);
    for (const queue of live.queues ?? []) put(`queue|${queue.name}`, queue.dropped, kSpare);
    // An outdated result ends the curve.
    const tested = !(live.collision_age_s > kOld_s);
    for (const pair of live.near ?? []) put(`near|${pair.a} – ${pair.b}`, tested ? pair.distance_m : null);
    for (const pair of live.touching ?? []) put(`near|${pair.a} – ${pair.b}`, tested ? 0 : null);
    // A doubtful distance is no measurement: something nearer may be there.
    for (const range of live.ranges ?? []) put(`range|${range.id}`, range.doubtful ? null : range.distance_m);
    for (const force of live.forces ?? []) put(`tcp|${force.robot}`, norm(force.tcp_force_n));
    record_joints(put, live);
  });
}

// Returns true if the joint's value is current. A mirrored robot without data has only the last known value: its curve
// ends.
export function is_known(robot, joint) {
  return robot.mode !== "mirrored" || ["fresh", "stale"].includes(joint.state ?? robot.state);
}

function record_joints(put, live) {
  for (const [prefix, quantity] of [["q", "position"], ["v", "velocity"]]) {
    for (const robot of live.robots ?? []) {
      for (const joint of robot.joints ?? [])
        put(`${prefix}|${robot.id}|${joint.name}`, is_known(robot, joint) ? joint[quantity] : null, kSpare);
    }
  }
  for (const force of live.forces ?? []) {
    for (const joint of force.joints ?? []) put(`e|${force.robot}|${joint.name}`, joint.effort, kSpare);
  }
}

// What is not recorded, for people; empty where everything is.
export function left_out_in_words(keys) {
  const kinds = {q: "positions", v: "velocities", e: "efforts", near: "distances", range: "ranges", tcp: "forces", loop: "loop", queue: "queues"};
  const counts = new Map();
  for (const key of keys) {
    const kind = kinds[key.slice(0, key.indexOf("|"))];
    counts.set(kind, (counts.get(kind) ?? 0) + 1);
  }
  const parts = [...counts].map(([kind, count]) => `${count} ${kind}`);
  return parts.length ? `too many curves; not recorded: ${parts.join(", ")}` : "";
}

export class Charts {
  // `names`: ShortNames.
  constructor({names}) {
    this.names_ = names;
    this.history_ = new History();
    this.robot_ = null;
    this.paused_at_ = null;  // time of the gateway's clock, s
    this.quiet_ = false;
    this.turn_ = 0;
    this.nearest_ = [];
    const parent = byId("chart-list");
    this.zoom_ = null;    // [from, to], s
    const zoomed = (range) => this.zoom_to_(range);
    const words_of = (key) => describe_key(key, this.robots_ ?? [], names).text;
    this.search_ = new ChartSearch({keys: () => this.history_.keys(""), words_of, changed: () => this.chosen_changed_()});
    this.charts_ = [
      {chart: new StripChart(parent, {title: "Chosen", digits: 2, zoomed}), show: (chart) => this.show_chosen_(chart)},
      {chart: new StripChart(parent, {title: "Joints", digits: 1, zoomed}), show: (chart) => this.show_joints_(chart)},
      {chart: new StripChart(parent, {title: "Distances", digits: 0, zoomed}), show: (chart) => this.show_nearest_(chart)},
      {chart: new StripChart(parent, {title: "Ranges", digits: 0, zoomed}), show: (chart) => this.show_all_(chart, "range|", "mm", 1000)},
      {chart: new StripChart(parent, {title: "Forces at the TCP", digits: 1, zoomed}), show: (chart) => this.show_all_(chart, "tcp|", "N", 1)},
      {chart: new StripChart(parent, {title: "Loop", digits: 0, zoomed}), show: (chart) => this.show_all_(chart, "loop|", "µs", 1, /p99/)},
    ];
    this.visibility_ = new Visibility();
    for (const {chart} of this.charts_) this.visibility_.watch(chart.node);
    this.robot_choice_ = byId("chart-robot");
    this.robot_choice_.addEventListener("change", () => this.select(this.robot_choice_.value));
    byId("chart-pause").addEventListener("click", () => this.pause_(this.paused_at_ === null));
    byId("chart-unzoom").addEventListener("click", () => this.zoom_to_(null));
    byId("chart-csv").addEventListener("click", () => this.save_table_());
    byId("chart-png").addEventListener("click", () => this.save_picture_());
    this.charts_[0].chart.node.hidden = true;
    for (const id of ["chart-quantity", "chart-span"]) {
      byId(id).addEventListener("change", () => {
        this.draw_all_();
        this.changed_?.();
      });
    }
  }

  // For the address of the page.
  on_change(changed) {
    this.changed_ = changed;
  }

  // As the user chose it; null: not yet.
  get chosen_robot() {
    return this.chosen_robot_ ?? null;
  }

  pause_(wanted) {
    this.paused_at_ = wanted ? this.paused_at_ ?? this.history_.newest_time() : null;
    if (!wanted) this.zoom_ = null;
    const button = byId("chart-pause");
    button.setAttribute("aria-pressed", String(wanted));
    setText(button, wanted ? "Go on" : "Pause");
    byId("chart-unzoom").hidden = this.zoom_ === null;
    this.draw_all_();
  }

  // A part that is looked at does not run away: all charts pause and show it.
  zoom_to_(range) {
    const until = this.paused_at_ ?? this.history_.newest_time();
    this.zoom_ = range && [Math.max(range[0], until - kLongest_s), Math.min(range[1], until)];
    if (this.zoom_ && this.zoom_[1] - this.zoom_[0] < kShortestZoom_s) this.zoom_ = null;
    this.pause_(this.zoom_ !== null || this.paused_at_ !== null);
  }

  // Keys of the chart of one's own.
  get chosen() {
    return this.search_.chosen;
  }

  choose(keys) {
    this.search_.set(keys);
  }

  chosen_changed_() {
    this.charts_[0].chart.node.hidden = this.chosen.length === 0;
    if (this.robots_) this.draw_all_();
    this.changed_?.();
  }

  show_chosen_(chart) {
    const all = this.chosen.map((key) => ({key, ...describe_key(key, this.robots_ ?? [], this.names_)}));
    const texts = all.map(({text}) => text);
    this.show_(chart, short_labels(texts), all.map(({unit}) => unit), all.map(({key}) => key), all.map(({scale}) => scale), texts);
  }

  get shown_charts_() {
    this.draw_all_();
    return this.charts_.map(({chart}) => chart).filter((chart) => !chart.node.hidden);
  }

  save_table_() {
    save(`${file_name()}.csv`, new Blob([csv_of(this.shown_charts_.map((chart) => chart.shown))], {type: "text/csv"}));
  }

  save_picture_() {
    picture_of(this.shown_charts_)?.toBlob((blob) => save(`${file_name()}.png`, blob), "image/png");
  }

  record(live) {
    const time = live.time_s ?? 0;
    const passed = time - (this.last_time_ ?? -Infinity);
    if (passed < -1) this.history_.clear();  // the clock was set back
    else if (passed <= 0) return;
    else if (passed > kGap_s) this.history_.add(time - 0.001, () => {});  // curves do not bridge gaps
    this.last_time_ = time;
    record(this.history_, live);
    this.robots_ = live.robots ?? [];
  }

  // Whether live messages have stopped: the newest value shown is old.
  show_quiet(quiet) {
    if (this.quiet_ === quiet) return;
    this.quiet_ = quiet;
    if (this.robots_) this.draw_all_();
  }

  select(robot) {
    this.robot_ = robot;
    this.chosen_robot_ = robot;
    this.robot_choice_.value = robot;
    if (this.robots_) this.draw_all_();
    this.changed_?.();
  }

  restyle() {
    for (const {chart} of this.charts_) chart.restyle();
    if (this.robots_) this.draw_all_();
  }

  update() {
    this.offer_robots_();
    setText(byId("chart-note"), left_out_in_words(this.history_.left_out()));
    if (this.paused_at_ !== null) return;
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
    const names = joints.map((joint) => joint.name);
    this.show_(chart, short_labels(names), unit_texts, keys, scales, names);
  }

  // The pairs that are nearest now.
  show_nearest_(chart) {
    const keys = this.paused_at_ === null ? this.nearest_keys_() : this.nearest_;
    const ends = keys.map((key) => key.slice(5).split(" – "));
    const labels = ends.map((pair) => pair.map((path) => this.names_.of(path)).join(" – "));
    this.show_(chart, labels, keys.map(() => "mm"), keys, keys.map(() => 1000), ends.map((pair) => pair.join(" – ")));
  }

  nearest_keys_() {
    const near = this.history_.keys("near|").map((key) => ({key, value: this.history_.newest(key), seen: this.history_.last_seen(key)}));
    near.sort((a, b) => (a.value ?? Infinity) - (b.value ?? Infinity) || b.seen - a.seen || (a.key < b.key ? -1 : 1));
    // One that was shown keeps its place while it is nearly among the nearest: curves must not come and go.
    const nearly = new Set(near.slice(0, 2 * kMostCurves).filter(({value}) => value !== null).map(({key}) => key));
    const kept = this.nearest_.filter((key) => nearly.has(key));
    const others = near.map(({key}) => key).filter((key) => !kept.includes(key));
    this.nearest_ = [...kept, ...others].slice(0, kMostCurves);
    return this.nearest_;
  }

  show_all_(chart, prefix, unit, scale, only = /./) {
    const keys = this.history_.keys(prefix).filter((key) => only.test(key)).slice(0, 2 * kMostCurves);
    this.show_(chart, short_labels(keys.map((key) => key.slice(prefix.length))), keys.map(() => unit), keys, keys.map(() => scale));
  }

  show_(chart, labels, units, keys, scales, titles = labels) {
    const until = this.zoom_?.[1] ?? this.paused_at_ ?? this.history_.newest_time();
    const span = this.zoom_ ? this.zoom_[1] - this.zoom_[0] : this.span_;
    const end = this.paused_at_ !== null || this.quiet_ ? clock_time(new Date(until * 1000)) : "now";
    chart.show({labels, titles, units}, this.history_.window(keys, span, scales, until), {span, until, end});
  }
}

function file_name() {
  return `cellmirror-charts-${new Date().toISOString().slice(0, 19).replaceAll(":", "")}`;
}
