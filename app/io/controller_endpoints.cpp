#include "app/io/controller_endpoints.hpp"

#include "drivers/dds/trajectory_endpoint.hpp"

namespace cellmirror::app {

Result<std::unique_ptr<TrajectoryEndpoint>> make_controller_endpoint(const ControllerConfig& config) {
  return dds::make_trajectory_endpoint(config);
}

}  // namespace cellmirror::app
