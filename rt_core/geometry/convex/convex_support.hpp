// Support functions of the cores, all in one frame: that of body A, from whose origin everything is counted, so that
// bodies far from the origin of the world lose no digits. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

namespace cellmirror::geometry {

// Written out: Eigen's own are not always inlined at -O2, and these are the innermost loops of all queries.
[[nodiscard]] inline double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline Eigen::Vector3d cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The hull of one, two or three points: a point, segment or triangle.
struct FewPoints {
  std::array<Eigen::Vector3d, 3> points;
  std::size_t count = 1;

  [[nodiscard]] Eigen::Vector3d support(const Eigen::Vector3d& direction) const noexcept {
    std::size_t best = 0;
    double most = dot(points[0], direction);
    for (std::size_t i = 1; i < count; ++i) {
      const double value = dot(points[i], direction);
      if (value > most) {
        most = value;
        best = i;
      }
    }
    return points[best];
  }
};

// At the origin of the frame, along its axes.
struct CentredBox {
  Eigen::Vector3d half;

  [[nodiscard]] Eigen::Vector3d support(const Eigen::Vector3d& direction) const noexcept {
    return {std::copysign(half[0], direction[0]), std::copysign(half[1], direction[1]),
            std::copysign(half[2], direction[2])};
  }
};

// About the z axis of the frame.
struct CentredCylinder {
  double radius;
  double half_length;

  [[nodiscard]] Eigen::Vector3d support(const Eigen::Vector3d& direction) const noexcept {
    const double across = std::sqrt(direction[0] * direction[0] + direction[1] * direction[1]);
    const double scale = across > 0.0 ? radius / across : 0.0;
    return {scale * direction[0], scale * direction[1], std::copysign(half_length, direction[2])};
  }
};

template <typename Centred>
struct Placed {
  Centred shape;
  Eigen::Matrix3d R;  // from its own frame to that of A
  Eigen::Vector3d t;  // m

  [[nodiscard]] Eigen::Vector3d support(const Eigen::Vector3d& direction) const noexcept {
    const Eigen::Vector3d own(dot(R.col(0), direction), dot(R.col(1), direction), dot(R.col(2), direction));
    const Eigen::Vector3d p = shape.support(own);
    return {t[0] + R(0, 0) * p[0] + R(0, 1) * p[1] + R(0, 2) * p[2],
            t[1] + R(1, 0) * p[0] + R(1, 1) * p[1] + R(1, 2) * p[2],
            t[2] + R(2, 0) * p[0] + R(2, 1) * p[1] + R(2, 2) * p[2]};
  }
};

}  // namespace cellmirror::geometry
