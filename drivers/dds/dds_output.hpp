// Robot states and frames as ROS 2 messages on DDS: sensor_msgs/JointState and tf2_msgs/TFMessage.
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

// Fails where the configuration is wrong, or the interface's address is none of this machine's. Whether the output is
// enabled is the caller's to check. publish() waits neither for the network nor for readers: what a slow reliable
// reader has not confirmed is overwritten and, up to 100 Hz, counted as "dropped". Not for the tick (DDS allocates).
[[nodiscard]] Result<std::unique_ptr<RobotStateOutput>> make_dds_output(const DdsOutputConfig& config);

}  // namespace cellmirror::dds
