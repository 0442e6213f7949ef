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

// What the bounds lose by single precision, at most, in parts of the lengths involved: a dozen roundings, each of
// 2^-24, in sums of up to four terms.
inline constexpr double kBoundMargin = 64.0 / (1U << 24U);
// The square of a limit, rounded up.
[[nodiscard]] float limit_square(double limit) noexcept;

// How a tree (or box) O and a tree N stand to each other, both in coordinates from their own origins.
struct WalkFrame {
  BoxFrame rotation;
  std::array<std::array<float, 3>, 3> R_NO{};
  std::array<std::array<float, 3>, 3> absolute_R_NO{};
  std::array<float, 3> p_NO{};  // O's origin in N
  std::array<float, 3> p_ON{};

  WalkFrame(const Eigen::Matrix3d& R_ON, const Eigen::Vector3d& p_ON_in_O);
  // The box in a place of a node of O.
  [[nodiscard]] BoxQuery box_of(const WideNode& node, std::size_t place) const noexcept;
};

class PairWalk {
 public:
  // X_AB: of the meshes' frames.
  PairWalk(const WideTree& a, const WideTree& b, const Pose& X_AB) noexcept;

  // Only what is at most this far apart is looked at, m; may shrink from call to call.
  void set_limit(double limit) noexcept;
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
  void push(const std::array<float, 8>& squares, const WideNode& node, std::uint32_t first, bool opened_b,
            const Entry& entry) noexcept;

  const WideTree& a_;
  const WideTree& b_;
  WalkFrame boxes_of_a_;  // O is A, N is B
  WalkFrame boxes_of_b_;
  ChildBounds bounds_;
  double margin_ = 0;  // m, of the rounding of bounds in single precision
  float limit_square_ = 0;
  float least_left_out_ = 0;
  std::size_t size_ = 0;
  std::array<Entry, kCapacity> stack_;  // not filled before use: it is large
};

}  // namespace cellmirror::geometry
