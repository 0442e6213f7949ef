// Messages of hot_message: over the picture while they are new, and in a list that stays.
import {byId, element, setText} from "./dom.js";
import {clock_time} from "./format.js";
import {ring} from "./bell.js";

const kShown_s = 5;  // as the manual has it
const kMostKept = 100;

export class Messages {
  constructor({unread}) {
    this.unread_ = unread;
    this.last_ = 0;
    this.run_ = null;
    this.uptime_s_ = 0;
    this.unread_count_ = 0;
    this.until_ = 0;
  }

  // Which run of the gateway the next messages are of: another one counts from the beginning.
  of_run(run) {
    if (run !== undefined && run !== this.run_) this.last_ = 0;
    this.run_ = run ?? this.run_;
  }

  read() {
    this.unread_count_ = 0;
    this.unread_(0);
  }

  update(live) {
    const messages = live.messages ?? [];
    const highest = messages.reduce((most, message) => Math.max(most, message.number), 0);
    // Also where a gateway does not say which run it is.
    if (live.uptime_s < this.uptime_s_ || highest < this.last_) this.last_ = 0;
    this.uptime_s_ = live.uptime_s ?? 0;
    const fresh = messages.filter((message) => message.number > this.last_);
    if (highest > this.last_) this.last_ = highest;
    for (const message of fresh) this.take_(message);
    const newest = fresh.filter((message) => message.age_s < kShown_s).pop();
    if (newest) {
      setText(byId("hot-message"), newest.text);
      byId("hot-message").hidden = false;
      this.until_ = performance.now() + (kShown_s - newest.age_s) * 1000;
      if (newest.bell ?? live.bell) ring();
    } else if (this.until_ && performance.now() > this.until_) {
      byId("hot-message").hidden = true;
      this.until_ = 0;
    }
  }

  take_(message) {
    const list = byId("message-list");
    const when = new Date(Date.now() - (message.age_s ?? 0) * 1000);
    list.prepend(element("li", {}, element("time", {}, clock_time(when)), element("span", {}, message.text)));
    while (list.children.length > kMostKept) list.lastElementChild.remove();
    byId("no-messages").hidden = true;
    this.unread_(++this.unread_count_);
  }
}
