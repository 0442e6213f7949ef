// The signals of a DBC that look like positions and velocities of joints.
#pragma once

#include <string>
#include <vector>

#include "app/new_cell/plan.hpp"
#include "drivers/can/dbc/dbc.hpp"

namespace cellmirror::app {

struct GuessedSignals {
  // One position for each joint, numbered from 0 in the order of the DBC, and the velocities that lie in the same
  // message or are called likewise.
  std::vector<PlannedSignal> signals;
  std::size_t joints = 0;
  std::vector<std::string> others;  // "MESSAGE.SIGNAL [unit]" of all other signals, at most kMostOthers
};
inline constexpr std::size_t kMostOthers = 200;

// By names and units. Set points, limits, counters and checks are left out; at most kMaxJointsPerRobot joints. Pure.
[[nodiscard]] GuessedSignals guess_signals(const can::Dbc& dbc);

}  // namespace cellmirror::app
