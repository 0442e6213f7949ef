// A JointState on its way from a simulated robot to its topic.
#pragma once

#include <cstddef>
#include <vector>

#include "drivers/dds/ros2_messages.hpp"

namespace cellmirror::sim {

struct JointStateMessage {
  std::size_t writer = 0;
  dds::JointState state;
  std::vector<std::byte> bytes;  // not empty: sent instead of `state`
};

}  // namespace cellmirror::sim
