// Walks the trees of two bodies together, nearest parts first, and hands over every pair of triangles that may be as
// near as a limit; the limit may shrink on the way.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/box_bounds.hpp"
#include "rt_core/geometry/wide_tree.hpp"

namespace cellmirror::geometry {

// The square of a limit, rounded up.
[[nodiscard]] float limit_square(double limit) noexcept;
[[nodiscard]] BoxFrame box_frame(const Eigen::Matrix3d& R_NO, const Eigen::Vector3d& p_NO) noexcept;

class PairWalk {
 public:
  // X_AB: of the meshes' frames.
  PairWalk(const WideTree& a, const WideTree& b, const Pose& X_AB) noexcept;

  // Only what is at most this far apart is examined, m; may shrink from call to call.
  void set_limit(double limit) noexcept;
  // A unit vector in A's frame in which the bodies may be well apart.
  void set_direction(const Eigen::Vector3d& n_A) noexcept;
  // A lower bound of the distance of all that was left out, m; infinite where nothing was.
  [[nodiscard]] double least_left_out() const noexcept;

  // The next pair of triangles (in the trees' orders), nearest boxes first in depth; false: there is none left.
  [[nodiscard]] bool next(std::uint32_t& triangle_a, std::uint32_t& triangle_b) noexcept;

 private:
  struct Entry {
    float square;
    std::uint32_t place_a;  // node * 8 + place
    std::uint32_t place_b;
  };
  // Opening replaces an entry by at most eight; neither tree is deeper than MeshTree::kMaxDepth plus two.
  static constexpr std::size_t kCapacity = 7 * 2 * 66 + 8;

  void open(const Entry& entry) noexcept;
  void push(const std::array<float, 8>& squares, std::uint32_t first, bool opened_b, const Entry& entry) noexcept;

  const WideTree& a_;
  const WideTree& b_;
  Eigen::Matrix3d R_BA_;
  BoxFrame a_in_b_;
  BoxFrame b_in_a_;
  BoxQuery box_of_a_;  // in B
  BoxQuery box_of_b_;  // in A
  const BoxKernels& kernels_;
  double margin_ = 0;  // m, of the rounding of bounds in single precision
  float limit_square_ = 0;
  float least_left_out_ = 0;
  std::size_t size_ = 0;
  std::array<Entry, kCapacity> stack_;  // not filled before use: it is large
};

}  // namespace cellmirror::geometry
