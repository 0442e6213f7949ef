// How faults strike JointState samples.
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "sim_devices/faults/fault_pipeline.hpp"
#include "sim_devices/robot/joint_state_message.hpp"

namespace cellmirror::sim {

template <>
struct FaultTraits<JointStateMessage> {
  // Anywhere in the payload, so that lengths and the encapsulation header are struck as well.
  static void flip_bits(JointStateMessage& message, unsigned bits, Random& random) {
    if (message.bytes.empty()) dds::encode(message.state, message.bytes);
    for (unsigned i = 0; i < bits; ++i) {
      const auto bit = random.below(8ULL * message.bytes.size());
      message.bytes[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    }
  }

  // An unknown robot.
  static void change_identity(JointStateMessage& message, std::optional<std::uint32_t>, Random&) {
    for (std::string& name : message.state.name) name = "wrong_" + name;
  }

  // As many names as before, but more or fewer values.
  static void change_length(JointStateMessage& message, int by) {
    for (std::vector<double>* values : {&message.state.position, &message.state.velocity, &message.state.effort}) {
      if (values->empty()) continue;
      values->resize(static_cast<std::size_t>(std::max(static_cast<int>(values->size()) + by, 0)));
    }
  }

  static JointStateMessage foreign(std::optional<std::uint32_t>, Random& random) {
    JointStateMessage message;
    const std::uint64_t joints = 1 + random.below(7);
    for (std::uint64_t i = 0; i < joints; ++i) {
      message.state.name.push_back("stranger_" + std::to_string(i + 1));
      message.state.position.push_back(6.0 * random.fraction() - 3.0);
    }
    return message;
  }
};

}  // namespace cellmirror::sim
