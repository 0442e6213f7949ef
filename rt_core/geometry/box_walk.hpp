// Walks the tree of a mesh around one box (of a primitive), nearest parts first, and hands over every triangle that may
// be as near to the box as a limit; the limit may shrink on the way.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/box_bounds.hpp"
#include "rt_core/geometry/wide_tree.hpp"

namespace cellmirror::geometry {

class BoxWalk {
 public:
  // A box about the origin of frame B with a skin, and a mesh whose frame is M.
  BoxWalk(const WideTree& tree, const Pose& X_MB, const Eigen::Vector3d& half, double skin) noexcept;

  // Only what is at most this far from the skin is examined, m; may shrink from call to call.
  void set_limit(double limit) noexcept;
  // A unit vector in M in which the bodies may be well apart.
  void set_direction(const Eigen::Vector3d& n_M) noexcept;
  // A lower bound of the distance of all that was left out, m; infinite where nothing was.
  [[nodiscard]] double least_left_out() const noexcept;

  [[nodiscard]] bool next(std::uint32_t& triangle) noexcept;

 private:
  struct Entry {
    float square;
    std::uint32_t child;
  };
  // Opening replaces an entry by at most eight; the tree is not deeper than MeshTree::kMaxDepth plus two.
  static constexpr std::size_t kCapacity = 7 * 66 + 8;

  void open(std::uint32_t node, float square) noexcept;

  const WideTree& tree_;
  BoxQuery box_;
  const BoxKernels& kernels_;
  double margin_ = 0;  // m, skin less rounding
  float limit_square_ = 0;
  float least_left_out_ = 0;
  std::size_t size_ = 0;
  std::array<Entry, kCapacity> stack_;  // not filled before use: it is large
};

}  // namespace cellmirror::geometry
