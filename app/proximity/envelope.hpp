// The smallest values of a long row of values, for drawing: neighbours are put together so that memory stays bounded.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace cellmirror::app {

class Envelope {
 public:
  static constexpr std::size_t kMostPoints = 20'000;

  // The next value; NaN: there is none at this place.
  void add(double value) {
    if (in_last_ == 0) values_.push_back(std::numeric_limits<double>::quiet_NaN());
    values_.back() = std::fmin(values_.back(), value);  // of a number and NaN: the number
    if (++in_last_ < width_) return;
    in_last_ = 0;
    if (values_.size() < kMostPoints) return;
    for (std::size_t i = 0; i < kMostPoints / 2; ++i) values_[i] = std::fmin(values_[2 * i], values_[2 * i + 1]);
    values_.resize(kMostPoints / 2);
    width_ *= 2;
  }

  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  // The numbers of the first values that are put together, from 1.
  [[nodiscard]] std::vector<double> numbers() const {
    std::vector<double> out(values_.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = 1.0 + static_cast<double>(i * width_);
    return out;
  }

 private:
  std::vector<double> values_;
  std::uint64_t width_ = 1;
  std::uint64_t in_last_ = 0;
};

}  // namespace cellmirror::app
