#include "rt_core/geometry/inside.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

// Directions that no drawn edge has; the next is taken where the last one met an edge.
constexpr std::array<std::array<double, 3>, 6> kDirections = {{{0.8235, 0.4211, 0.3803},
                                                               {-0.3947, 0.7681, 0.5043},
                                                               {0.2893, -0.5519, 0.7821},
                                                               {-0.6173, -0.4637, -0.6353},
                                                               {0.5417, 0.1873, -0.8194},
                                                               {-0.1319, -0.9371, 0.3229}}};
// Volumes below this part of the product of their edges have no sign that rounding could not turn.
constexpr double kUnsure = 1e-13;

Vector3d cross(const Vector3d& a, const Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Ray {
  Vector3d from;
  Vector3d direction;
  Vector3d inverse;
  double slack = 0;  // m, so that rounding loses no box

  [[nodiscard]] bool meets(const MeshTree::Node& node) const {
    double enter = 0;
    double leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (node.lower[axis] - slack - from[axis]) * inverse[axis];
      const double b = (node.upper[axis] + slack - from[axis]) * inverse[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
  }
};

enum class Side { negative = -1, unsure = 0, positive = 1 };

Side side_of(double volume, double scale) {
  if (std::abs(volume) <= kUnsure * scale) return Side::unsure;
  return volume > 0 ? Side::positive : Side::negative;
}

// +1 where the ray leaves through the triangle's front, -1 where it enters; nothing: undecided.
std::optional<int> crossing(const Ray& ray, const Triangle& t) {
  const Vector3d a = t[0] - ray.from;
  const Vector3d b = t[1] - ray.from;
  const Vector3d c = t[2] - ray.from;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  const Side u = side_of(ray.direction.dot(cross(b, c)), lb * lc);
  const Side v = side_of(ray.direction.dot(cross(c, a)), lc * la);
  const Side w = side_of(ray.direction.dot(cross(a, b)), la * lb);
  const bool any_positive = u == Side::positive || v == Side::positive || w == Side::positive;
  const bool any_negative = u == Side::negative || v == Side::negative || w == Side::negative;
  if (any_positive && any_negative) return 0;
  if (u == Side::unsure || v == Side::unsure || w == Side::unsure) return std::nullopt;
  // The line goes through; in front of the point where the tetrahedron is turned as the direction is.
  const Side front = side_of(a.dot(cross(b, c)), la * lb * lc);
  if (front == Side::unsure) return std::nullopt;
  if (front != u) return 0;
  return any_positive ? 1 : -1;
}

std::optional<int> count_crossings(const MeshTree& tree, const Ray& ray) {
  std::array<std::uint32_t, MeshTree::kMaxDepth + 1> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  int sum = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const MeshTree::Node& node = tree.nodes()[index];
    if (!ray.meets(node)) continue;
    if (!node.leaf()) {
      stack[size++] = node.right;
      stack[size++] = index + 1;
      continue;
    }
    for (std::uint32_t i = node.right; i < node.right + node.count; ++i) {
      const std::optional<int> crossed = crossing(ray, tree.triangles()[i]);
      if (!crossed) return std::nullopt;
      sum += *crossed;
    }
  }
  return sum;
}

int winding_by_angles(const MeshTree& tree, const Vector3d& p) {
  double sum = 0;
  for (const Triangle& t : tree.triangles()) {
    const Vector3d a = t[0] - p;
    const Vector3d b = t[1] - p;
    const Vector3d c = t[2] - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum += 2 * std::atan2(a.dot(cross(b, c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  const double turns = sum / (4 * std::numbers::pi);
  return std::isfinite(turns) ? static_cast<int>(std::lround(turns)) : 0;
}

bool in_box(const MeshTree::Node& box, const Vector3d& p) {
  return (p.array() >= box.lower.array()).all() && (p.array() <= box.upper.array()).all();
}

}  // namespace

int winding_number(const MeshTree& tree, const Vector3d& p) noexcept {
  const MeshTree::Node& root = tree.nodes()[0];
  if (!in_box(root, p)) return 0;
  const double slack = 1e-12 * (root.lower.cwiseAbs().maxCoeff() + root.upper.cwiseAbs().maxCoeff());
  for (const std::array<double, 3>& d : kDirections) {
    const Vector3d direction(d[0], d[1], d[2]);
    const std::optional<int> winding = count_crossings(tree, {p, direction, direction.cwiseInverse(), slack});
    if (winding) return *winding;
  }
  return winding_by_angles(tree, p);
}

bool contains(const MeshTree& tree, const Vector3d& p) noexcept {
  return tree.mesh().closed && winding_number(tree, p) != 0;
}

bool contains_a_shell(const MeshTree& outer, const MeshTree& inner, const Pose& X_OuterInner, Vector3d& p) noexcept {
  if (!outer.mesh().closed) return false;
  const MeshTree::Node& box = outer.nodes()[0];
  for (const MeshTree::Shell& shell : inner.shells()) {
    const bool within = std::all_of(shell.extremes.begin(), shell.extremes.end(),
                                    [&](const Vector3d& extreme) { return in_box(box, X_OuterInner * extreme); });
    if (!within) continue;
    p = X_OuterInner * shell.extremes[0];
    if (winding_number(outer, p) != 0) return true;
  }
  return false;
}

}  // namespace cellmirror::geometry
