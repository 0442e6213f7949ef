// Whether the gateway is there, who may command, and what to do where it is gone.
import {byId, setText, setAttribute} from "./dom.js";
import {age, clock_time} from "./format.js";
import {keep_token} from "./token.js";

const kQuiet_s = 2;
const kLastKnown_s = 3;  // after so long nothing but the picture is shown as current

// What shows and starts a gateway by its name. The package runs one service a cell, with the cell's name; the one without a name
// was started by hand.
export function commands_of(instance) {
  if (!instance || instance === "default") return {status: "cellmirror status", start: "cellmirror run"};
  return {status: `cellmirror status --instance ${instance}`, start: `systemctl start cellmirror@${instance}`};
}

export class Presence {
  // `quiet(whether)`: all but the picture is what was last known, or no longer.
  constructor(connection, {quiet = () => {}, fetch = (...what) => window.fetch(...what)} = {}) {
    this.fetch_ = fetch;
    this.connection_ = connection;
    this.show_quiet_ = quiet;
    this.quiet_ = false;
    this.may_command = false;
    this.read_only = false;
    this.token_shown_ = false;
    this.heard_ = null;
    this.retry_at_ = null;
    connection.on("opened", () => this.back_());
    connection.on("closed", ({retry_s}) => this.gone_(retry_s));
    connection.on("welcome", (message) => this.welcome_(message));
    connection.on("refused", ({text}) => /token/.test(text) && this.token_refused_(text));
    byId("gone-now").addEventListener("click", () => connection.start());
    byId("token-form").addEventListener("submit", (event) => this.token_given_(event));
    byId("token-button").addEventListener("click", () => this.open_dialog_());
    byId("token-cancel").addEventListener("click", () => byId("token-dialog").close());
    setInterval(() => this.tick_(), 250);
  }

  why_not() {
    if (!this.connection_.open) return "no connection to the gateway: nothing was sent";
    if (this.read_only) return "this gateway is read-only: the page cannot send commands (--read-only, or read_only in [web] of the cell file)";
    return "this page can only view. To send commands, open the address that `cellmirror page` prints, or enter its token (key button above)";
  }

  live(live) {
    this.heard_ = performance.now();
    this.heard_at_ = new Date();
    this.replay_ = Boolean(live.replay);
    if (this.quiet_) this.show_line_();
    setText(byId("cell-name"), live.cell ?? "");
    document.title = live.cell ? `${live.cell} – cellmirror` : "cellmirror";
  }

  welcome_(message) {
    this.may_command = message.may_command === true;
    this.read_only = message.read_only === true;
    if (this.version_ && message.version && message.version !== this.version_) byId("new-version").hidden = false;
    this.version_ ??= message.version;
    setText(byId("version"), message.version ? `cellmirror ${message.version}` : "");
    const {status, start} = commands_of(message.instance);
    setText(byId("gone-status"), status);
    setText(byId("gone-start"), start);
    document.documentElement.classList.toggle("looking-only", !this.may_command);
    this.show_right_();
  }

  // A refused token is dropped: the gateway closes the connection after repeated wrong ones.
  token_refused_(text) {
    keep_token("");
    this.token_problem_ = text;
    if (this.token_shown_) this.open_dialog_();
  }

  show_right_() {
    const text = this.may_command ? "may command" : this.read_only ? "read-only" : "looking only";
    setText(byId("right-text"), text);
    setAttribute(byId("token-button"), "data-state", this.may_command ? "fresh" : "none");
    byId("token-button").disabled = this.read_only;
    setAttribute(byId("token-button"), "title", this.may_command ? "This page may command the gateway." : `In short: ${this.why_not()}`);
  }

  open_dialog_() {
    setText(byId("token-note"), this.may_command ? "" : this.token_problem_ ?? "");
    if (!byId("token-dialog").open) byId("token-dialog").showModal();
  }

  token_given_(event) {
    event.preventDefault();
    // What is pasted may be the whole address.
    const given = byId("token-input").value.trim().replace(/^.*#token=/, "");
    keep_token(given);
    this.token_shown_ = given !== "";
    this.token_problem_ = null;
    byId("token-input").value = "";
    byId("token-dialog").close();
    this.connection_.hello();
  }

  back_() {
    this.retry_at_ = null;
    this.was_open_ = true;
    byId("gone").hidden = true;
    document.documentElement.classList.remove("gateway-gone");
    this.show_line_();
  }

  gone_(retry_s) {
    this.retry_at_ = performance.now() + retry_s * 1000;
    this.may_command = false;
    if (!document.documentElement.classList.contains("gateway-gone")) {
      setText(byId("gone-since"), this.heard_ === null ? "" : `What the page shows is as of ${clock_time(this.heard_at_)}.`);
    }
    document.documentElement.classList.add("gateway-gone");
    byId("gone").hidden = false;
    // The first retry follows a lost connection; only a connection that was refused has another cause.
    if (this.was_open_) this.show_why_("gone");
    else this.ask_why_();
    if (this.why_ === undefined) this.show_why_("unknown");
    this.was_open_ = false;
    this.tick_();
  }

  // Browsers do not report why a WebSocket was refused. A healthy gateway refuses it only if it has no room for another
  // page; a proxy in front of a gateway that is gone does not answer with 200.
  async ask_why_() {
    let answers = false;
    try {
      answers = (await this.fetch_("healthz", {cache: "no-store"})).status === 200;
    } catch {
      answers = false;
    }
    if (this.connection_.open) return;
    if (answers) this.show_why_("full");
    else if (this.why_ === "full") this.show_why_("gone");
    this.show_line_();
  }

  show_why_(why) {
    const titles = {gone: "The gateway is gone.", full: "The gateway accepts no further page.", unknown: "There is no connection to the gateway."};
    setText(byId("gone-title"), titles[why]);
    byId("gone-full").hidden = why !== "full";
    byId("gone-help").hidden = why === "full";
    this.why_ = why;
  }

  tick_() {
    if (this.retry_at_ !== null) {
      const left = Math.max(0, Math.ceil((this.retry_at_ - performance.now()) / 1000));
      setText(byId("gone-retry"), left > 0 ? `Trying again in ${left} s.` : "Trying again now.");
    }
    this.show_line_();
  }

  show_line_() {
    // Pictures do not count: they come from another part of the gateway, which may continue alone.
    const silent = this.heard_ === null ? null : (performance.now() - this.heard_) / 1000;
    this.be_quiet_(silent !== null && (!this.connection_.open || silent > kLastKnown_s));
    let [text, state] = this.replay_ ? ["replay, not live", "replay"] : ["live", "fresh"];
    document.documentElement.classList.toggle("replay", Boolean(this.replay_));
    const without = this.why_ === "full" ? "too many pages" : this.heard_ === null ? "no connection" : "gateway gone";
    if (!this.connection_.open) [text, state] = [this.retry_at_ === null ? "connecting" : without, "lost"];
    else if (silent === null) [text, state] = ["connecting", "none"];
    else if (silent > kQuiet_s) [text, state] = [`no news for ${age(silent)}`, "stale"];
    setText(byId("line-text"), text);
    setAttribute(byId("line-badge"), "data-state", state);
  }

  be_quiet_(quiet) {
    if (quiet === this.quiet_) return;
    this.quiet_ = quiet;
    document.documentElement.classList.toggle("last-known", quiet);
    this.show_quiet_(quiet);
  }
}
