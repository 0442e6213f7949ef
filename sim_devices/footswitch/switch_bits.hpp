// The byte buffer of the foot switches. Bit 0 of the first byte is input 1. Other programs may hold other bits of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sim_devices/footswitch/switch_plan.hpp"

namespace cellmirror::sim {

// Changes of one instant, at most one store a byte; bits that are not named stay. Inputs beyond the memory are left out
// and counted.
std::size_t put_switches(std::span<std::byte> memory, std::span<const SwitchChange> changes);
[[nodiscard]] std::size_t bytes_for(std::uint32_t input);

}  // namespace cellmirror::sim
