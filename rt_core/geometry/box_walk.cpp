#include "rt_core/geometry/box_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/base/contract.hpp"
#include "rt_core/geometry/pair_walk.hpp"

namespace cellmirror::geometry {

BoxWalk::BoxWalk(const WideTree& tree, const Pose& X_MB, const Eigen::Vector3d& half, double skin) noexcept
    : tree_(tree), bounds_(child_bounds()), least_left_out_(std::numeric_limits<float>::infinity()) {
  const Eigen::Vector3d p_MB = X_MB.translation() - tree.origin();
  const WalkFrame frame(X_MB.linear().transpose(), -(X_MB.linear().transpose() * p_MB));
  frame_ = frame.rotation;
  WideNode box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.half[axis][0] = static_cast<float>((1 + 1e-6) * half[static_cast<Eigen::Index>(axis)]);
  }
  box_ = frame.box_of(box, 0);
  margin_ = skin + kBoundMargin * (half.norm() + tree.reach() + p_MB.norm());
  set_limit(std::numeric_limits<double>::infinity());
  stack_[size_++] = {0, 0};
}

void BoxWalk::set_limit(double limit) noexcept { limit_square_ = limit_square(limit + margin_); }

double BoxWalk::least_left_out() const noexcept {
  return std::max(0.0, std::sqrt(static_cast<double>(least_left_out_)) - margin_);
}

bool BoxWalk::next(std::uint32_t& triangle) noexcept {
  while (size_ > 0) {
    const Entry entry = stack_[--size_];
    if (entry.square > limit_square_) {
      least_left_out_ = std::min(least_left_out_, entry.square);
      continue;
    }
    if ((entry.child & WideTree::kTriangle) != 0) {
      triangle = entry.child & ~WideTree::kTriangle;
      return true;
    }
    open(entry.child, entry.square);
  }
  return false;
}

void BoxWalk::open(std::uint32_t index, float square) noexcept {
  CELLMIRROR_EXPECTS(size_ + WideNode::kWidth <= kCapacity);
  const WideNode& node = tree_.nodes()[index];
  alignas(32) std::array<float, WideNode::kWidth> squares;
  bounds_(node, frame_, box_, squares.data());
  const std::size_t bottom = size_;
  for (std::size_t i = 0; i < WideNode::kWidth; ++i) {
    if (node.child[i] == WideTree::kNone) continue;
    if (squares[i] > limit_square_) {
      least_left_out_ = std::min(least_left_out_, squares[i]);
      continue;
    }
    const Entry child{std::max(square, squares[i]), node.child[i]};
    // The nearest one ends on top.
    std::size_t at = size_++;
    for (; at > bottom && stack_[at - 1].square < child.square; --at) stack_[at] = stack_[at - 1];
    stack_[at] = child;
  }
}

}  // namespace cellmirror::geometry
