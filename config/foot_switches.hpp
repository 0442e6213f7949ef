// What the cell file says of foot switches ([foot_switches]).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "rt_core/base/time.hpp"

namespace cellmirror {

struct FootSwitchSettings {
  std::optional<std::int32_t> key;   // none: bin_ela_shm names it
  std::size_t bytes = 1;             // 8 inputs each
  std::uint32_t mode = 0600;         // of the memory, also of one that bin_ela_shm names
  Nanoseconds debounce{10'000'000};  // 0 to 1 s
  bool online = false;               // at the start
};

}  // namespace cellmirror
