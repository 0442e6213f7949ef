#include "app/gateway/gateway_alarms.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "app/alarms/alarm_conditions.hpp"

namespace cellmirror::app {

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

void watch_for_alarms(AlarmLog& alarms, AlarmSources sources) {
  alarms.start([of = std::move(sources), conditions = AlarmConditions()]() mutable {
    std::vector<AlarmCondition> out;
    const std::vector<ProximityEvent> events = of.collisions.events_after(conditions.newest_event());
    const FaultStatus faults = of.faults.status();
    of.at([&](const LiveSources& live) { out = conditions.look(live, faults, events); });
    return out;
  });
}

}  // namespace cellmirror::app
