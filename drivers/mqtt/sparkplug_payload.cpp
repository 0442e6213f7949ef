#include "drivers/mqtt/sparkplug_payload.hpp"

#include <fmt/format.h>
#include <sparkplug_wire.pb.h>

#include <utility>

namespace cellmirror::mqtt {

namespace {

void set_value(wire::Metric& out, const SparkplugValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    out.set_long_value(static_cast<std::uint64_t>(*whole));
  } else if (const auto* real = std::get_if<double>(&value)) {
    out.set_double_value(*real);
  } else if (const auto* truth = std::get_if<bool>(&value)) {
    out.set_boolean_value(*truth);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    out.set_string_value(*text);
  } else {
    out.set_is_null(true);
  }
}

}  // namespace

std::string encode(const SparkplugPayload& payload) {
  wire::Payload out;
  const auto time = static_cast<std::uint64_t>(payload.time_ms);
  out.set_timestamp(time);
  for (const SparkplugMetric& metric : payload.metrics) {
    wire::Metric& to = *out.add_metrics();
    to.set_name(metric.name);
    to.set_timestamp(time);
    to.set_datatype(std::to_underlying(metric.type));
    set_value(to, metric.value);
  }
  if (payload.seq) out.set_seq(*payload.seq);
  return out.SerializeAsString();
}

Result<bool> asks_for_rebirth(std::string_view bytes) {
  if (bytes.size() > kMostSparkplugCommandBytes)
    return fail(fmt::format("it has {} bytes, more than {}", bytes.size(), kMostSparkplugCommandBytes));
  wire::Payload payload;
  if (!payload.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return fail("it is no Sparkplug payload");
  if (static_cast<std::size_t>(payload.metrics_size()) > kMostSparkplugMetrics)
    return fail(fmt::format("it has more than {} metrics", kMostSparkplugMetrics));
  for (const wire::Metric& metric : payload.metrics()) {
    if (metric.name() == kRebirthMetric && metric.has_boolean_value() && metric.boolean_value()) return true;
  }
  return false;
}

}  // namespace cellmirror::mqtt
