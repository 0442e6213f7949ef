// Alarms: what needs attention now, who has acknowledged it, and what was. The gateway keeps them, so that all pages show the
// same. Fetched when they have changed and their tab is open; how many there are comes with every live message.
import {byId, element, setText, setAttribute, KeyedRows} from "./dom.js";
import {age, clock_time} from "./format.js";
import {shown_name} from "./user_name.js";

const kAskAgain_ms = 500;
const kMostRows = 100;
const kKinds = {collision: "collision", near: "near", stream: "data", loop: "loop", haptic: "haptics", bleeding: "bleeding", tear: "tissue", limit: "tissue", problem: "gateway"};

// How many nobody has acknowledged, in the head of the page.
export function alarms_in_brief(alarms) {
  const count = alarms?.unacknowledged ?? 0;
  if (count === 0) return null;
  return {text: `${count} alarm${count === 1 ? "" : "s"}`, state: alarms.highest_priority === "high" ? "lost" : "stale"};
}

function time_of(text) {
  const at = new Date(text ?? NaN);
  return Number.isNaN(at.getTime()) ? "" : clock_time(at);
}

function day_and_time(text) {
  const at = new Date(text ?? NaN);
  return Number.isNaN(at.getTime()) ? "" : at.toLocaleString();
}

// "active for 12 s, 3 times since 10:12:00; acknowledged by Ada at 10:12:31"; `now_s`: the gateway's time.
export function state_text(alarm, now_s) {
  const words = [];
  if (alarm.cleared_time) {
    words.push(`over since ${time_of(alarm.cleared_time)}`);
  } else {
    words.push(`active for ${age(Math.max(0, Math.floor(now_s - Date.parse(alarm.time) / 1000)))}`.replace("for 0 ms", "now"));
  }
  if (alarm.occurrences > 1) words.push(`${alarm.occurrences} times since ${time_of(alarm.first_time)}`);
  const acknowledged = alarm.acknowledged_time && `acknowledged by ${shown_name(alarm.acknowledged_by)} at ${time_of(alarm.acknowledged_time)}`;
  return [words.join(", "), acknowledged].filter(Boolean).join("; ");
}

export class Alarms {
  // `command(text)`; `open()`: opens the tab; `fetched(path)`: a document; `name`: UserName.
  constructor({command, open, fetched, name}) {
    this.fetched_ = fetched;
    this.shown_ = null;
    this.asked_ms_ = -Infinity;
    this.now_s_ = 0;
    this.document_ = null;
    const acknowledge = async (id) => {
      const by = await name.asked();
      if (by) command(id === null ? `ALARM_ACK ${by}` : `ALARM_ACK ${by} ${id}`);
    };
    byId("alarm-badge").addEventListener("click", () => open());
    byId("alarm-all").addEventListener("click", () => acknowledge(null));
    this.open_rows_ = new KeyedRows(byId("alarm-list"), (alarm) => make_row(alarm, acknowledge), (row, alarm) => this.update_row_(row, alarm));
    this.history_rows_ = new KeyedRows(byId("alarm-history"), (alarm) => make_row(alarm, null), (row, alarm) => this.update_row_(row, alarm));
  }

  // Of another gateway, or the same one after a restart.
  forget() {
    this.shown_ = null;
  }

  // `quiet`: the gateway sends no data.
  show_quiet(quiet) {
    this.quiet_ = quiet;
    this.show_nothing_();
  }

  show_nothing_() {
    if (this.document_ === null) return;  // the initial text of the page already says so
    for (const [id, said] of [["no-alarms", "Nothing needs attention."], ["no-alarm-history", "No earlier alarms."]]) {
      setText(byId(id), this.quiet_ ? "Not known: no news from the gateway." : said);
      byId(id).classList.toggle("unknown", Boolean(this.quiet_));
    }
  }

  update(live, visible) {
    this.now_s_ = live.time_s ?? Date.now() / 1000;
    this.show_counts_(live.alarms);
    if (!visible || !live.alarms) return;
    this.show_rows_();
    if (live.alarms.revision === this.shown_ || performance.now() - this.asked_ms_ < kAskAgain_ms) return;
    this.asked_ms_ = performance.now();
    this.ask_(live.alarms.revision);
  }

  show_counts_(alarms) {
    const brief = alarms_in_brief(alarms);
    const badge = byId("alarm-badge");
    badge.hidden = brief === null;
    setText(badge, brief?.text ?? "");
    setAttribute(badge, "data-state", brief?.state ?? "none");
    setText(byId("alarm-tab-count"), alarms?.unacknowledged ? String(alarms.unacknowledged) : "");
    byId("alarm-all").disabled = brief === null;
  }

  async ask_(revision) {
    try {
      this.document_ = await this.fetched_("api/alarms");
      this.shown_ = revision;
      this.show_rows_();
    } catch {
      this.shown_ = null;  // the next update asks again
    }
  }

  show_rows_() {
    if (this.document_ === null) return;
    const {open = [], history = [], open_count = open.length, history_count = history.length, not_listed = 0} = this.document_;
    this.open_rows_.show(open.slice(0, kMostRows), (alarm) => alarm.id);
    this.history_rows_.show(history.slice(0, kMostRows), (alarm) => alarm.id);
    byId("no-alarms").hidden = open.length > 0;
    byId("no-alarm-history").hidden = history.length > 0;
    this.show_nothing_();
    const cut = (all) => (all > kMostRows ? `the newest ${kMostRows} of ${all}` : "");
    setText(byId("alarm-note"), [cut(open_count), not_listed ? `${not_listed} more have no place in the list` : ""].filter(Boolean).join("; "));
    setText(byId("alarm-history-note"), cut(history_count));
  }

  update_row_(row, alarm) {
    setAttribute(row.node, "data-state", alarm.state);
    setAttribute(row.node, "data-priority", alarm.priority);
    setText(row.time, time_of(alarm.time));
    setAttribute(row.time, "datetime", alarm.time);
    setAttribute(row.time, "title", day_and_time(alarm.time));
    setText(row.text, alarm.text);
    setText(row.priority, alarm.priority);
    setText(row.kind, kKinds[alarm.kind] ?? alarm.kind);
    setText(row.more, state_text(alarm, this.now_s_));
    if (row.button) row.button.hidden = alarm.state === "active_acknowledged";
  }
}

function make_row(alarm, acknowledge) {
  const row = {
    time: element("time"), text: element("span", {class: "text"}), priority: element("span", {class: "priority", title: "priority"}),
    kind: element("span", {class: "soft"}), more: element("span", {class: "more"}), button: null,
  };
  const buttons = [];
  if (acknowledge) {
    row.button = element("button", {type: "button", class: "small", "aria-label": `Acknowledge: ${alarm.text}`, title: "ALARM_ACK: you have seen it; others see your name"}, "Acknowledge");
    row.button.addEventListener("click", () => acknowledge(alarm.id));
    buttons.push(element("span", {class: "commands"}, row.button));
  }
  row.node = element("li", {class: "alarm", "data-alarm": alarm.id}, row.time, row.priority, row.kind, row.text, ...buttons, row.more);
  return row;
}
