#include "config/mesh_reader/polygon.hpp"

#include <Eigen/Geometry>

namespace cellmirror {

namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// The corners in a plane in which the polygon runs counter-clockwise (normal by Newell's method).
std::vector<Vector2d> flatten(std::span<const std::uint32_t> corners, std::span<const Eigen::Vector3d> vertices) {
  const Eigen::Vector3d& o = vertices[corners[0]];
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    normal += (vertices[corners[i]] - o).cross(vertices[corners[(i + 1) % corners.size()]] - o);
  }
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.normalized().cross(u);
  std::vector<Vector2d> flat;
  flat.reserve(corners.size());
  for (const std::uint32_t corner : corners)
    flat.emplace_back((vertices[corner] - o).dot(u), (vertices[corner] - o).dot(v));
  return flat;
}

class EarClipper {
 public:
  explicit EarClipper(std::vector<Vector2d> points) : points_(std::move(points)), next_(points_.size()), prev_(next_) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      next_[i] = (i + 1) % points_.size();
      prev_[next_[i]] = i;
    }
  }

  // Calls add(a, b, c) with the places of three corners for each triangle.
  template <class Add>
  void run(Add add) {
    std::size_t left = points_.size();
    std::size_t at = 0;
    std::size_t refused = 0;
    // Two checks per corner are usual; a malicious polygon that needs more becomes a fan.
    constexpr std::size_t kMostLooks = 8;
    for (std::size_t looks = 0; left > 3 && refused <= left && looks < kMostLooks * points_.size(); ++looks) {
      if (!is_ear(at)) {
        at = next_[at];
        ++refused;
        continue;
      }
      add(prev_[at], at, next_[at]);
      next_[prev_[at]] = next_[at];
      prev_[next_[at]] = prev_[at];
      at = next_[next_[at]];  // not the neighbour, so that a round polygon gives no needles
      --left;
      refused = 0;
    }
    for (std::size_t i = next_[at]; next_[i] != at; i = next_[i]) add(at, i, next_[i]);
  }

 private:
  [[nodiscard]] bool is_ear(std::size_t at) const {
    const Vector2d& a = points_[prev_[at]];
    const Vector2d& b = points_[at];
    const Vector2d& c = points_[next_[at]];
    if (cross(b - a, c - b) <= 0.0) return false;
    for (std::size_t i = next_[next_[at]]; i != prev_[at]; i = next_[i]) {
      const Vector2d& p = points_[i];
      if (p == a || p == b || p == c) continue;
      if (cross(b - a, p - a) >= 0.0 && cross(c - b, p - b) >= 0.0 && cross(a - c, p - c) >= 0.0) return false;
    }
    return true;
  }

  std::vector<Vector2d> points_;
  std::vector<std::size_t> next_;
  std::vector<std::size_t> prev_;
};

}  // namespace

void cut_polygon(std::span<const std::uint32_t> corners, std::span<const Eigen::Vector3d> vertices,
                 std::vector<geometry::TriangleIndices>& triangles) {
  if (corners.size() < 3) return;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({corners[a], corners[b], corners[c]});
  };
  if (corners.size() == 3) return add(0, 1, 2);
  if (corners.size() <= kMostCorners) return EarClipper(flatten(corners, vertices)).run(add);
  for (std::size_t i = 2; i < corners.size(); ++i) add(0, i - 1, i);
}

}  // namespace cellmirror
