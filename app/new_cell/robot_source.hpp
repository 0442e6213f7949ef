// The robot of a new cell: reads its URDF and finds the files that have to be copied with it. The URDF and what it
// names are input from anywhere: meshes are taken only from the URDF's own folder, from the ROS package that it lies
// in, and from packages that the environment names (AMENT_PREFIX_PATH, ROS_PACKAGE_PATH).
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/new_cell/plan.hpp"
#include "app/new_cell/request.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror::app {

struct RobotSource {
  PlannedRobot robot;              // without the source of its values
  std::vector<PlannedFile> files;  // the URDF, its meshes and what belongs to them
};

// Nothing where there are errors. Reads files, writes none.
[[nodiscard]] std::optional<RobotSource> read_robot_source(const NewCellRequest& request, Diagnostics& diagnostics);

}  // namespace cellmirror::app
