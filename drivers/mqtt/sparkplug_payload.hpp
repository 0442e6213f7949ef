// Payloads of Sparkplug B (specification 3.0.0, section 6.4). Pure; the types of the protobuf library stay behind it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "rt_core/base/result.hpp"

namespace cellmirror::mqtt {

// The numbers of section 6.4.16.
enum class SparkplugType : std::uint32_t { int64 = 4, float64 = 10, boolean = 11, text = 12 };

// Null: a value that is not known now.
using SparkplugValue = std::variant<std::monostate, std::int64_t, double, bool, std::string>;

struct SparkplugMetric {
  std::string name;
  SparkplugType type = SparkplugType::text;
  SparkplugValue value;

  bool operator==(const SparkplugMetric&) const = default;
};

struct SparkplugPayload {
  std::int64_t time_ms = 0;              // since 1970 (UTC), of the payload and of each metric
  std::optional<std::uint8_t> seq = {};  // none: of NDEATH
  std::vector<SparkplugMetric> metrics = {};
};

[[nodiscard]] std::string encode(const SparkplugPayload& payload);

inline constexpr std::size_t kMostSparkplugCommandBytes = 16'384;
inline constexpr std::size_t kMostSparkplugMetrics = 256;

// Of any bytes: whether an NCMD asks for the birth messages again ("Node Control/Rebirth" is true). Fails where it is
// no payload or has more than kMostSparkplugMetrics metrics.
[[nodiscard]] Result<bool> asks_for_rebirth(std::string_view bytes);

inline constexpr std::string_view kRebirthMetric = "Node Control/Rebirth";

}  // namespace cellmirror::mqtt
