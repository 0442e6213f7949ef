// The kinds of solids that are drawn, tested for collision and detected by range sensors.
#pragma once

#include <cstdint>

namespace cellmirror {

// Primitives are centred at the origin of their own frame G; cylinder and capsule lie along its z axis.
enum class Shape : std::uint8_t { box, cylinder, sphere, capsule, mesh };

}  // namespace cellmirror
