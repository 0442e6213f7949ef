// The name of a DDS entity (RTPS 2.3, 8.2.4.1): the participant's prefix of 12 bytes, and 4 of the entity.
#pragma once

#include <array>
#include <cstdint>

namespace cellmirror::dds {

using Guid = std::array<std::uint8_t, 16>;

}  // namespace cellmirror::dds
