// Messages of a recording as tables: any topic as CSV or JSON, joints as the posture file of `collide`, `range` and
// `sim_robot` (docs/recording.md).
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "ipc/record/reader.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

struct ExportTotals {
  std::uint64_t messages = 0;
  std::uint64_t left_out = 0;  // could not be decoded, or had not all joints yet
  std::size_t columns = 0;
  std::string first_problem;  // why one was left out; empty: none was
};

inline constexpr std::size_t kMostColumns = 20'000;

// One row a message: log_time_ns, publish_time_ns, then a column for each value of any message of the topic; empty
// where a message has none. Reads twice: the columns first. Fails where the topic is not there.
[[nodiscard]] Result<ExportTotals> export_csv(mcap::Reader& reader, const std::string& topic, mcap::Filter filter,
                                              std::FILE* out);
// {"topic": ..., "messages": [{"log_time_ns": ..., "values": {...}}]}
[[nodiscard]] Result<ExportTotals> export_json(mcap::Reader& reader, const std::string& topic, mcap::Filter filter,
                                               std::FILE* out);
// One row a message of sensor_msgs/msg/JointState on `topic`, empty: on any. Rows begin when every joint has a value. A
// joint is named by the channel's metadata (recording_report.hpp), else by "robot/joint" or "robot.joint".
[[nodiscard]] Result<ExportTotals> export_postures(mcap::Reader& reader, const std::string& topic, mcap::Filter filter,
                                                   std::FILE* out);

// Frames of "/inputs/can/ROBOT" as a candump log, which `log:FILE` endpoints and canplayer play: those that were
// received, on an interface named as the robot. `topic` empty: of all robots.
[[nodiscard]] Result<ExportTotals> export_candump(mcap::Reader& reader, const std::string& topic, mcap::Filter filter,
                                                  std::FILE* out);

}  // namespace cellmirror::app
