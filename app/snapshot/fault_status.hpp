// Faults of the loop as status shows them.
#pragma once

#include <cstdint>
#include <string>

namespace cellmirror::app {

struct FaultStatus {
  std::uint64_t faults = 0;
  bool latched = false;
  std::string reason;  // of the newest one, e.g. "the loop stood still"; empty where there was none
  std::string last;    // the newest one whose record was due, with the place of that
};

}  // namespace cellmirror::app
