// Makes the endpoint of a ROS 2 controller that a cell file describes.
#pragma once

#include <memory>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/controller_config.hpp"
#include "rt_core/ports/trajectory_endpoint.hpp"

namespace cellmirror::app {

// Closed. Fails for what can never work.
Result<std::unique_ptr<TrajectoryEndpoint>> make_controller_endpoint(const ControllerConfig& config);

}  // namespace cellmirror::app
