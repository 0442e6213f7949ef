#include "ipc/web/metrics_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace cellmirror::web {

namespace {

constexpr double kNanosecond = 1e-9;

std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  return fmt::format("{:.15g}", value);
}

// A label's value: backslash, quote and line feed are escaped.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || c == '"') out += '\\';
    out += c == '\n' ? std::string_view("\\n") : std::string_view(&c, 1);
  }
  return out;
}

}  // namespace

void MetricsText::family(std::string_view name, std::string_view type, std::string_view help) {
  name_ = name;
  fmt::format_to(std::back_inserter(text_), "# HELP {0} {1}\n# TYPE {0} {2}\n", name, help, type);
}

void MetricsText::sample(double value, Labels labels, std::string_view suffix) {
  text_ += name_;
  text_ += suffix;
  if (labels.size() > 0) {
    std::string list;
    for (const auto& [name, of] : labels)
      list += fmt::format("{}{}=\"{}\"", list.empty() ? "" : ",", name, escaped(of));
    text_ += "{" + list + "}";
  }
  text_ += " " + number(value) + "\n";
}

void MetricsText::one(std::string_view name, std::string_view type, std::string_view help, double value) {
  family(name, type, help);
  sample(value);
}

void MetricsText::latency(std::string_view name, std::string_view help, const HistogramSnapshot& histogram) {
  family(name, "summary", help);
  const auto quantile = [&](std::string_view which, double percent) {
    sample(static_cast<double>(histogram.percentile(percent).count()) * kNanosecond, {{"quantile", which}});
  };
  quantile("0.5", 50);
  quantile("0.99", 99);
  quantile("0.999", 99.9);
  const auto count = static_cast<double>(histogram.count());
  sample(static_cast<double>(histogram.mean().count()) * kNanosecond * count, {}, "_sum");
  sample(count, {}, "_count");
}

}  // namespace cellmirror::web
