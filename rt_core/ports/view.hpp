// Viewpoint and projection of a view (manual 1.2.3, STVW). Plain data, SI.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/pose.hpp"

namespace cellmirror {

// As a person says it.
struct View {
  Eigen::Vector3d viewpoint = Eigen::Vector3d(0, -5, 2);  // m, world
  Eigen::Vector3d lookpoint = Eigen::Vector3d::Zero();
  double twist = 0;             // rad: the screen turns so far about its own z axis
  double opening_angle = 0.7;   // rad, of the whole picture in vertical direction
  double near_distance = 0.05;  // m: clipping planes, from the viewpoint
  double far_distance = 100;
  bool orthogonal = false;  // parallel projection; its size is that of the perspective one at the lookpoint
};

// As a renderer takes it. The eye's frame E: x to the right of the picture, y up, z out of it towards the viewer.
struct Eye {
  Pose X_WE = Pose::Identity();
  double opening_angle = 0.7;   // rad, vertical; of a perspective projection
  double height_m = 0;          // visible height; above 0: parallel projection
  double near_distance = 0.05;  // 0 and above; a renderer may begin up to 10 mm before the eye
  double far_distance = 100;
};

}  // namespace cellmirror
