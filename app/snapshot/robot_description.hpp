// The robots of the cell as one URDF, for viewers that know them only by ROS 2's topics.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/cell/compiled_cell.hpp"

namespace cellmirror::app {

// A URDF whose links are the frames of /tf (RobotStateBuilder::frames): "world", "ROBOT/base", "ROBOT/JOINT",
// "ROBOT/flange", "ROBOT/tcp". What is visible and drawn hangs at the link that carries it, with meshes by file://
// URIs; a capsule is a cylinder and two spheres, since URDF has none. `wanted` says for each robot of the cell whether
// it is in; what moves with another robot or with a mimic joint is left out. Joints keep their names, or are
// ROBOT/JOINT where two robots have the same. Metres and radians. Not for the tick: allocates. Source: ROS's URDF XML
// specification (wiki.ros.org/urdf/XML). `mesh_uri` names the file of a mesh; where it is empty, or gives an empty
// text, the name is a file:// URI.
[[nodiscard]] std::string robot_description(const CompiledCell& cell, const std::vector<bool>& wanted,
                                            const std::function<std::string(std::string_view)>& mesh_uri = {});

}  // namespace cellmirror::app
