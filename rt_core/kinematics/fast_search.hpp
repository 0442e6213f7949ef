// fast_solve() for those who ask for many targets of one chain: the chain is packed once. fast_step.hpp is the door for
// everybody else.
#pragma once

#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/fast_step.hpp"
#include "rt_core/kinematics/packed_chain.hpp"

namespace cellmirror::kinematics {

class FastSearch {
 public:
  explicit FastSearch(const Chain& chain) CELL_RT : chain_(chain), packed_(chain) {}

  // As fast_solve(). `chain` of the constructor has to live as long as this.
  FastResult solve(const Task& task, const Pose& X_BG, std::span<double> q, const FastOptions& options) const CELL_RT;

  [[nodiscard]] const PackedChain& packed() const CELL_RT { return packed_; }

 private:
  const Chain& chain_;
  PackedChain packed_;
};

}  // namespace cellmirror::kinematics
