// Words of collisions and distances in documents, and how much of them a document has.
#pragma once

#include <cstddef>
#include <string_view>

#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::app {

// Of each list in status and in recorded messages: those that touch, and those that are near.
inline constexpr std::size_t kMostPairsTold = 200;

[[nodiscard]] constexpr std::string_view word(ProximityChange change) {
  switch (change) {
    case ProximityChange::entered_warning:
      return "entered_warning";
    case ProximityChange::touched:
      return "touched";
    case ProximityChange::parted:
      return "parted";
    case ProximityChange::left_warning:
      return "left_warning";
  }
  return "touched";
}

}  // namespace cellmirror::app
