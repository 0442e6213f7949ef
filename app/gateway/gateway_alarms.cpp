#include "app/gateway/gateway_alarms.hpp"

#include <fmt/format.h>

#include <ranges>
#include <utility>
#include <vector>

#include "app/alarms/alarm_conditions.hpp"
#include "app/alarms/alarm_line.hpp"

namespace cellmirror::app {

namespace {

constexpr std::size_t kHistoryRecorded = 50;  // at the beginning of a file

}  // namespace

std::unique_ptr<AlarmLog> open_alarm_log(const KismetHome& home, std::string_view instance, const Clock& clock) {
  auto file = home.file_to_write("records", fmt::format("alarms-{}.jsonl", instance));
  AlarmLog::Options options;
  if (file) {
    options.file = std::move(*file);
  } else {
    options.no_file = fmt::format("alarms are forgotten at a restart: {}", file.error().text());
  }
  return std::make_unique<AlarmLog>(std::move(options), clock);
}

void watch_for_alarms(AlarmLog& alarms, AlarmSources sources, AlarmLog::Changed changed) {
  alarms.start(
      [of = std::move(sources), conditions = AlarmConditions()]() mutable {
        std::vector<AlarmCondition> out;
        const std::vector<ProximityEvent> events = of.collisions.events_after(conditions.newest_event());
        const FaultStatus faults = of.faults.status();
        of.at([&](const LiveSources& live) { out = conditions.look(live, faults, events); });
        return out;
      },
      std::move(changed));
}

AlarmLines alarm_lines(const AlarmLog& alarms) {
  const auto newest = [&alarms] {
    AlarmReport report = alarms.report();
    if (report.history.size() > kHistoryRecorded) report.history.resize(kHistoryRecorded);
    std::vector<AlarmLines::Line> out;
    for (const Alarm& alarm : report.history | std::views::reverse) out.push_back({alarm.id, alarm_line_of(alarm)});
    for (const Alarm& alarm : report.open | std::views::reverse) out.push_back({alarm.id, alarm_line_of(alarm)});
    return out;
  };
  // 0 is no revision, so that the first look takes all.
  return {.revision = [&alarms] { return alarms.counts().revision + 1; }, .newest = newest};
}

}  // namespace cellmirror::app
