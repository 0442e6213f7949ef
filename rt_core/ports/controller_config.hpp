// A ROS 2 controller of a robot as the cell file describes it: [[controller]]. Plain data, SI.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/ports/ros_presence.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

struct ControllerJoint {
  std::size_t joint = 0;      // of the robot, from 0
  std::string ros_name;       // in messages
  double path_tolerance = 0;  // rad or m; 0: none
  double goal_tolerance = 0;  // likewise
};

struct ControllerConfig {
  std::string robot;
  std::string name;  // in ROS 2, without the slash in front: "arm_controller"; its topics are below it
  int domain = 0;
  std::string interface_address = "127.0.0.1";  // loopback by default
  std::vector<ControllerJoint> joints;
  double goal_time = 0;            // s; 0: no limit
  double stopped_velocity = 0.01;  // rad/s or m/s; 0: any at the end
  bool allow_partial = false;
  double state_rate_hz = 50;  // of the state that it publishes; 0: none
  RosDistribution distribution = RosDistribution::jazzy;
  DdsSecurityConfig security = {};
  Place place = {};
};

}  // namespace cellmirror
