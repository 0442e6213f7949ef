// The alarms at any time of a recording, out of the lines that it has of them (alarm_line.hpp). From any bytes. Any
// thread once all lines are there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "app/snapshot/alarm_report.hpp"

namespace cellmirror::app {

class AlarmHistory {
 public:
  static constexpr std::size_t kMostLines = 20'000;

  struct Raised {
    std::int64_t time_ms = 0;  // since 1970 (UTC)
    Alarm alarm;               // as it was then
  };

  // In the order of the file. `time_ns`: when it was recorded, UTC. What is no alarm, and what is beyond kMostLines, is
  // left out. Before any other call.
  void add(std::int64_t time_ns, std::string_view line);

  // As they were then. Another revision where another line was the last one.
  [[nodiscard]] AlarmReport at(std::int64_t time_ns) const;
  // Each time that one was raised, once, in the order of the lines.
  [[nodiscard]] std::vector<Raised> raised() const;

 private:
  struct Line {
    std::int64_t time_ns = 0;
    Alarm alarm;
  };

  [[nodiscard]] AlarmReport report_after(std::size_t lines) const;

  std::vector<Line> lines_;  // times ascend
  // What was asked for last: the same is asked for several times a second.
  mutable std::mutex mutex_;
  mutable std::size_t known_lines_ = 0;
  mutable std::shared_ptr<const AlarmReport> known_;
};

}  // namespace cellmirror::app
