// The greatest sizes that anything may have. A cell beyond one is refused when it is loaded, with the number.
#pragma once

#include <cstddef>

namespace cellmirror {

// The engine takes memory for the robots of the cell, and for so many more as may be loaded while it runs.
inline constexpr std::size_t kMaxRobots = 256;
inline constexpr std::size_t kSpareRobots = 16;
inline constexpr std::size_t kMaxJointsPerRobot = 16;
inline constexpr std::size_t kMaxNameLength = 63;   // of one name; a dotted path may be longer
inline constexpr std::size_t kMaxNodes = 20'000;    // frames, joints and workframes of a cell, all detail levels
inline constexpr std::size_t kMaxScriptDepth = 32;  // EXEC_SCRIPT within EXEC_SCRIPT

}  // namespace cellmirror
