// Writes the status document (docs/status.md).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/report/page_report.hpp"
#include "app/report/problem.hpp"
#include "app/snapshot/alarm_report.hpp"
#include "app/snapshot/cell_state.hpp"
#include "app/snapshot/collision_report.hpp"
#include "app/snapshot/command_record.hpp"
#include "app/snapshot/contact_report.hpp"
#include "app/snapshot/fault_status.hpp"
#include "app/snapshot/force_report.hpp"
#include "app/snapshot/range_report.hpp"
#include "app/snapshot/recorder_report.hpp"
#include "app/snapshot/render_report.hpp"
#include "app/snapshot/tissue_report.hpp"
#include "ipc/control/control_server.hpp"
#include "ipc/sysv/script_message_receiver.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/ports/playback.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/rt/cyclic_thread.hpp"
#include "rt_core/rt/memory_lock.hpp"

namespace cellmirror::app {

// The process that removes the forces of a killed gateway (ipc/sysv/force_guard.hpp).
struct ForceGuardStatus {
  bool running = false;
  std::int32_t process = 0;
};

// What the document is made of, as of one moment.
struct StatusSources {
  std::string instance;
  std::string cell;
  std::string home;
  double uptime_s = 0;
  double rate_hz = 0;
  Timestamp now;
  const CyclicThread& loop;
  const MemoryLockOutcome& memory;
  const FaultStatus& faults;
  const CellState& cell_state;
  const engine::TickState& tick;
  std::span<const RobotState> robots;  // of the same tick
  const ScriptMessageStatus& messages;
  const CollisionReport& collisions;
  const RangeReport& ranges;
  const ContactReport& contacts;
  const ForceReport& forces;
  const RenderReport& pictures;
  const PageReport& page;
  std::vector<engine::QueueStatus> queues;  // of the threads
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::uint64_t>>>> outputs;
  Problems problems = {};
  ForceGuardStatus force_guard = {};
  CommandLogReport commands = {};
  std::shared_ptr<const TissueReport> tissue = nullptr;  // null: no deformable objects
  std::vector<RecordingReport> recordings = {};
  AlarmReport alarms = {};
  std::optional<PlaybackState> playback = {};  // of a recording; none: real robots
};

[[nodiscard]] std::string status_document(const StatusSources& sources);

}  // namespace cellmirror::app
