// Computes collisions and distances of successive postures: keeps distances between postures and computes only pairs
// that may have become the nearest or may have come within the warning distance. The results equal those of computing
// every pair. Two independent implementations (ours and FCL) check every contact; if they disagree the pair counts as
// touching and is marked doubtful (docs/decisions/).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "rt_core/base/time.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/collision/settings.hpp"
#include "rt_core/ports/proximity_state.hpp"

namespace cellmirror::collision {

struct CheckCounters {
  std::uint64_t checks = 0;
  std::uint64_t pairs_computed = 0;  // narrow phase queries
  std::uint64_t second_opinions = 0;
  std::uint64_t disagreements = 0;
  std::uint64_t doubts = 0;
};

class Checker {
 public:
  Checker();
  ~Checker();
  Checker(const Checker&) = delete;
  Checker& operator=(const Checker&) = delete;

  // The cell has changed, or the rules. What is known about pairs that stay is kept, so that no event repeats.
  void adopt(std::shared_ptr<const CompiledCell> cell, std::shared_ptr<const PairTable> pairs,
             const Settings& settings);

  // Depth and points of a contact cost more than all distances. With a limit, check() computes them for pairs that
  // begin to touch and, in every `period`-th posture, for at most `pairs` of those in continuing contact, the oldest
  // first; the others keep the values of an earlier posture. Contact states and distances are always those of the
  // posture. Initially there is no limit.
  void limit_contacts(std::size_t pairs, std::uint64_t period = 1);

  // The findings at these poses of the adopted cell. `later`: the poses `ahead` later at present velocities, for
  // closing speeds; null: none are reported. `finished` is left to the caller. Valid until the next call. Off the tick.
  const ProximityState& check(const CellPoses& poses, Timestamp posture_time, const CellPoses* later = nullptr,
                              Nanoseconds ahead = Nanoseconds(0));
  // Only whether any tested pair touches; stops at the first. For planning: no events, no distances.
  [[nodiscard]] bool collides(const CellPoses& poses);

  [[nodiscard]] const CheckCounters& counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cellmirror::collision
