#include "rt_core/geometry/box_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/base/contract.hpp"
#include "rt_core/geometry/pair_walk.hpp"

namespace cellmirror::geometry {

BoxWalk::BoxWalk(const WideTree& tree, const Pose& X_MB, const Eigen::Vector3d& half, double skin) noexcept
    : tree_(tree), kernels_(box_kernels()), least_left_out_(std::numeric_limits<float>::infinity()) {
  const Eigen::Vector3d p_MB = X_MB.translation() - tree.origin();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    box_.centre[i] = static_cast<float>(p_MB[row]);
    box_.half[i] = static_cast<float>((1 + 1e-6) * half[row]);
    for (std::size_t k = 0; k < 3; ++k) {
      box_.axes[k][i] = static_cast<float>(X_MB.linear()(row, static_cast<Eigen::Index>(k)));
    }
  }
  margin_ = skin + kBoundMargin * (half.norm() + tree.reach() + p_MB.norm());
  set_limit(std::numeric_limits<double>::infinity());
  stack_[size_++] = {0, 0};
}

void BoxWalk::set_limit(double limit) noexcept { limit_square_ = limit_square(limit + margin_); }

void BoxWalk::set_direction(const Eigen::Vector3d& n_M) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    box_.direction[i] = static_cast<float>((1 - 1e-6) * n_M[static_cast<Eigen::Index>(i)]);
  }
}

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
  kernels_.bounds(node, box_, squares.data());
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
