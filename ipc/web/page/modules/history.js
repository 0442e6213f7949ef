// Series over time for the strip charts. All series share the times; a series that had no value then has NaN.

export class History {
  // At most `capacity` samples, `most_series` series; a series unseen for a whole capacity is dropped. What finds no
  // place is in left_out().
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
    this.left_out_ = new Set();
  }

  get length() {
    return this.end_ - this.begin_;
  }

  // `put(key, value, spare)` may be called inside `fill`; `spare`: places that a new series leaves to others.
  add(time, fill) {
    if (this.end_ === this.times_.length) this.compact_();
    const at = this.end_++;
    if (this.end_ - this.begin_ > this.capacity_) this.begin_ = this.end_ - this.capacity_;
    ++this.added_;
    this.times_[at] = time;
    for (const series of this.series_.values()) series.values[at] = NaN;
    this.left_out_.clear();
    fill((key, value, spare = 0) => this.put_(key, value, at, spare));
  }

  put_(key, value, at, spare) {
    let series = this.series_.get(key);
    if (!series) {
      if (value === null || value === undefined || Number.isNaN(value)) return;  // a curve begins with its first value
      if (this.series_.size >= this.most_series_ - spare && !this.drop_oldest_()) {
        this.left_out_.add(key);
        return;
      }
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

  // Keys of the newest sample that there was no place for.
  left_out() {
    return [...this.left_out_];
  }

  newest_time() {
    return this.length ? this.times_[this.end_ - 1] : 0;
  }

  // [times, values...] of the `seconds` up to `until`, plain arrays with null where there is nothing; `scale` for each
  // key.
  window(keys, seconds, scales = [], until = this.newest_time()) {
    const first = this.first_after_(until - seconds);
    let end = this.first_after_(until);
    if (end < this.end_ && this.times_[end] === until) ++end;
    const columns = [Array.from(this.times_.subarray(first, end))];
    keys.forEach((key, i) => columns.push(this.column_(key, first, end, scales[i] ?? 1)));
    return columns;
  }

  column_(key, first, end, scale) {
    const values = this.series_.get(key)?.values;
    const column = new Array(end - first);
    for (let i = first; i < end; ++i) {
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
