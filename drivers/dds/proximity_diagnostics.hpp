// From what touches and what is near to a ROS 2 diagnostic status. Pure.
#pragma once

#include "drivers/dds/diagnostic_messages.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::dds {

// A state that is older than this is no longer the cell's.
inline constexpr Nanoseconds kFindingsStaleAfter{500'000'000};
// So many pairs are named, those that touch and the nearest ones; the sums count all.
inline constexpr std::size_t kPairsInDiagnostics = 32;

// STALE where the state is older than kFindingsStaleAfter, else ERROR where bodies touch, WARN where some are within
// the warning distance or something is in doubt, else OK.
[[nodiscard]] DiagnosticLevel collision_level(const ProximityState& state, Timestamp now);
// The status "cellmirror: collisions" with that level, sums, and the pairs in words.
[[nodiscard]] DiagnosticStatus collision_status(const ProximityState& state, Timestamp now);

}  // namespace cellmirror::dds
