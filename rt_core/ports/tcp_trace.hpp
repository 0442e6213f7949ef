// The path of a robot's TCP while SET_MODE SMEAR is on (manual 1.2.3): plain data on its way to the picture. SI, world.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "rt_core/base/pose.hpp"

namespace cellmirror {

struct TcpTrace {
  std::string robot;
  std::vector<Eigen::Vector3f> points;  // oldest first: a polyline that is nowhere far from the path
  std::vector<Pose> frames;             // of the TCP along the path, oldest first
};

}  // namespace cellmirror
