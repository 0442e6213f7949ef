// One alarm as a line of JSON: the format of records/alarms-INSTANCE.jsonl (docs/alarms.md). Pure.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "app/snapshot/alarm_report.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::app {

inline constexpr std::size_t kMostAlarmLineBytes = 4096;

// Without the line break.
[[nodiscard]] std::string alarm_line_of(const Alarm& alarm);
// What others may have written into the file: every key is checked, and what is not known is refused.
[[nodiscard]] Result<Alarm> read_alarm_line(std::string_view line);

}  // namespace cellmirror::app
