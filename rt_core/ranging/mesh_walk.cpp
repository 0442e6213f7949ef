#include "rt_core/ranging/mesh_walk.hpp"

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
        squared_limit_(best.distance * best.distance) {}

  void look_at(std::uint32_t triangle) {
    const geometry::Triangle& t = triangles_[triangle];
    const std::array<Vector3d, 3> corners{X_SG_ * t[0], X_SG_ * t[1], X_SG_ * t[2]};
    const double before = best_.distance;
    nearest_on_polygon(cone_, corners, best_);
    if (!(best_.distance < before)) return;
    nearest_ = triangle;
    squared_limit_ = best_.distance * best_.distance;
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
    // Rounding errors of a box that just touches the plane, as large as the numbers that were subtracted.
    constexpr double kRounding = 1e-13;
    if (centre > reach + kRounding * across * (apex_size_ + reach + across)) return kNever;
    return squared;
  }

  static constexpr double kNever = 1e300;
  const ConeShape& cone_;
  std::span<const MeshTree::Node> nodes_;
  std::span<const geometry::Triangle> triangles_;
  const Pose& X_SG_;
  Vector3d apex_;  // in G
  Vector3d axis_;
  double apex_size_ = apex_.norm();
  Nearest& best_;
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
