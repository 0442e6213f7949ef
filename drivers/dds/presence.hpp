// How this process shows itself to programs of ROS 2.
#pragma once

#include "rt_core/ports/ros_presence.hpp"

namespace cellmirror::dds {

// Of participants that are made from now on. Any thread.
void set_ros_presence(const RosPresence& presence);

}  // namespace cellmirror::dds
