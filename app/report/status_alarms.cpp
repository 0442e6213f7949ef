#include "app/report/status_alarms.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "rt_core/base/utc_text.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::int64_t kNsOfMs = 1'000'000;
constexpr std::size_t kOfPage = 200;

json time_json(const std::optional<std::int64_t>& time_ms) {
  return time_ms ? json(utc_text_ms(*time_ms * kNsOfMs)) : json(nullptr);
}

json alarm_json(const Alarm& alarm, std::int64_t now_ms) {
  return {{"id", alarm.id},
          {"kind", alarm.kind},
          {"subject", alarm.subject},
          {"text", alarm.text},
          {"priority", word(alarm.priority)},
          {"state", word(alarm.state())},
          {"time", time_json(alarm.raised_ms)},
          {"age_s", 1e-3 * static_cast<double>(std::max<std::int64_t>(0, now_ms - alarm.raised_ms))},
          {"first_time", time_json(alarm.first_ms)},
          {"occurrences", alarm.occurrences},
          {"cleared_time", time_json(alarm.cleared_ms)},
          {"acknowledged_time", time_json(alarm.acknowledged_ms)},
          {"acknowledged_by", alarm.acknowledged_by}};
}

json list_json(const std::vector<Alarm>& alarms, std::int64_t now_ms, std::size_t most) {
  json out = json::array();
  for (std::size_t i = 0; i < std::min(most, alarms.size()); ++i) out.push_back(alarm_json(alarms[i], now_ms));
  return out;
}

}  // namespace

json alarms_json(const AlarmReport& report, Timestamp now, std::size_t most) {
  const std::int64_t now_ms = to_wall_clock_ns(now) / kNsOfMs;
  const AlarmCounts& counts = report.counts;
  return {{"revision", counts.revision},
          {"unacknowledged", counts.unacknowledged()},
          {"active", counts.active()},
          {"highest_priority", counts.highest ? json(word(*counts.highest)) : json(nullptr)},
          {"not_listed", counts.not_listed},
          {"open", list_json(report.open, now_ms, most)},
          {"open_count", report.open.size()},
          {"history", list_json(report.history, now_ms, most)},
          {"history_count", report.history.size()},
          {"file", report.file},
          {"problem", report.problem},
          {"refused_lines", report.refused_lines}};
}

std::string alarms_document(const AlarmReport& report, Timestamp now) {
  return alarms_json(report, now, kOfPage).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace cellmirror::app
