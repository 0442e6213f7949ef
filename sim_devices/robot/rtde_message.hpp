// A package of RTDE on its way from a simulated controller to its clients.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/rtde/rtde_messages.hpp"
#include "sim_devices/faults/fault_pipeline.hpp"

namespace cellmirror::sim {

struct RtdeMessage {
  rtde::RobotData data;
  std::vector<std::uint8_t> bytes;  // not empty: sent instead of `data`
};

template <>
struct FaultTraits<RtdeMessage> {
  static constexpr std::uint8_t kRecipe = 1;

  static void encode(RtdeMessage& message) {
    if (message.bytes.empty()) message.bytes = rtde::data_package(message.data, kRecipe);
  }

  // Behind the head: with another length, all that follows would be lost, as `length` does it.
  static void flip_bits(RtdeMessage& message, unsigned bits, Random& random) {
    constexpr std::size_t kHeadBits = 24;
    encode(message);
    for (unsigned i = 0; i < bits; ++i) {
      const auto bit = kHeadBits + random.below(8ULL * message.bytes.size() - kHeadBits);
      message.bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    }
  }
  // A package of another recipe.
  static void change_identity(RtdeMessage& message, std::optional<std::uint32_t>, Random& random) {
    encode(message);
    message.bytes[3] = static_cast<std::uint8_t>(2 + random.below(250));
  }
  // More or fewer bytes than the package's head says.
  static void change_length(RtdeMessage& message, int by) {
    encode(message);
    message.bytes.resize(static_cast<std::size_t>(std::max(static_cast<int>(message.bytes.size()) + by, 3)));
  }
  // Of a type that no client asked for.
  static RtdeMessage foreign(std::optional<std::uint32_t>, Random& random) {
    RtdeMessage message;
    message.bytes = {0, 5, 73, static_cast<std::uint8_t>(random.below(256)), 0};
    return message;
  }
};

}  // namespace cellmirror::sim
