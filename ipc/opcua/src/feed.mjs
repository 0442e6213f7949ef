// Asks one gateway for its status again and again, and reports what it answers, when it is late, and when it is gone.
import {setTimeout as wait} from "node:timers/promises";

import {cell_image} from "./cell_image.mjs";
import {ask} from "./control_request.mjs";
import {control_socket} from "./control_socket.mjs";
import {in_words} from "./refusal.mjs";

const kLongestAnswer_ms = 5000;
const kLate_ms = 500; // without an answer, besides three periods
const kFirstPause_ms = 250;
const kLongestPause_ms = 5000;

export class Feed {
  // `cell`: a CellNodes. `say(line)`: for the log; called on changes only. `limits` are for tests.
  constructor({instance, period_ms, cell, say, limits = {}}) {
    Object.assign(this, {instance, period_ms, cell, say});
    this.longest_answer_ms_ = limits.longest_answer_ms ?? kLongestAnswer_ms;
    this.first_pause_ms_ = limits.first_pause_ms ?? kFirstPause_ms;
    this.longest_pause_ms_ = limits.longest_pause_ms ?? kLongestPause_ms;
    this.ended_ = new AbortController();
    this.trouble_ = "";
    this.left_out_ = 0;
    this.answers = 0;
  }

  // Until end() is called.
  async run() {
    let pause_ms = this.first_pause_ms_;
    while (!this.ended_.signal.aborted) {
      const started_ms = performance.now();
      const answered = await this.once_();
      const left_ms = answered ? Math.max(0, started_ms + this.period_ms - performance.now()) : pause_ms;
      pause_ms = answered ? this.first_pause_ms_ : Math.min(2 * pause_ms, this.longest_pause_ms_);
      await wait(left_ms, undefined, {signal: this.ended_.signal}).catch(() => {});
    }
  }

  end() {
    this.ended_.abort();
  }

  async once_() {
    const late = setTimeout(() => this.cell.report_late(), kLate_ms + 3 * this.period_ms);
    try {
      const place = await control_socket(this.instance);
      const asked_ms = Date.now();
      const image = cell_image(await ask(place, {request: "status"}, {timeout_ms: this.longest_answer_ms_}));
      if (this.ended_.signal.aborted) return true;
      this.cell.report(image, asked_ms);
      this.answers++;
      this.note_(image);
      return true;
    } catch (error) {
      if (!this.ended_.signal.aborted) this.gone_(error);
      return false;
    } finally {
      clearTimeout(late);
    }
  }

  note_(image) {
    if (this.trouble_ !== "" || this.answers === 1) this.say(`the gateway ${this.instance} answers: ${image.robots.length} robots`);
    if (image.left_out !== this.left_out_) this.say(`the gateway ${this.instance}: ${image.left_out} robots or joints are left out (no or the same name, unknown unit, too many)`);
    this.left_out_ = image.left_out;
    this.trouble_ = "";
  }

  gone_(error) {
    this.cell.report_gone(Date.now());
    const trouble = in_words(error);
    if (trouble !== this.trouble_) this.say(`the gateway ${this.instance} is not shown: ${trouble}`);
    this.trouble_ = trouble;
  }
}
