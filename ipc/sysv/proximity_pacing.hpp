// When a proximity record is worth its place in a queue that the robots' records share. Pure: the time is the state's.
#pragma once

#include <vector>

#include "ipc/wire/proximity_record.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

// A state is due when it differs from the one that was sent last and something touches or is within the warning
// distance, now or then; when that sum changed; and a second after the last one in any case.
class ProximityPacing {
 public:
  static constexpr Nanoseconds kHeartbeat{1'000'000'000};

  // Takes note of it where it is due.
  [[nodiscard]] bool is_due(const ProximityRecord& record);

 private:
  bool any_ = false;
  ProximityRecord last_;
};

}  // namespace cellmirror
