// Words about values of a mirrored robot that cannot be true.
#pragma once

#include <string>

#include "rt_core/engine/tick_state.hpp"
#include "rt_core/ports/robot_state.hpp"

namespace cellmirror::app {

// "J_2 is at 51471 rad, beyond 3.5 rad", "J_2 moves at 12 rad/s, beyond 3 rad/s", "J_2 is the same for 2.1 s"; empty
// where there was none since the robot went online.
[[nodiscard]] std::string implausible_text(const ImplausibleValue& found, const RobotState& robot);

// What is wrong with a stream, for people: the newest implausible value while a joint is implausible, and the
// stream's own condition.
[[nodiscard]] std::string condition_text(const engine::RobotTickHead& tick, const RobotState& robot,
                                         const std::string& of_stream);

}  // namespace cellmirror::app
