#include "rt_core/ranging/mesh_walk.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "rt_core/base/contract.hpp"
#include "rt_core/geometry/wide_tree.hpp"
#include "rt_core/ranging/cone_bounds.hpp"

namespace cellmirror::ranging {

namespace {

using Eigen::Vector3d;
using geometry::MeshTree;
using geometry::WideNode;
using geometry::WideTree;

class Walk {
 public:
  Walk(const ConeShape& cone, const MeshTree& tree, const Pose& X_SG, Nearest& best)
      : cone_(cone),
        nodes_(tree.wide().nodes()),
        triangles_(tree.triangles()),
        X_SG_(X_SG),
        apex_(-(X_SG.linear().transpose() * X_SG.translation())),
        axis_(X_SG.linear().row(2)),
        best_(best) {
    const WideTree& wide = tree.wide();
    const Vector3d from_origin = apex_ - wide.origin();
    size_ = apex_.norm() + wide.origin().norm() + wide.reach();
    single_size_ = from_origin.norm() + wide.reach();
    for (int i = 0; i < 3; ++i) {
      single_.apex[static_cast<std::size_t>(i)] = static_cast<float>(from_origin[i]);
      single_.axis[static_cast<std::size_t>(i)] = static_cast<float>(axis_[i]);
    }
    single_.sine = static_cast<float>(cone.sine);
    single_.cosine = static_cast<float>(cone.cosine);
    single_.margin = static_cast<float>(kSingleMargin * single_size_ * single_size_);
    set_limit(best.distance);
  }

  std::uint32_t run(std::uint32_t first) {
    nearest_ = first;
    if (first < triangles_.size()) look_at(first);
    push(0);
    while (waiting_ > 0) {
      const Waiting next = stack_[--waiting_];
      if (next.square > single_limit_) continue;
      if ((next.child & WideTree::kTriangle) != 0) {
        look_at(next.child & ~WideTree::kTriangle);
      } else {
        push(next.child);
      }
    }
    return nearest_;
  }

 private:
  struct Waiting {
    float square;  // of a bound of the distance, m^2
    std::uint32_t child;
  };
  // At each of 64 levels at most seven wait while the eighth is examined.
  static constexpr std::size_t kMostWaiting = 512;

  // The children of a node that the cone may meet within the limit; the nearest one ends on top.
  void push(std::uint32_t node) {
    CELLMIRROR_EXPECTS(waiting_ + WideNode::kWidth <= kMostWaiting);
    const WideNode& opened = nodes_[node];
    alignas(32) std::array<float, WideNode::kWidth> squares;
    kernels_.bounds(opened, single_, squares.data());
    const std::size_t bottom = waiting_;
    for (std::size_t i = 0; i < WideNode::kWidth; ++i) {
      if (squares[i] > single_limit_ || opened.child[i] == WideTree::kNone) continue;
      std::size_t at = waiting_++;
      for (; at > bottom && stack_[at - 1].square < squares[i]; --at) stack_[at] = stack_[at - 1];
      stack_[at] = {squares[i], opened.child[i]};
    }
  }

  void look_at(std::uint32_t triangle) {
    const geometry::Triangle& t = triangles_[triangle];
    if (out_of_sight(t)) return;
    const std::array<Vector3d, 3> corners{X_SG_ * t[0], X_SG_ * t[1], X_SG_ * t[2]};
    const double before = best_.distance;
    nearest_on_polygon(cone_, corners, best_);
    if (!(best_.distance < before)) return;
    nearest_ = triangle;
    set_limit(best_.distance);
  }

  // At most the square that marks what is beside the cone, so that it is never examined.
  void set_limit(double limit) {
    limit_ = limit;
    const double with_rounding = (limit + kSingleMargin * single_size_) * (1.0 + kSingleMargin);
    constexpr double kFarthest = 0.5 * static_cast<double>(kBesideCone);
    single_limit_ = static_cast<float>(std::min(with_rounding * with_rounding, kFarthest));
  }

  // Most triangles whose boxes the cone meets are: beside the cone, or of a plane whose nearest point in the cone is
  // too far away. Tested here without transforming the triangle to the sensor's frame and without computing that point.
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
                                  kRounding * size_ * std::sqrt(squared_area)) {
        return true;
      }
    }
    const double along = middle.dot(axis_);
    const Vector3d outward = middle - along * axis_;
    const double across = outward.norm();
    const Vector3d touching = cone_.cosine * outward - (cone_.sine * across) * axis_;
    const double least = std::min(touching.dot(a), std::min(touching.dot(b), touching.dot(c)));
    return least > kRounding * size_ * size_;
  }

  static constexpr double kRounding = 1e-13;  // of differences, in parts of the numbers
  const ConeShape& cone_;
  std::span<const WideNode> nodes_;
  std::span<const geometry::Triangle> triangles_;
  const Pose& X_SG_;
  Vector3d apex_;  // in G
  Vector3d axis_;
  Nearest& best_;
  double size_ = 0;         // m; no double below is a difference of larger numbers
  double single_size_ = 0;  // m; no float is
  double limit_ = 0;        // m, of `best_`
  float single_limit_ = 0;  // m^2
  SingleCone single_;
  const ConeKernels& kernels_ = cone_kernels();
  std::uint32_t nearest_ = 0;
  std::size_t waiting_ = 0;
  std::array<Waiting, kMostWaiting> stack_;
};

}  // namespace

void nearest_on_mesh(const ConeShape& cone, const MeshTree& tree, const Pose& X_SG, Nearest& best,
                     std::uint32_t& triangle) noexcept {
  Walk walk(cone, tree, X_SG, best);
  triangle = walk.run(triangle);
}

}  // namespace cellmirror::ranging
