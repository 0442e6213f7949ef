// What the gateway says on its topics: JSON documents of one line (docs/mqtt.md). Pure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "rt_core/ports/cell_summary.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::mqtt {

// Of the gateway, for its birth message.
struct Identity {
  std::string cell;
  std::string instance;
  std::string host;
  std::string version;  // of the program
};

// Of an event: its number in this run of the gateway, from 1, so that missing ones are seen; ms since 1970 (UTC).
struct EventStamp {
  std::uint64_t number = 0;
  std::int64_t time_ms = 0;
};

[[nodiscard]] std::string birth_text(const Identity& identity, bool commands, std::int64_t time_ms);
// The last will: the broker publishes it for a gateway that it lost. `reason`: "lost" or "stopped".
[[nodiscard]] std::string death_text(std::string_view reason);

[[nodiscard]] std::string collision_text(const EventStamp& stamp, const ProximityEvent& event);
// A robot whose data changed from `was` to what it is; `first`: nothing was known before.
[[nodiscard]] std::string stream_text(const EventStamp& stamp, const RobotSummary& robot, DataState was);
// `faults`: of the loop since the start.
[[nodiscard]] std::string fault_text(const EventStamp& stamp, const CellSummary& summary);
// `alarm`: as a line of the alarms' file (docs/alarms.md).
[[nodiscard]] std::string alarm_text(const EventStamp& stamp, std::string_view alarm);

// Positions in rad or m, velocities in rad/s or m/s, efforts in Nm or N; what is not finite is null.
[[nodiscard]] std::string joint_states_text(const RobotState& robot, std::int64_t time_ms);

// `id`: of the command, as a JSON value; empty: it had none.
[[nodiscard]] std::string reply_text(std::string_view id, bool done, std::string_view text, std::int64_t time_ms);

}  // namespace cellmirror::mqtt
