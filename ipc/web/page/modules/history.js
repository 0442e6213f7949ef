// Series over time for the strip charts. All series share the times; a series that had no value then has NaN.

export class History {
  // At most `capacity` samples, `most_series` series; a series unseen for a whole capacity is dropped.
  constructor(capacity = 1300, most_series = 1200) {
    this.capacity_ = capacity;
    this.most_series_ = most_series;
    this.clear();
  }

  clear() {
    // Twice the room: what is kept is always one piece, and moved only once in `capacity` samples.
    this.times_ = new Float64Array(2 * this.capacity_);
    this.begin_ = 0;
    this.end_ = 0;
    this.added_ = 0;
    this.series_ = new Map();
  }

  get length() {
    return this.end_ - this.begin_;
  }

  // `put(key, value)` may be called inside `fill`.
  add(time, fill) {
    if (this.end_ === this.times_.length) this.compact_();
    const at = this.end_++;
    if (this.end_ - this.begin_ > this.capacity_) this.begin_ = this.end_ - this.capacity_;
    ++this.added_;
    this.times_[at] = time;
    for (const series of this.series_.values()) series.values[at] = NaN;
    fill((key, value) => this.put_(key, value, at));
  }

  put_(key, value, at) {
    let series = this.series_.get(key);
    if (!series) {
      if (this.series_.size >= this.most_series_ && !this.drop_oldest_()) return;
      series = {values: new Float32Array(this.times_.length).fill(NaN), seen: 0};
      this.series_.set(key, series);
    }
    series.values[at] = value ?? NaN;
    series.seen = this.added_;
  }

  drop_oldest_() {
    for (const [key, series] of this.series_) {
      if (this.added_ - series.seen > this.capacity_) return this.series_.delete(key);
    }
    return false;
  }

  compact_() {
    this.times_.copyWithin(0, this.begin_, this.end_);
    for (const [key, series] of this.series_) {
      series.values.copyWithin(0, this.begin_, this.end_);
      if (this.added_ - series.seen > this.capacity_) this.series_.delete(key);
    }
    this.end_ -= this.begin_;
    this.begin_ = 0;
  }

  // [times, values...] of the last `seconds`, plain arrays with null where there is nothing; `scale` for each key.
  window(keys, seconds, scales = []) {
    const newest = this.length ? this.times_[this.end_ - 1] : 0;
    const first = this.first_after_(newest - seconds);
    const columns = [Array.from(this.times_.subarray(first, this.end_))];
    keys.forEach((key, i) => columns.push(this.column_(key, first, scales[i] ?? 1)));
    return columns;
  }

  column_(key, first, scale) {
    const values = this.series_.get(key)?.values;
    const column = new Array(this.end_ - first);
    for (let i = first; i < this.end_; ++i) {
      const value = values ? values[i] : NaN;
      column[i - first] = value === value ? value * scale : null;  // NaN is not itself
    }
    return column;
  }

  first_after_(time) {
    let low = this.begin_;
    let high = this.end_;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times_[middle] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  newest(key) {
    const value = this.length ? this.series_.get(key)?.values[this.end_ - 1] : undefined;
    return value === undefined || Number.isNaN(value) ? null : value;
  }

  // Keys with this beginning that had a value within the kept time, the latest seen first in `order`'s terms.
  keys(prefix) {
    return [...this.series_.keys()].filter((key) => key.startsWith(prefix));
  }

  last_seen(key) {
    return this.series_.get(key)?.seen ?? 0;
  }
}
