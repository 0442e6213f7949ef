// One axis: where a value lies on it, and where its ticks are. Private to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "app/plot/figure.hpp"

namespace cellmirror::plot {

struct Tick {
  double value = 0;
  std::string label;  // empty: a line of the grid only
};

class Scale {
 public:
  // Of what the axis asks for, else of all finite values (positive ones where it is logarithmic) with ends at round
  // numbers. `most_ticks`: labelled ones that there is room for.
  Scale(const Axis& axis, std::span<const double> values, std::size_t most_ticks);

  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }
  // 0 at the low end, 1 at the high one; values beyond the ends, and those that no logarithm exists of, are at the
  // ends.
  [[nodiscard]] double fraction(double value) const;
  [[nodiscard]] double value(double fraction) const;
  [[nodiscard]] const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  void fit_linear(const Axis& axis, std::span<const double> values, std::size_t most_ticks);
  void fit_logarithmic(const Axis& axis, std::span<const double> values, std::size_t most_ticks);
  void add_linear_ticks(double step);
  void add_decades(std::size_t most_ticks);

  bool logarithmic_ = false;
  double low_ = 0;
  double high_ = 1;
  std::vector<Tick> ticks_;
};

// How many values lie in each of `bins` equal parts of the axis; values beyond its ends count in the first or last.
[[nodiscard]] std::vector<double> counts(const Histogram& histogram, const Scale& x);

// 1, 2 or 5 times a power of ten: the smallest such step that makes at most `most` parts of `range`.
[[nodiscard]] double round_step(double range, std::size_t most);

}  // namespace cellmirror::plot
