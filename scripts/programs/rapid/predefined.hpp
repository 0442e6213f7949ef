// What every program has without declaring it, and what is known but outside the subset.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "scripts/programs/rapid/names.hpp"

namespace cellmirror::program::rapid {

// v5 .. v7000, vmax.
[[nodiscard]] std::optional<Speed> predefined_speed(std::string_view name);

struct Zone {
  bool fine = false;
  double radius_mm = 0;
};
// fine, z0 .. z200.
[[nodiscard]] std::optional<Zone> predefined_zone(std::string_view name);

// Signals are called by the numbers of the ports: di1 .. di1024, do1 .. do1024; di_1 is the same as di1.
struct SignalName {
  bool output = false;
  std::uint32_t number = 1;
};
[[nodiscard]] std::optional<SignalName> signal_of(std::string_view name);

// What to do instead of an instruction or word outside the subset; empty: it is not known.
[[nodiscard]] std::string_view instead_of(std::string_view word);

}  // namespace cellmirror::program::rapid
