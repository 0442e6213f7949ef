// Prometheus' text format, version 0.0.4. Pure.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::web {

inline constexpr std::string_view kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

// Writes families of samples one after the other; those of one name have to follow each other.
class MetricsText {
 public:
  using Labels = std::initializer_list<std::pair<std::string_view, std::string_view>>;

  // `type`: counter, gauge or summary.
  void family(std::string_view name, std::string_view type, std::string_view help);
  // Of the family that was begun last; `suffix`: e.g. "_count".
  void sample(double value, Labels labels = {}, std::string_view suffix = {});
  void one(std::string_view name, std::string_view type, std::string_view help, double value);
  // A summary in seconds.
  void latency(std::string_view name, std::string_view help, const HistogramSnapshot& histogram);

  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
  std::string name_;
};

}  // namespace cellmirror::web
