// The yardstick: FCL's dynamic tree manager, updated and asked anew in every frame, as most programs use it.
#pragma once

#include <memory>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror {

class FclNaive {
 public:
  explicit FclNaive(std::shared_ptr<const collision::PairTable> table);
  ~FclNaive();

  struct Answer {
    std::size_t touching = 0;  // pairs of bodies
    double distance = 0;       // m, of the nearest pair of those that do not touch
  };
  // Over the tested pairs of the table: all that touch, and the distances of all others that are within `warning` (m),
  // or that of the nearest.
  Answer check(const CellPoses& poses, double warning);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cellmirror
