// The SCRIPT console: completion, history, help, and what became of every command, also of those that buttons sent.
import {byId, element, setText} from "./dom.js";
import {completed, completions, help_for} from "./completion.js";
import {clock_time} from "./format.js";

const kMostEntries = 200;
const kAtTheEnd_px = 24;
const kMostRemembered = 100;
const kHistoryKey = "cellmirror.history";

function remembered() {
  try {
    const kept = JSON.parse(sessionStorage.getItem(kHistoryKey) ?? "[]");
    return Array.isArray(kept) ? kept.filter((line) => typeof line === "string") : [];
  } catch {
    return [];
  }
}

export class Console {
  constructor(connection, {may_command, why_not}) {
    this.connection_ = connection;
    this.may_command_ = may_command;
    this.why_not_ = why_not;
    this.input_ = byId("console-input");
    this.list_ = byId("console-choices");
    this.log_ = byId("console-log");
    this.commands_ = [];
    this.names_ = {};
    this.history_ = remembered();
    this.at_ = this.history_.length;
    this.choices_ = [];
    this.chosen_ = -1;
    this.input_.addEventListener("input", () => this.offer_());
    this.input_.addEventListener("click", () => this.explain_());
    this.input_.addEventListener("blur", () => setTimeout(() => this.close_(), 150));
    this.input_.addEventListener("keydown", (event) => this.key_(event));
    byId("console-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.submit_();
    });
  }

  know_commands(commands) {
    this.commands_ = commands;
  }

  know_names(names) {
    this.names_ = names;
  }

  // Executes a command and logs its result. While the user has scrolled up, the log stays there, unless
  // the command was typed.
  async run(text, {typed = false} = {}) {
    const entry = this.write_(text, typed);
    if (!this.may_command_()) {
      this.answer_(entry, false, this.why_not_());
      return false;
    }
    const reply = await this.connection_.ask({do: "command", text});
    this.answer_(entry, reply.done === true, reply.text ?? "");
    return reply.done === true;
  }

  // What `change` adds stays in sight where the end of the log was.
  keep_end_(change, always = false) {
    const log = this.log_;
    const follow = always || log.scrollHeight - log.scrollTop - log.clientHeight < kAtTheEnd_px;
    change();
    if (follow) log.scrollTop = log.scrollHeight;
  }

  write_(text, typed) {
    const answer = element("span", {class: "answer waiting"}, "…");
    const entry = element("li", {}, element("time", {}, clock_time()), element("code", {}, text), answer);
    this.keep_end_(() => {
      this.log_.append(entry);
      byId("no-commands").hidden = true;
      while (this.log_.children.length > kMostEntries) this.log_.firstElementChild.remove();
    }, typed);
    return {entry, answer};
  }

  answer_({entry, answer}, done, text) {
    this.keep_end_(() => {
      answer.className = done ? "answer done" : "answer refused";
      setText(answer, done ? (text ? `done: ${text}` : "done") : `refused: ${text || "no reason was given"}`);
      entry.classList.toggle("refused", !done);
    });
  }

  submit_() {
    const text = this.input_.value.trim().replace(/;\s*$/, "");
    if (!text) return;
    if (this.history_[this.history_.length - 1] !== text) this.history_.push(text);
    this.history_ = this.history_.slice(-kMostRemembered);
    this.at_ = this.history_.length;
    try {
      sessionStorage.setItem(kHistoryKey, JSON.stringify(this.history_));
    } catch {
      // Then the history lasts as long as the page.
    }
    this.input_.value = "";
    this.close_();
    this.explain_();
    this.run(text, {typed: true});
  }

  key_(event) {
    const open = !this.list_.hidden;
    const step = {ArrowDown: 1, ArrowUp: -1}[event.key];
    if (event.key === "Tab" && !event.shiftKey && open) this.take_(Math.max(0, this.chosen_));
    else if (event.key === "Enter" && open && this.chosen_ >= 0) this.take_(this.chosen_);
    else if (event.key === "Escape" && open) this.close_();
    else if (event.key === " " && event.ctrlKey) this.offer_(true);
    else if (step && open && (this.chosen_ >= 0 || step > 0)) this.choose_(this.chosen_ + step);
    else if (step) this.recall_(step);
    else return;
    event.preventDefault();
  }

  recall_(step) {
    const at = Math.max(0, Math.min(this.history_.length, this.at_ + step));
    if (at === this.history_.length && this.at_ === at) return;
    this.at_ = at;
    this.input_.value = this.history_[at] ?? "";
    this.input_.setSelectionRange(this.input_.value.length, this.input_.value.length);
    this.close_();
    this.explain_();
  }

  offer_(also_empty = false) {
    this.explain_();
    const text = this.input_.value;
    const cursor = this.input_.selectionStart ?? text.length;
    this.choices_ = text.trim() || also_empty ? completions(text, cursor, this.commands_, this.names_) : [];
    this.list_.replaceChildren(...this.choices_.map(({text: choice, note}, i) => {
      const row = element("li", {role: "option", id: `console-choice-${i}`, "aria-selected": "false"},
        element("code", {}, choice), element("span", {}, note));
      row.addEventListener("pointerdown", (event) => {
        event.preventDefault();  // the input keeps the focus
        this.take_(i);
      });
      return row;
    }));
    this.list_.hidden = this.choices_.length === 0;
    this.input_.setAttribute("aria-expanded", String(this.choices_.length > 0));
    this.choose_(-1);
  }

  choose_(i) {
    const count = this.choices_.length;
    this.chosen_ = count && i >= 0 ? (i + count) % count : -1;
    [...this.list_.children].forEach((row, k) => {
      row.setAttribute("aria-selected", String(k === this.chosen_));
      if (k === this.chosen_) row.scrollIntoView({block: "nearest"});
    });
    if (this.chosen_ >= 0) this.input_.setAttribute("aria-activedescendant", `console-choice-${this.chosen_}`);
    else this.input_.removeAttribute("aria-activedescendant");
  }

  take_(i) {
    const next = completed(this.input_.value, this.input_.selectionStart ?? 0, this.choices_[i].text);
    this.input_.value = next.text;
    this.input_.setSelectionRange(next.cursor, next.cursor);
    this.input_.focus();
    this.offer_();
  }

  close_() {
    this.list_.hidden = true;
    this.input_.setAttribute("aria-expanded", "false");
    this.chosen_ = -1;
  }

  explain_() {
    const line = byId("console-help");
    const help = help_for(this.input_.value, this.input_.selectionStart ?? 0, this.commands_);
    if (!help) {
      line.replaceChildren("Tab completes, arrow keys bring back earlier commands.");
      return;
    }
    const syntax = help.parts.flatMap(({text, here}) => [element(here ? "b" : "span", {}, text), " "]);
    line.replaceChildren(element("code", {}, ...syntax), help.help, help.note ? element("span", {class: "note"}, help.note) : "");
  }
}
