// From what touches, what is near and what sensors see to markers for RViz, all in the frame "world". Pure.
#pragma once

#include <set>
#include <span>
#include <string>
#include <utility>

#include "drivers/dds/marker_messages.hpp"
#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::dds {

// In one message, so that it stays within a UDP datagram; what is beyond is not drawn.
inline constexpr std::size_t kMaxDrawnPairs = 256;
inline constexpr std::size_t kMaxDrawnContacts = 512;
inline constexpr std::size_t kMaxDrawnCones = 64;
// A viewer removes a marker that was not refreshed for this time.
inline constexpr std::int64_t kMarkerLifetimeNs = 2'000'000'000;

// "distances": lines between the nearest points, orange within the warning distance, else green; "contacts": red
// spheres. What has no element is left out, and so is what is not finite.
void fill_proximity_markers(RosTime stamp, const ProximityState& state, MarkerArray& message);

// "cones": as long as the reading, or as the range where nothing is seen, one marker for each colour: blue where
// something is seen, grey where nothing is, red in the blind zone and in doubt; "echoes": spheres at the points that
// are seen.
void fill_range_markers(RosTime stamp, std::span<const RangeReading> readings, MarkerArray& message);

// Knows what a viewer shows, and has it removed when it is gone.
class ShownMarkers {
 public:
  // `message`: all markers there are now. Appends the removal of those that were in the message before and are not in
  // this one.
  void update(MarkerArray& message);

 private:
  std::set<std::pair<std::string, std::int32_t>> shown_;
};

}  // namespace cellmirror::dds
