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

BoxFrame box_frame(const Eigen::Matrix3d& R_NO, const Eigen::Vector3d& p_NO) noexcept {
  BoxFrame frame;
  frame.p_NO = single(p_NO);
  for (std::size_t i = 0; i < 3; ++i) frame.R_NO[i] = single(R_NO.row(static_cast<Eigen::Index>(i)));
  return frame;
}

PairWalk::PairWalk(const WideTree& a, const WideTree& b, const Pose& X_AB) noexcept
    : a_(a),
      b_(b),
      R_BA_(X_AB.linear().transpose()),
      kernels_(box_kernels()),
      least_left_out_(std::numeric_limits<float>::infinity()) {
  const Eigen::Vector3d p_AB = X_AB * b.origin() - a.origin();
  a_in_b_ = box_frame(R_BA_, -(R_BA_ * p_AB));
  b_in_a_ = box_frame(X_AB.linear(), p_AB);
  margin_ = kBoundMargin * (a.reach() + b.reach() + p_AB.norm());
  set_limit(std::numeric_limits<double>::infinity());
  stack_[size_++] = {0, 0, 0};
}

void PairWalk::set_direction(const Eigen::Vector3d& n_A) noexcept {
  // A little shorter than 1 also after rounding, so that gaps along it are never overstated.
  const Eigen::Vector3d n = (1 - 1e-6) * n_A;
  box_of_b_.direction = single(n);
  box_of_a_.direction = single(R_BA_ * n);
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
    kernels_.place_box(node_a, in_a, a_in_b_, box_of_a_);
    kernels_.bounds(opened, box_of_a_, squares.data());
    push(squares, 8 * child_b, true, entry);
  } else {
    const WideNode& opened = a_.nodes()[child_a];
    kernels_.place_box(node_b, in_b, b_in_a_, box_of_b_);
    kernels_.bounds(opened, box_of_b_, squares.data());
    push(squares, 8 * child_a, false, entry);
  }
}

void PairWalk::push(const std::array<float, 8>& squares, std::uint32_t first, bool opened_b,
                    const Entry& entry) noexcept {
  CELLMIRROR_EXPECTS(size_ + 8 <= kCapacity);
  const std::size_t bottom = size_;
  std::size_t top = bottom;
  std::size_t nearest = bottom;
  float least = std::numeric_limits<float>::infinity();
  float left_out = least_left_out_;
  // Without branches: whether a box is near enough cannot be predicted. Empty places are infinitely far.
  for (std::uint32_t i = 0; i < 8; ++i) {
    const float square = squares[i];
    const bool kept = !(square > limit_square_);
    Entry& child = stack_[top];
    child.square = std::max(square, entry.square);
    child.place_a = opened_b ? entry.place_a : first + i;
    child.place_b = opened_b ? first + i : entry.place_b;
    left_out = !kept && square < left_out ? square : left_out;
    nearest = kept && square < least ? top : nearest;
    least = kept && square < least ? square : least;
    top += kept ? 1 : 0;
  }
  least_left_out_ = left_out;
  size_ = top;
  // The nearest one comes next; the order of the others matters little.
  if (top > bottom + 1) std::swap(stack_[nearest], stack_[top - 1]);
}

}  // namespace cellmirror::geometry
