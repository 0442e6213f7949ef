// Faults of the loop as status shows them.
#pragma once

#include <cstdint>
#include <string>

namespace cellmirror::app {

struct FaultStatus {
  std::uint64_t faults = 0;
  bool latched = false;
  std::string last;  // empty where there was none
};

}  // namespace cellmirror::app
