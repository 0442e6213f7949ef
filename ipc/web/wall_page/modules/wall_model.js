// What is known of the cells, from the documents of the wall (docs/wall.md). Pure.

const kLevels = ["fault", "attention", "ok"];  // in the order in which they are shown
const kNames = new Intl.Collator("en", {numeric: true});
const kMostHeld = 16;  // changes that wait for the whole

export function name_of(content) {
  return content.title || content.cell;
}

export class WallModel {
  constructor() {
    this.tiles = new Map();  // by number: {number, content, pulse, heard_ms, thumbnail_ms}
    this.totals = {};
    this.revision_ = null;   // null: the whole is needed first
    this.held_ = [];
  }

  // False: the whole has to be fetched. `now`: ms, of any clock that does not jump.
  take_changes(document, now) {
    if (this.revision_ === null || document.from > this.revision_) {
      this.revision_ = null;
      this.held_ = [...this.held_, {document, now}].slice(-kMostHeld);
      return false;
    }
    this.apply_(document, now);
    return true;
  }

  // False: changes between it and those that were held are missing, so that it has to be fetched once more.
  take_whole(document, now) {
    const numbers = new Set(document.tiles.map((tile) => tile.number));
    for (const number of this.tiles.keys()) if (!numbers.has(number)) this.tiles.delete(number);
    this.revision_ = document.to;
    this.apply_({...document, removed: []}, now);
    const held = this.held_.filter((one) => one.document.to > document.to);
    this.held_ = [];
    return held.every((one) => this.take_changes(one.document, one.now));
  }

  // The connection has ended: what was missed meanwhile is not known.
  forget_revision() {
    this.revision_ = null;
    this.held_ = [];
  }

  apply_(document, now) {
    for (const number of document.removed) this.tiles.delete(number);
    for (const {number, content, pulse} of document.tiles) {
      const tile = this.tiles.get(number) ?? {number, content: null, pulse: {}};
      if (content) tile.content = content;
      if (!tile.content) continue;
      tile.pulse = pulse;
      tile.heard_ms = pulse.age_s === undefined ? null : now - 1000 * pulse.age_s;
      tile.thumbnail_ms = pulse.thumbnail_age_s === undefined ? null : now - 1000 * pulse.thumbnail_age_s;
      this.tiles.set(number, tile);
    }
    this.totals = document.totals;
    this.revision_ = Math.max(this.revision_, document.to);
  }

  // The worst first, then by name.
  ordered(search = "") {
    const wanted = search.trim().toLowerCase();
    const rank = ({content}) => kLevels.indexOf(content.level);
    return [...this.tiles.values()]
      .filter(({content}) => !wanted || [content.cell, content.title, content.host].some((text) => text.toLowerCase().includes(wanted)))
      .sort((a, b) => rank(a) - rank(b) || kNames.compare(name_of(a.content), name_of(b.content)) || a.number - b.number);
  }

  counts() {
    const counts = Object.fromEntries(kLevels.map((level) => [level, 0]));
    for (const {content} of this.tiles.values()) counts[content.level] += 1;
    return counts;
  }
}

// Seconds since the newest summary; null: none in this run of the wall.
export function age_of(tile, now) {
  return tile.heard_ms === null ? null : Math.max(0, (now - tile.heard_ms) / 1000);
}

// How a person comes to the page of that gateway: {href}, {command} to be typed on the own machine, or {text}.
export function way_to_page(content) {
  if (content.page && /^https?:\/\//.test(content.page)) return {href: content.page};
  if (content.page_port === undefined) return {text: ""};  // nothing was heard of it
  if (!content.page_port) return {text: "it has no monitor page"};
  if (!/^[A-Za-z0-9][A-Za-z0-9._-]*$/.test(content.host)) return {text: `its page is at port ${content.page_port} of its machine`};
  return {command: `ssh -L ${content.page_port}:127.0.0.1:${content.page_port} ${content.host}`, href: `http://127.0.0.1:${content.page_port}/`};
}

// "since 12:34:56 (2 min 3 s)"; the day too where it is not today's.
export function silent_text(content, now = new Date()) {
  if (content.silent_since_ms === undefined) return "";
  const since = new Date(content.silent_since_ms);
  const date = [since.getFullYear(), since.getMonth() + 1, since.getDate()].map((part) => String(part).padStart(2, "0")).join("-");
  const day = since.toDateString() === now.toDateString() ? "" : `${date} `;
  return `since ${day}${since.toTimeString().slice(0, 8)}`;
}

const kGood = new Set(["fresh", ""]);

// Those that are not fresh first, and how many are left out.
export function robots_of(tile, most) {
  const ages = tile.pulse.robots_age_s ?? [];
  const all = (tile.content.robots ?? []).map((robot, i) => ({...robot, age_s: ages[i] ?? null, bad: !kGood.has(robot.state)}));
  const shown = [...all.filter((robot) => robot.bad), ...all.filter((robot) => !robot.bad)].slice(0, most);
  return {shown, more: all.length - shown.length + (tile.content.robots_left_out ?? 0)};
}
