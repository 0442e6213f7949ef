// The alarms of the running gateway: where they are kept, and what they are made of.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "app/alarms/alarm_log.hpp"
#include "app/recorder/alarm_recorder.hpp"
#include "app/report/live_document.hpp"
#include "app/snapshot/proximity_board.hpp"
#include "app/workers/fault_monitor.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

// Without a place for its file too; the log's problem() says so then.
[[nodiscard]] std::unique_ptr<AlarmLog> open_alarm_log(const KismetHome& home, std::string_view instance,
                                                       const Clock& clock);

// All of it outlives the log's thread.
struct AlarmSources {
  const ProximityBoard& collisions;
  const FaultMonitor& faults;
  std::function<void(const std::function<void(const LiveSources&)>&)> at;  // hands in everything as of now
};
void watch_for_alarms(AlarmLog& alarms, AlarmSources sources, AlarmLog::Changed changed = {});
// For recordings; `alarms` outlives what comes back.
[[nodiscard]] AlarmLines alarm_lines(const AlarmLog& alarms);

}  // namespace cellmirror::app
