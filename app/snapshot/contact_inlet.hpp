// The contacts of a robot on their way from the collision tests to its drives, which answer a controller.
#pragma once

#include "rt_core/ports/robot_contacts.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::app {

// Writer: the collision worker. Reader: the thread of the robot's stream.
using ContactInlet = Latest<RobotContacts>;

}  // namespace cellmirror::app
