#include "rt_core/ranging/mesh_walk.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "rt_core/base/contract.hpp"

namespace cellmirror::ranging {

namespace {

using Eigen::Vector3d;
using geometry::MeshTree;

class Walk {
 public:
  Walk(const ConeShape& cone, const MeshTree& tree, const Pose& X_SG, Nearest& best)
      : cone_(cone),
        nodes_(tree.nodes()),
        triangles_(tree.triangles()),
        X_SG_(X_SG),
        apex_(-(X_SG.linear().transpose() * X_SG.translation())),
        axis_(X_SG.linear().row(2)),
        best_(best),
        limit_(best.distance),
        squared_limit_(limit_ * limit_) {}

  void look_at(std::uint32_t triangle) {
    const geometry::Triangle& t = triangles_[triangle];
    if (out_of_sight(t)) return;
    const std::array<Vector3d, 3> corners{X_SG_ * t[0], X_SG_ * t[1], X_SG_ * t[2]};
    const double before = best_.distance;
    nearest_on_polygon(cone_, corners, best_);
    if (!(best_.distance < before)) return;
    nearest_ = triangle;
    limit_ = best_.distance;
    squared_limit_ = limit_ * limit_;
  }

  std::uint32_t run(std::uint32_t first) {
    nearest_ = first;
    if (first < triangles_.size()) look_at(first);
    std::uint32_t at = 0;
    double bound = bound_of(nodes_[0]);
    std::size_t waiting = 0;
    for (;;) {
      if (bound < squared_limit_) {
        const MeshTree::Node& node = nodes_[at];
        if (!node.leaf()) {
          const std::uint32_t left = at + 1;
          const std::uint32_t right = node.right;
          const double at_left = bound_of(nodes_[left]);
          const double at_right = bound_of(nodes_[right]);
          const bool left_first = at_left <= at_right;
          const double later = left_first ? at_right : at_left;
          if (later < squared_limit_) stack_[waiting++] = {later, left_first ? right : left};
          at = left_first ? left : right;
          bound = left_first ? at_left : at_right;
          continue;
        }
        for (std::uint32_t i = node.right; i < node.right + node.count; ++i) look_at(i);
      }
      if (waiting == 0) return nearest_;
      --waiting;
      at = stack_[waiting].node;
      bound = stack_[waiting].bound;
    }
  }

 private:
  struct Waiting {
    double bound;
    std::uint32_t node;
  };
  static constexpr std::size_t kDeepest = 64;  // levels of a tree

  // The square of a distance that nothing of the box in the cone is below; infinite where nothing is in the cone.
  [[nodiscard]] double bound_of(const MeshTree::Node& node) const {
    const Vector3d half = 0.5 * (node.upper - node.lower);
    const Vector3d d = 0.5 * (node.upper + node.lower) - apex_;
    const double squared = (d.cwiseAbs() - half).cwiseMax(0.0).squaredNorm();
    if (!(squared < squared_limit_)) return kNever;
    // The plane that touches the cone along the line nearest to the box's centre; its normal, times `across`.
    const double along = d.dot(axis_);
    const Vector3d outward = d - along * axis_;
    const double squared_across = outward.squaredNorm();
    const double across = std::sqrt(squared_across);
    const Vector3d normal = cone_.cosine * outward - (cone_.sine * across) * axis_;
    const double centre = cone_.cosine * squared_across - cone_.sine * across * along;
    const double reach = normal.cwiseAbs().dot(half);
    if (centre > reach + kRounding * across * (apex_size_ + reach + across)) return kNever;
    return squared;
  }

  // Most triangles of a leaf are: beside the cone, or of a plane whose nearest point in the cone is too far away. Asked
  // here without turning the triangle into the sensor's frame and without telling where that point is.
  [[nodiscard]] bool out_of_sight(const geometry::Triangle& t) const {
    const Vector3d a = t[0] - apex_;
    const Vector3d b = t[1] - apex_;
    const Vector3d c = t[2] - apex_;
    // Seen along the way to its middle, a small triangle is nowhere much nearer than its nearest corner.
    const Vector3d middle = (a + b + c) * (1.0 / 3.0);
    const double nearest_corner = std::min(middle.dot(a), std::min(middle.dot(b), middle.dot(c)));
    constexpr double kMargin = 1.0 + 1e-9;
    const double limit = limit_ * kMargin;
    if (nearest_corner > 0.0 && nearest_corner * nearest_corner > limit * limit * middle.squaredNorm()) return true;
    const Vector3d first = b - a;
    const Vector3d last = c - a;
    const Vector3d normal = first.cross(last);
    const double squared_area = normal.squaredNorm();
    constexpr double kSound = 1e-6;  // of needles the normal is not known well enough
    if (squared_area > kSound * first.squaredNorm() * last.squaredNorm()) {
      double d = normal.dot(a);
      double ahead = normal.dot(axis_);
      if (d < 0.0) {
        d = -d;
        ahead = -ahead;
      }
      if (d * d > limit * limit * squared_area) return true;
      const double across = std::sqrt(std::max(0.0, squared_area - ahead * ahead));
      const bool foot_within = ahead > 0.0 && ahead * ahead >= cone_.cosine * cone_.cosine * squared_area;
      if (!foot_within && d > limit * std::max(0.0, cone_.sine * across + cone_.cosine * ahead) +
                                  kRounding * apex_size_ * std::sqrt(squared_area)) {
        return true;
      }
    }
    const double along = middle.dot(axis_);
    const Vector3d outward = middle - along * axis_;
    const double across = outward.norm();
    const Vector3d touching = cone_.cosine * outward - (cone_.sine * across) * axis_;
    const double least = std::min(touching.dot(a), std::min(touching.dot(b), touching.dot(c)));
    return least > kRounding * across * (apex_size_ + middle.cwiseAbs().sum() + first.cwiseAbs().sum());
  }

  static constexpr double kRounding = 1e-13;  // of numbers that were subtracted, in parts of them
  static constexpr double kNever = 1e300;
  const ConeShape& cone_;
  std::span<const MeshTree::Node> nodes_;
  std::span<const geometry::Triangle> triangles_;
  const Pose& X_SG_;
  Vector3d apex_;  // in G
  Vector3d axis_;
  double apex_size_ = apex_.norm();
  Nearest& best_;
  double limit_;  // of `best_`
  double squared_limit_;
  std::uint32_t nearest_ = 0;
  std::array<Waiting, kDeepest> stack_;
};

}  // namespace

void nearest_on_mesh(const ConeShape& cone, const MeshTree& tree, const Pose& X_SG, Nearest& best,
                     std::uint32_t& triangle) noexcept {
  CELLMIRROR_EXPECTS(tree.depth() <= 64);
  Walk walk(cone, tree, X_SG, best);
  triangle = walk.run(triangle);
}

}  // namespace cellmirror::ranging
