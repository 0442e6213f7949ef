// Short names for dotted paths: those that the gateway gives; else the first part, which says whose it is, and the last,
// and more from the front only where another known path would be called the same.

const kMostKnown = 2000;
const kMostAlike = 20;  // beyond, whole paths: telling many apart costs time

function shortened(parts, front) {
  if (front >= parts.length - 1) return parts.join(".");
  return `${parts.slice(0, front).join(".")}\u2026${parts.at(-1)}`;
}

export class ShortNames {
  constructor() {
    this.given_ = new Map();
    this.names_ = new Map();
    this.alike_ = new Map();  // paths by their shortest name
  }

  give(path, name) {
    if (!path || !name || this.given_.get(path) === name) return;
    if (this.given_.size >= kMostKnown) this.given_.clear();
    this.given_.set(path, name);
  }

  // Those of pairs and readings in `live`.
  learn_from(live) {
    for (const pair of [...(live.touching ?? []), ...(live.near ?? [])]) {
      this.give(pair.a, pair.a_short);
      this.give(pair.b, pair.b_short);
    }
    for (const range of live.ranges ?? []) this.give(range.object, range.object_short);
  }

  // May grow as further paths become known: ask again whenever it is shown.
  of(path) {
    const whole = String(path ?? "");
    if (this.given_.has(whole)) return this.given_.get(whole);
    if (!this.names_.has(whole)) this.learn_(whole);
    return this.names_.get(whole);
  }

  learn_(path) {
    if (this.names_.size >= kMostKnown) {
      this.names_.clear();
      this.alike_.clear();
    }
    const shortest = shortened(path.split("."), 1);
    const alike = [...(this.alike_.get(shortest) ?? []), path];
    this.alike_.set(shortest, alike);
    if (alike.length > kMostAlike) this.names_.set(path, path);
    else for (const one of alike) this.names_.set(one, told_apart(one, alike));
  }
}

function told_apart(path, alike) {
  const parts = path.split(".");
  for (let front = 1; front < parts.length - 1; ++front) {
    const name = shortened(parts, front);
    if (alike.every((other) => other === path || shortened(other.split("."), front) !== name)) return name;
  }
  return path;
}
