// What a ROS 2 controller of a robot is to its peers on DDS.
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/controller_config.hpp"
#include "rt_core/ports/trajectory_endpoint.hpp"

namespace cellmirror::dds {

// Closed. Takes trajectory_msgs/JointTrajectory on rt/NAME/joint_trajectory, publishes its state on
// rt/NAME/controller_state, and serves the action NAME/follow_joint_trajectory. Fails where the configuration is wrong
// in itself; what the machine lacks is reported by open().
[[nodiscard]] Result<std::unique_ptr<TrajectoryEndpoint>> make_trajectory_endpoint(const ControllerConfig& config);

}  // namespace cellmirror::dds
