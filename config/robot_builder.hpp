// Makes the robot of a component from its joints; shared by .mpc files and URDF. Private to this folder.
#pragma once

#include <string>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/cell/component.hpp"

namespace cellmirror {

// Fills joints and the joint parameters of component.robot from its nodes, in the order of the file, and checks the
// chain: at most kMaxJointsPerRobot joints, mimics of joints that are no mimics, the flange beyond the base.
void complete_robot(Component& component, const Place& place, Diagnostics& diagnostics);

}  // namespace cellmirror
