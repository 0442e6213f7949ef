// The gateway's short names of dotted paths, which distinguish equal robots, as received in `live`.

const kMostKnown = 2000;

export class ShortNames {
  constructor() {
    this.names_ = new Map();
  }

  learn_from(live) {
    if (this.names_.size > kMostKnown) this.names_.clear();
    for (const pair of [...(live.touching ?? []), ...(live.near ?? [])]) {
      this.names_.set(pair.a, pair.a_short);
      this.names_.set(pair.b, pair.b_short);
    }
    for (const range of [...(live.ranges ?? []), ...(live.light_barriers ?? [])]) this.names_.set(range.object, range.object_short);
  }

  of(path) {
    return this.names_.get(path) || String(path ?? "");
  }
}
