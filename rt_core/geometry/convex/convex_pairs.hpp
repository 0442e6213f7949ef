// How a pair of cores is laid out for the algorithms: in the frame of one of them, named A here. Private to this
// folder.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/convex.hpp"
#include "rt_core/geometry/convex/convex_support.hpp"

namespace cellmirror::geometry {

[[nodiscard]] inline bool has_few_points(const ConvexCore& core) noexcept {
  return core.kind == CoreKind::point || core.kind == CoreKind::segment || core.kind == CoreKind::triangle;
}

// Box and cylinder are easiest where they lie along the axes, so that they come first; of a box and a cylinder the
// cylinder does.
[[nodiscard]] inline bool comes_first(const ConvexCore& a, const ConvexCore& b) noexcept {
  const auto rank = [](const ConvexCore& core) {
    if (core.kind == CoreKind::cylinder) return 2;
    return core.kind == CoreKind::box ? 1 : 0;
  };
  return rank(a) >= rank(b);
}

// Pose of B in A, from the difference of the positions: digits that both share cancel first.
struct RelativePose {
  Eigen::Matrix3d R;
  Eigen::Vector3d t;

  RelativePose(const Pose& X_WA, const Pose& X_WB) noexcept {
    const Eigen::Vector3d offset = X_WB.translation() - X_WA.translation();
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Vector3d axis = X_WA.linear().col(i);
      t[i] = dot(axis, offset);
      for (Eigen::Index k = 0; k < 3; ++k) R(i, k) = dot(axis, X_WB.linear().col(k));
    }
  }
  [[nodiscard]] Eigen::Vector3d of(const Eigen::Vector3d& p) const noexcept {
    return t + p[0] * R.col(0) + p[1] * R.col(1) + p[2] * R.col(2);
  }
};

// The points of a point, segment or triangle, in frame A.
[[nodiscard]] inline FewPoints few_points(const ConvexCore& core, const RelativePose& X_AB) noexcept {
  FewPoints out;
  switch (core.kind) {
    case CoreKind::segment: {
      const Eigen::Vector3d along = core.half[2] * X_AB.R.col(2);
      out.points[0] = X_AB.t - along;
      out.points[1] = X_AB.t + along;
      out.count = 2;
      break;
    }
    case CoreKind::triangle:
      for (std::size_t i = 0; i < 3; ++i) out.points[i] = X_AB.of(core.corners[i]);
      out.count = 3;
      break;
    default:
      out.points[0] = X_AB.t;
      break;
  }
  return out;
}
// The same of A's own core.
[[nodiscard]] inline FewPoints few_points(const ConvexCore& core) noexcept {
  FewPoints out;
  out.points[0] = Eigen::Vector3d::Zero();
  if (core.kind == CoreKind::segment) {
    out.points[0] = Eigen::Vector3d(0.0, 0.0, -core.half[2]);
    out.points[1] = -out.points[0];
    out.count = 2;
  } else if (core.kind == CoreKind::triangle) {
    out.points = core.corners;
    out.count = 3;
  }
  return out;
}

// The distance of two cores without their skins, in frame A; `a` comes first.
struct CoreDistance {
  double distance = 0;  // m; a lower bound where it is not certain
  bool certain = true;
  bool beyond = false;  // more than requested; the points are not set
  Eigen::Vector3d p_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_b = Eigen::Vector3d::Zero();
};
[[nodiscard]] CoreDistance core_distance(const ConvexCore& a, const ConvexCore& b, const RelativePose& X_AB,
                                         double up_to) noexcept;

// Greatest extent of both cores together, m.
[[nodiscard]] double size_of(const ConvexCore& a, const ConvexCore& b, const RelativePose& X_AB) noexcept;

}  // namespace cellmirror::geometry
