// The log of commands: who sent what, and what became of it. Fetched when it has changed and its tab is open.
import {byId, element} from "./dom.js";
import {clock_time} from "./format.js";

const kAskAgain_ms = 1000;

// "process 12 of uid 1000", "page session 3, uid 1000", "scripts/a.spt:12"
export function source_text(entry) {
  if (entry.source === "message") {
    const process = entry.process ? `process ${entry.process}` : "a message";
    return entry.user === undefined ? process : `${process} of uid ${entry.user}`;
  }
  if (entry.source === "page") return [`page session ${entry.session ?? "?"}`, entry.peer].filter(Boolean).join(", ");
  if (entry.source === "mqtt") return ["MQTT", entry.peer].filter(Boolean).join(", ");
  return entry.place ?? entry.source ?? "";
}

export class CommandLog {
  constructor({fetched}) {
    this.fetched_ = fetched;
    this.shown_ = null;
    this.asked_ms_ = -Infinity;
  }

  // Of another gateway, or the same one after a restart.
  forget() {
    this.shown_ = null;
  }

  update(live, visible) {
    const count = live.commands_logged;
    if (!visible || count === undefined || count === this.shown_) return;
    if (performance.now() - this.asked_ms_ < kAskAgain_ms) return;
    this.asked_ms_ = performance.now();
    this.ask_(count);
  }

  async ask_(count) {
    try {
      this.show_(await this.fetched_("api/command-log"));
      this.shown_ = count;
    } catch {
      this.shown_ = null;  // the next update asks again
    }
  }

  show_(log) {
    const entries = (log.last ?? []).filter((entry) => entry && typeof entry === "object");
    byId("command-list").replaceChildren(...entries.reverse().map(row_of));
    byId("no-logged-commands").hidden = entries.length > 0;
  }
}

function row_of(entry) {
  if (entry.dropped) return element("li", {class: "warning"}, `${entry.dropped} commands came too fast to be kept`);
  const refused = entry.outcome === "refused";
  const when = new Date(entry.time);
  return element("li", {class: refused ? "warning" : null},
    element("time", {datetime: entry.time ?? ""}, Number.isNaN(when.getTime()) ? "" : clock_time(when)),
    element("span", {}, element("code", {}, entry.command ?? ""), " ",
      element("span", {class: "soft"}, `${source_text(entry)}: ${refused ? `refused, ${entry.answer ?? ""}` : "done"}`)));
}
