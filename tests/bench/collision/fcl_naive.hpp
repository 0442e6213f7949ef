// The yardstick: FCL's dynamic tree manager, updated and asked anew in every frame, as most programs use it.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>

#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/pairs.hpp"

namespace cellmirror {

class FclNaive {
 public:
  explicit FclNaive(std::shared_ptr<const collision::PairTable> table);
  ~FclNaive();

  struct Answer {
    std::set<std::pair<std::size_t, std::size_t>> touching;       // bodies
    std::map<std::pair<std::size_t, std::size_t>, double> apart;  // m
  };
  // Over the tested pairs of the table: all that touch, and the distances of all others that are within `warning` (m),
  // or that of the nearest.
  const Answer& check(const CellPoses& poses, double warning);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cellmirror
