// What a control room sees of a cell: small, complete in itself, the same on DDS and MQTT (docs/plant.md). Plain data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror {

inline constexpr int kCellSummaryVersion = 1;
// Limits of one summary: what is beyond them is counted, not sent. Its text has at most kMostSummaryBytes.
inline constexpr std::size_t kMostSummaryRobots = 64;
inline constexpr std::size_t kMostSummaryPairs = 4;
inline constexpr std::size_t kMostSummaryReasons = 8;
inline constexpr std::size_t kMostSummaryText = 160;  // bytes of a name or a reason
inline constexpr std::size_t kMostSummaryBytes = 32'768;

// Worst last.
enum class CellHealth : std::uint8_t {
  ok,
  attention,  // bodies touch, a mirrored robot has no fresh values, an alarm is open, no MQTT broker is reached
  fault,      // the loop is not on time, or the gateway itself has a problem
};
inline constexpr std::array<std::string_view, 3> kCellHealthWords = {"ok", "attention", "fault"};
[[nodiscard]] constexpr std::string_view word(CellHealth health) {
  return kCellHealthWords.at(std::to_underlying(health));
}

struct RobotSummary {
  std::string id;
  bool mirrored = false;
  DataState state = DataState::none;  // of a mirrored robot
  std::optional<double> age_s = {};   // of its newest sample; none: it never had one, or it is not mirrored

  bool operator==(const RobotSummary&) const = default;
};

struct BodyPair {
  std::string a;
  std::string b;

  bool operator==(const BodyPair&) const = default;
};

struct NearestPair {
  BodyPair bodies;
  double distance_m = 0;  // 0 where they touch

  bool operator==(const NearestPair&) const = default;
};

struct LoopSummary {
  double rate_hz = 0;
  std::uint64_t missed = 0;  // periods, since the start
  std::uint64_t faults = 0;  // since the start
  bool on_time = false;

  bool operator==(const LoopSummary&) const = default;
};

struct AlarmSummary {
  std::size_t active = 0;
  std::size_t unacknowledged = 0;

  bool operator==(const AlarmSummary&) const = default;
};

struct CellSummary {
  int version = kCellSummaryVersion;
  std::string cell;            // as its cell file calls it
  std::string host;            // of the gateway
  std::string instance;        // of the gateway on that host
  std::string run;             // differs from start to start
  std::uint64_t sequence = 0;  // from 1, in that run
  std::int64_t time_ns = 0;    // since 1970 (UTC), by the gateway's clock
  double uptime_s = 0;
  bool replay = false;  // a recording is played
  CellHealth health = CellHealth::ok;
  std::vector<std::string> reasons = {};  // for people; empty where the health is ok
  LoopSummary loop = {};
  std::vector<RobotSummary> robots = {};
  std::size_t robots_left_out = 0;
  std::optional<NearestPair> nearest = {};  // of all tested pairs
  std::size_t touching = 0;                 // pairs
  std::vector<BodyPair> touching_pairs = {};
  AlarmSummary alarms = {};
  std::uint16_t page_port = 0;  // of the monitor page on the gateway's host; 0: there is none

  bool operator==(const CellSummary&) const = default;
};

}  // namespace cellmirror
