// What is worth an alarm now, out of what the gateway knows. No clock, no thread.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "app/alarms/alarm_list.hpp"
#include "app/report/live_document.hpp"
#include "app/snapshot/fault_status.hpp"
#include "app/snapshot/proximity_board.hpp"

namespace cellmirror::app {

class AlarmConditions {
 public:
  // As of one moment. `events`: of collisions and warnings since the last call, so that none is too short to be seen.
  [[nodiscard]] std::vector<AlarmCondition> look(const LiveSources& sources, const FaultStatus& faults,
                                                 std::span<const ProximityEvent> events);
  // Sequence of the newest event that was looked at.
  [[nodiscard]] std::uint64_t newest_event() const { return newest_event_; }

 private:
  void add_streams(const LiveSources& sources, std::vector<AlarmCondition>& out);
  void add_tissue_events(const LiveSources& sources, std::vector<AlarmCondition>& out);

  std::uint64_t newest_event_ = 0;
  std::uint64_t newest_tissue_event_ = 0;
  std::map<std::string, Timestamp> stale_since_;  // by robot
};

}  // namespace cellmirror::app
