#include "rt_core/geometry/pair_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rt_core/base/contract.hpp"

namespace cellmirror::geometry {

namespace {

std::array<float, 3> single(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

float size_of(const WideNode& node, std::size_t place) {
  return node.half[0][place] + node.half[1][place] + node.half[2][place];
}

}  // namespace

float limit_square(double limit) noexcept { return static_cast<float>(std::min(1.000001 * limit * limit, 1e38)); }

WalkFrame::WalkFrame(const Eigen::Matrix3d& R_ON, const Eigen::Vector3d& p_ON_in_O)
    : p_NO(single(-(R_ON.transpose() * p_ON_in_O))), p_ON(single(p_ON_in_O)) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto value = static_cast<float>(R_ON(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
      rotation.R_ON[i][k] = value;
      rotation.absolute_R_ON[i][k] = std::abs(value);
      R_NO[k][i] = value;
      absolute_R_NO[k][i] = std::abs(value);
    }
  }
}

BoxQuery WalkFrame::box_of(const WideNode& node, std::size_t place) const noexcept {
  BoxQuery box;
  const std::array<float, 3> c{node.centre[0][place], node.centre[1][place], node.centre[2][place]};
  const std::array<float, 3> h{node.half[0][place], node.half[1][place], node.half[2][place]};
  const std::array<float, 3> n{node.normal[0][place], node.normal[1][place], node.normal[2][place]};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<float, 3>& R = R_NO[i];
    const std::array<float, 3>& absolute = absolute_R_NO[i];
    box.centre_N[i] = R[0] * c[0] + R[1] * c[1] + R[2] * c[2] + p_NO[i];
    box.reach_N[i] = absolute[0] * h[0] + absolute[1] * h[1] + absolute[2] * h[2];
    box.half_O[i] = h[i];
    box.shift_O[i] = p_ON[i] - c[i];
    box.normal_N[i] = R[0] * n[0] + R[1] * n[1] + R[2] * n[2];
    box.absolute_normal_N[i] = std::abs(box.normal_N[i]);
  }
  box.middle_N = node.middle[place] - (n[0] * p_ON[0] + n[1] * p_ON[1] + n[2] * p_ON[2]);
  box.thick = node.thick[place];
  return box;
}

PairWalk::PairWalk(const WideTree& a, const WideTree& b, const Pose& X_AB) noexcept
    : a_(a),
      b_(b),
      boxes_of_a_(X_AB.linear(), X_AB * b.origin() - a.origin()),
      boxes_of_b_(X_AB.linear().transpose(), X_AB.linear().transpose() * (a.origin() - X_AB * b.origin())),
      bounds_(child_bounds()),
      margin_(kBoundMargin * (a.reach() + b.reach() + (X_AB * b.origin() - a.origin()).norm())),
      least_left_out_(std::numeric_limits<float>::infinity()) {
  set_limit(std::numeric_limits<double>::infinity());
  stack_[size_++] = {0, 0, 0};
}

void PairWalk::set_limit(double limit) noexcept { limit_square_ = limit_square(limit + margin_); }

double PairWalk::least_left_out() const noexcept {
  return std::max(0.0, std::sqrt(static_cast<double>(least_left_out_)) - margin_);
}

bool PairWalk::next(std::uint32_t& triangle_a, std::uint32_t& triangle_b) noexcept {
  while (size_ > 0) {
    const Entry entry = stack_[--size_];
    if (entry.square > limit_square_) {
      least_left_out_ = std::min(least_left_out_, entry.square);
      continue;
    }
    const std::uint32_t child_a = a_.nodes()[entry.place_a / 8].child[entry.place_a % 8];
    const std::uint32_t child_b = b_.nodes()[entry.place_b / 8].child[entry.place_b % 8];
    if ((child_a & child_b & WideTree::kTriangle) != 0) {
      triangle_a = child_a & ~WideTree::kTriangle;
      triangle_b = child_b & ~WideTree::kTriangle;
      return true;
    }
    open(entry);
  }
  return false;
}

void PairWalk::open(const Entry& entry) noexcept {
  const WideNode& node_a = a_.nodes()[entry.place_a / 8];
  const WideNode& node_b = b_.nodes()[entry.place_b / 8];
  const std::size_t in_a = entry.place_a % 8;
  const std::size_t in_b = entry.place_b % 8;
  const std::uint32_t child_a = node_a.child[in_a];
  const std::uint32_t child_b = node_b.child[in_b];
  const bool open_b = (child_a & WideTree::kTriangle) != 0 ||
                      ((child_b & WideTree::kTriangle) == 0 && size_of(node_b, in_b) >= size_of(node_a, in_a));
  alignas(32) std::array<float, 8> squares;
  if (open_b) {
    const WideNode& opened = b_.nodes()[child_b];
    bounds_(opened, boxes_of_a_.rotation, boxes_of_a_.box_of(node_a, in_a), squares.data());
    push(squares, opened, 8 * child_b, true, entry);
  } else {
    const WideNode& opened = a_.nodes()[child_a];
    bounds_(opened, boxes_of_b_.rotation, boxes_of_b_.box_of(node_b, in_b), squares.data());
    push(squares, opened, 8 * child_a, false, entry);
  }
}

void PairWalk::push(const std::array<float, 8>& squares, const WideNode& node, std::uint32_t first, bool opened_b,
                    const Entry& entry) noexcept {
  CELLMIRROR_EXPECTS(size_ + 8 <= kCapacity);
  const std::size_t bottom = size_;
  for (std::uint32_t i = 0; i < 8; ++i) {
    if (node.child[i] == WideTree::kNone) continue;
    if (squares[i] > limit_square_) {
      least_left_out_ = std::min(least_left_out_, squares[i]);
      continue;
    }
    Entry child = entry;
    child.square = std::max(squares[i], entry.square);
    (opened_b ? child.place_b : child.place_a) = first + i;
    // The nearest one ends on top.
    std::size_t at = size_++;
    for (; at > bottom && stack_[at - 1].square < child.square; --at) stack_[at] = stack_[at - 1];
    stack_[at] = child;
  }
}

}  // namespace cellmirror::geometry
