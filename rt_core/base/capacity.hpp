// Capacities of everything that has a fixed size so that the tick never allocates. A cell beyond one is refused when
// it is loaded, with the number.
#pragma once

#include <cstddef>

namespace cellmirror {

inline constexpr std::size_t kMaxRobots = 64;
inline constexpr std::size_t kMaxJointsPerRobot = 16;
inline constexpr std::size_t kMaxNameLength = 63;   // of one name; a dotted path may be longer
inline constexpr std::size_t kMaxNodes = 20'000;    // frames, joints and workframes of a cell, all detail levels
inline constexpr std::size_t kMaxScriptDepth = 32;  // EXEC_SCRIPT within EXEC_SCRIPT

}  // namespace cellmirror
