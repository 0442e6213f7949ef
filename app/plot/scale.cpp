#include "app/plot/scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace cellmirror::plot {

namespace {

// Beyond these, sums and quotients of the values themselves could overflow.
constexpr double kSmallest = 1e-150;
constexpr double kLargest = 1e150;
constexpr int kMostDecades = 301;

// "10" with the exponent in raised digits; small powers as plain numbers, which read more easily.
std::string power_of_ten(int exponent) {
  if (exponent >= -2 && exponent <= 4) return fmt::format("{:g}", std::pow(10.0, exponent));
  constexpr std::array<std::string_view, 10> kRaised = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = "10";
  if (exponent < 0) out += "⁻";
  for (const char digit : std::to_string(std::abs(exponent))) out += kRaised[static_cast<std::size_t>(digit - '0')];
  return out;
}

}  // namespace

double round_step(double range, std::size_t most) {
  const double least = range / static_cast<double>(std::max<std::size_t>(most, 1));
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-12)) return factor * power;
  }
  return 10.0 * power;
}

Scale::Scale(const Axis& axis, std::span<const double> values, std::size_t most_ticks)
    : logarithmic_(axis.logarithmic) {
  if (logarithmic_) {
    fit_logarithmic(axis, values, most_ticks);
  } else {
    fit_linear(axis, values, most_ticks);
  }
}

void Scale::fit_linear(const Axis& axis, std::span<const double> values, std::size_t most_ticks) {
  const bool given = axis.low < axis.high;
  low_ = given ? axis.low : INFINITY;
  high_ = given ? axis.high : -INFINITY;
  for (const double value : values) {
    if (given || !std::isfinite(value)) continue;
    low_ = std::min(low_, std::max(value, -kLargest));
    high_ = std::max(high_, std::min(value, kLargest));
  }
  if (low_ > high_) low_ = 0.0, high_ = 1.0;
  // A range that vanishes beside the numbers themselves would have ticks with equal labels.
  const double narrowest = std::max(1e-9 * std::max(std::abs(low_), std::abs(high_)), kSmallest);
  if (high_ - low_ < narrowest) {
    const double half = low_ == 0.0 && high_ == 0.0 ? 1.0 : std::max(narrowest, 0.05 * std::abs(low_));
    low_ -= half;
    high_ += half;
  }
  const double step = round_step(high_ - low_, most_ticks);
  if (!given) {
    low_ = step * std::floor(low_ / step + 1e-9);
    high_ = step * std::ceil(high_ / step - 1e-9);
  }
  add_linear_ticks(step);
}

void Scale::add_linear_ticks(double step) {
  const double largest = std::max(std::abs(low_), std::abs(high_));
  const bool plain = largest < 1e6 && step > 1e-6;
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const double first = std::ceil(low_ / step - 1e-9);
  constexpr int kMost = 100;  // bounds the loop where a step is lost in rounding
  for (int i = 0; i < kMost; ++i) {
    double value = step * (first + i);
    if (value > high_ + 1e-9 * step) break;
    if (std::abs(value) < 1e-9 * step) value = 0.0;
    ticks_.push_back({value, plain ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:.4g}", value)});
  }
}

void Scale::fit_logarithmic(const Axis& axis, std::span<const double> values, std::size_t most_ticks) {
  const bool given = axis.low > 0.0 && axis.low < axis.high;
  low_ = given ? axis.low : INFINITY;
  high_ = given ? axis.high : 0.0;
  for (const double value : values) {
    if (given || !std::isfinite(value) || value < kSmallest) continue;
    low_ = std::min(low_, value);
    high_ = std::max(high_, std::min(value, kLargest));
  }
  if (low_ > high_) low_ = 1.0, high_ = 10.0;
  if (!given) {
    low_ = std::pow(10.0, std::floor(std::log10(low_) + 1e-9));
    high_ = std::pow(10.0, std::ceil(std::log10(high_) - 1e-9));
    if (high_ <= low_ * (1.0 + 1e-9)) high_ = 10.0 * low_;
  }
  add_decades(most_ticks);
}

void Scale::add_decades(std::size_t most_ticks) {
  const int first = static_cast<int>(std::floor(std::log10(low_) + 1e-9));
  const int last = std::min(static_cast<int>(std::ceil(std::log10(high_) - 1e-9)), first + kMostDecades);
  const int most = static_cast<int>(std::max<std::size_t>(most_ticks, 1));
  const int every = (last - first + most) / most;
  for (int exponent = first; exponent <= last; ++exponent) {
    const double power = std::pow(10.0, exponent);
    const bool labelled = (exponent - first) % every == 0;
    if (power >= low_ * (1.0 - 1e-9) && power <= high_ * (1.0 + 1e-9))
      ticks_.push_back({power, labelled ? power_of_ten(exponent) : std::string{}});
    if (every > 1) continue;
    for (int digit = 2; digit <= 9; ++digit) {
      const double value = digit * power;
      if (value < low_ || value > high_) continue;
      const bool few_decades = last - first <= 2 && (digit == 2 || digit == 5);
      ticks_.push_back({value, few_decades ? fmt::format("{:g}", value) : std::string{}});
    }
  }
}

double Scale::fraction(double value) const {
  if (std::isnan(value)) return 0.0;
  const double at = logarithmic_ ? std::log(std::clamp(value, kSmallest, kLargest) / low_) / std::log(high_ / low_)
                                 : (value - low_) / (high_ - low_);
  return std::clamp(at, 0.0, 1.0);
}

double Scale::value(double fraction) const {
  return logarithmic_ ? low_ * std::pow(high_ / low_, fraction) : low_ + fraction * (high_ - low_);
}

std::vector<double> counts(const Histogram& histogram, const Scale& x) {
  const std::size_t bins = std::clamp<std::size_t>(histogram.bins, 1, 10'000);
  std::vector<double> out(bins);
  for (const double value : histogram.values) {
    if (std::isnan(value)) continue;
    const double at = x.fraction(value) * static_cast<double>(bins);
    out[std::min(static_cast<std::size_t>(at), bins - 1)] += 1.0;
  }
  return out;
}

}  // namespace cellmirror::plot
