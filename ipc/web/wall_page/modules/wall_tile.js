// One tile of the wall.
import {element, KeyedRows, setAttribute, setText} from "./dom.js";
import {age, count, duration, length, number} from "./format.js";
import {age_of, name_of, robots_of, silent_text, way_to_page} from "./wall_model.js";

const kMostRobots = 12;
const kOldPicture_s = 5;

function row(list, name) {
  const value = element("dd");
  const term = element("dt", {}, name);
  list.append(term, value);
  return {show: (text) => {
    setAttribute(term, "hidden", text === null ? "" : null);
    setAttribute(value, "hidden", text === null ? "" : null);
    if (text !== null) setText(value, text);
  }};
}

export class Tile {
  constructor() {
    this.title = element("h3");
    this.state = element("span", {class: "badge"});
    this.of = element("p", {class: "tile-of soft"});
    this.why = element("ul", {class: "why"});
    this.robots = element("ul", {class: "robots", "aria-label": "robots"});
    this.list = element("dl");
    this.heard = row(this.list, "heard");
    this.touching = row(this.list, "touching");
    this.nearest = row(this.list, "nearest");
    this.loop = row(this.list, "loop");
    this.alarms = row(this.list, "alarms");
    this.sent = row(this.list, "summaries");
    this.picture = element("img", {class: "thumbnail", hidden: true, decoding: "async"});
    this.picture_age = element("p", {class: "tile-of soft", hidden: true});
    this.foot = element("p", {class: "tile-foot"});
    this.node = element("li", {class: "tile"}, element("div", {class: "tile-head"}, this.title, this.state), this.of, this.why, this.picture,
      this.picture_age, this.robots, this.list, this.foot);
    this.reasons_ = new KeyedRows(this.why, () => ({node: element("li")}), (one, item) => {
      setAttribute(one.node, "class", item.mark ? "mark" : null);
      setText(one.node, item.text);
    });
    this.robots_ = new KeyedRows(this.robots, () => ({node: element("li", {class: "robot"})}), (one, robot) => {
      setAttribute(one.node, "data-bad", robot.bad ? "" : null);
      setText(one.node, robot.text);
    });
    this.shown_ = null;      // content
    this.thumbnail_ = null;  // number
    this.foot_ = "";
    this.waits_ = false;
  }

  // `seen`: it takes room on the screen. Otherwise what changes with each summary waits until it does.
  show(tile, now, seen) {
    const {content, pulse} = tile;
    if (content !== this.shown_) this.show_content_(content);
    this.waits_ = !seen;
    if (!seen) return;
    this.show_robots_(tile);
    this.show_pulse_(content, pulse);
    this.show_picture_(content, pulse);
    this.tick(tile, now);
  }

  // What changes by time alone.
  tick(tile, now) {
    if (this.waits_) {
      this.show(tile, now, true);
      return;
    }
    const seconds = age_of(tile, now);
    if (tile.content.state === "silent") setText(this.state, `silent ${silent_text(tile.content)} (${duration((Date.now() - tile.content.silent_since_ms) / 1000)})`);
    this.heard.show(seconds === null ? null : `${age(Math.round(seconds * 10) / 10)} ago`);
    if (tile.thumbnail_ms === null) return;
    const old_s = (now - tile.thumbnail_ms) / 1000;
    setAttribute(this.picture, "class", old_s > kOldPicture_s ? "thumbnail old" : "thumbnail");
    setText(this.picture_age, old_s > kOldPicture_s ? `picture of ${duration(old_s)} ago` : "");
    setAttribute(this.picture_age, "hidden", old_s > kOldPicture_s ? null : "");
  }

  show_content_(content) {
    this.shown_ = content;
    setAttribute(this.node, "data-level", content.level);
    setAttribute(this.state, "data-level", content.level);
    setText(this.title, name_of(content));
    setText(this.state, content.state === "silent" ? `silent ${silent_text(content)}` : content.replay ? `${content.state}, a recording` : content.state);
    const of = [content.title ? content.cell : "", content.host ? `${content.host}/${content.instance}` : ""].filter((text) => text);
    if (content.moved_from) of.push(`before: ${content.moved_from}`);
    setText(this.of, of.join(" · "));
    const reasons = (content.reasons ?? []).map((text) => ({text: content.state === "silent" ? `last: ${text}` : text, mark: false}));
    const marks = content.marks.map(({text}) => ({text, mark: true}));
    this.reasons_.show([...marks, ...reasons], ({text, mark}) => `${mark}${text}`);
    this.show_foot_(content);
  }

  show_foot_(content) {
    const way = way_to_page(content);
    const key = JSON.stringify(way);
    if (key === this.foot_) return;
    this.foot_ = key;
    const link = way.href && element("a", {href: way.href, target: "_blank", rel: "noopener noreferrer", "aria-label": `page of ${name_of(content)}`}, "its page");
    if (way.command) this.foot.replaceChildren(element("code", {}, way.command), ", then ", link);
    else this.foot.replaceChildren(link ?? way.text ?? "");
  }

  show_robots_(tile) {
    const {shown, more} = robots_of(tile, kMostRobots);
    const silent = tile.content.state === "silent";  // then nobody knows
    const items = shown.map((robot) => {
      const told = !robot.mirrored ? "not mirrored" : silent ? `was ${robot.state}` : `${robot.state}${robot.age_s === null ? "" : ` ${age(robot.age_s)}`}`;
      return {key: robot.id, bad: robot.bad, text: `${robot.id}: ${told}`};
    });
    if (more > 0) items.push({key: "", bad: false, text: `and ${count(more)} more`});
    this.robots_.show(items, ({key}) => key);
  }

  show_pulse_(content, pulse) {
    const known = content.health !== undefined;
    const was = content.state === "silent" ? "was " : "";
    const pairs = (content.touching_pairs ?? []).map((pair) => pair.join(" and ")).join("; ");
    this.touching.show(known && content.touching > 0 ? `${was}${count(content.touching)}: ${pairs}` : null);
    this.nearest.show(known && content.nearest && pulse.nearest_m !== null ? `${was}${length(pulse.nearest_m)}, ${content.nearest.join(" and ")}` : null);
    this.loop.show(known ? `${was}${number(pulse.rate_hz, 0)} Hz, ${content.on_time ? "on time" : "late"}, ${count(pulse.missed)} missed, ${count(content.faults)} faults` : null);
    this.alarms.show(known && content.alarms + content.unacknowledged > 0 ? `${was}${count(content.alarms)} active, ${count(content.unacknowledged)} not acknowledged` : null);
    const bad = [["lost", pulse.lost], ["left out", pulse.dropped], ["refused", pulse.rejected], ["repeated", pulse.repeated]]
      .filter(([, value]) => value > 0).map(([name, value]) => `${count(value)} ${name}`);
    this.sent.show(bad.length ? bad.join(", ") : null);
  }

  show_picture_(content, pulse) {
    setAttribute(this.picture, "hidden", content.thumbnail && pulse.thumbnail ? null : "");
    if (!content.thumbnail || !pulse.thumbnail || pulse.thumbnail === this.thumbnail_) return;
    this.thumbnail_ = pulse.thumbnail;
    setAttribute(this.picture, "alt", `picture of ${name_of(content)}`);
    this.picture.src = `thumbnail.jpg?cell=${encodeURIComponent(content.cell)}&number=${pulse.thumbnail}`;
  }
}
