// What the queries between two shapes answer.
#pragma once

#include <Eigen/Core>

namespace cellmirror::geometry {

// The nearest points of two shapes, both in the frame in which the shapes were given.
struct ClosestPoints {
  double distance = 0;  // m, never negative; 0: they touch or overlap, and the points are a common point
  Eigen::Vector3d p_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_b = Eigen::Vector3d::Zero();
};

// How deep two convex shapes overlap: moving b by depth * normal just parts them, and no shorter way does.
struct Penetration {
  double depth = 0;                                  // m
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit vector from a to b
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   // in the middle of the overlap along the normal
};

}  // namespace cellmirror::geometry
