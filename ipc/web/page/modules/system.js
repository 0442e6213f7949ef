// The loop, the queues and what they dropped.
import {byId, element, setText, setAttribute, KeyedRows} from "./dom.js";
import {count, duration, microseconds, number} from "./format.js";

export class System {
  constructor() {
    this.queues_ = new KeyedRows(byId("queue-list"), make_queue, update_queue);
  }

  update(live, visible) {
    const dropped = (live.queues ?? []).reduce((sum, queue) => sum + (queue.dropped ?? 0), 0);
    this.show_loop_(live.loop ?? {});
    setText(byId("uptime"), Number.isFinite(live.uptime_s) ? `up ${duration(live.uptime_s)}` : "");
    if (!visible) return;
    this.queues_.show(live.queues ?? [], (queue) => queue.name);
    setText(byId("drop-total"), dropped ? `${count(dropped)} dropped in all` : "nothing was dropped");
    this.show_facts_(live);
  }

  show_loop_(loop) {
    const badge = byId("loop-badge");
    setText(badge, Number.isFinite(loop.rate_hz) ? `${number(loop.rate_hz, 0)} Hz, p99 ${microseconds(loop.latency_p99_us)}` : "");
    const late = loop.missed > (this.missed_ ?? loop.missed ?? 0);
    this.missed_ = loop.missed ?? 0;
    if (late) this.late_until_ = performance.now() + 5000;
    setAttribute(badge, "data-state", performance.now() < (this.late_until_ ?? 0) ? "stale" : "fresh");
  }

  show_facts_(live) {
    const loop = live.loop ?? {};
    const facts = {
      "fact-rate": `${number(loop.rate_hz, 0)} Hz`, "fact-latency": microseconds(loop.latency_p99_us),
      "fact-compute": microseconds(loop.compute_p99_us), "fact-missed": count(loop.missed),
      "fact-instance": live.instance ?? "–", "fact-revision": count(live.revision),
    };
    for (const [id, text] of Object.entries(facts)) setText(byId(id), text);
  }
}

function make_queue(queue) {
  const row = {dropped: element("td", {class: "value"}), fill: element("td", {class: "value"})};
  row.node = element("tr", {}, element("th", {scope: "row"}, queue.name), row.fill, row.dropped);
  return row;
}

function update_queue(row, queue) {
  setText(row.dropped, count(queue.dropped));
  const known = Number.isFinite(queue.high_water) && Number.isFinite(queue.capacity);
  setText(row.fill, known ? `${count(queue.high_water)} / ${count(queue.capacity)}` : "–");
  row.node.classList.toggle("warning", queue.dropped > 0);
}
