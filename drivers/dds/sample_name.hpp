// Which sample of which writer.
#pragma once

#include <array>
#include <cstdint>

namespace cellmirror::dds {

// The writer's GUID and the sample's number there (RTPS 2.3, 8.3.5.4; SampleIdentity of DDS-RPC).
struct SampleName {
  std::array<std::uint8_t, 16> guid{};
  std::int64_t number = 0;

  bool operator==(const SampleName&) const = default;
};

}  // namespace cellmirror::dds
