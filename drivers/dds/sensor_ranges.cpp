#include "drivers/dds/sensor_ranges.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace cellmirror::dds {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// http://www.isthe.com/chongo/tech/comp/fnv: FNV-1a, 32 bits.
std::uint32_t fnv_1a(std::string_view text) {
  std::uint32_t hash = 2'166'136'261U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16'777'619U;
  return hash;
}

// A token of a topic's name; an underscore in front would hide the topic from ROS 2's tools.
std::string token(std::string_view kind, std::string_view id) {
  std::string made;
  for (const char c : id) {
    const char allowed = is_letter(c) || is_digit(c) ? c : '_';
    if (allowed != '_' || (!made.empty() && made.back() != '_')) made += allowed;
  }
  if (made.empty() || is_digit(made.front())) made.insert(0, std::string(kind) + "_");
  return made;
}

}  // namespace

std::string topic_of(std::string_view kind, std::string_view prefix, std::string_view id) {
  std::string name = token(kind, id);
  if (name != id) name += fmt::format("{}{:08x}", name.ends_with('_') ? "" : "_", fnv_1a(id));
  return fmt::format("{}/{}", prefix, name);
}

std::string range_topic(std::string_view prefix, std::string_view id) { return topic_of("uss", prefix, id); }

std::string beam_frame(const RangeReading& reading) { return reading.path + "/beam"; }

FramePose beam_frame_pose(const RangeReading& reading) {
  Pose X_SB = Pose::Identity();
  X_SB.linear() << 0, 0, -1,  //
      0, 1, 0,                //
      1, 0, 0;
  return {"world", beam_frame(reading), reading.X_WS * X_SB};
}

bool fill_range(RosTime stamp, const RangeReading& reading, Range& message) {
  const double distance = reading.distance_m.value_or(reading.range_m);
  if (!std::isfinite(distance) || !std::isfinite(reading.range_m) || !std::isfinite(reading.blind_zone_m) ||
      !std::isfinite(reading.half_angle_rad)) {
    return false;
  }
  message.header.stamp = stamp;
  message.header.frame_id = beam_frame(reading);
  message.radiation_type = kUltrasound;
  message.field_of_view = static_cast<float>(2 * reading.half_angle_rad);
  message.min_range = static_cast<float>(reading.blind_zone_m);
  message.max_range = static_cast<float>(reading.range_m);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (reading.doubtful) {
    message.range = std::numeric_limits<float>::quiet_NaN();
  } else if (!reading.distance_m) {
    message.range = kInfinity;
  } else if (reading.in_blind_zone) {
    message.range = -kInfinity;
  } else {
    // Rounding must not carry a reading beyond the limits, where receivers throw it away.
    message.range = std::clamp(static_cast<float>(distance), std::min(message.min_range, message.max_range),
                               std::max(message.min_range, message.max_range));
  }
  message.variance = 0;
  return true;
}

}  // namespace cellmirror::dds
