// Postures: how far apart they are, which of the equal ones is the nearest, and a sequence that covers the ranges.
// Internal to the folder.
#pragma once

#include <array>
#include <cstddef>

#include "rt_core/kinematics/chain.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::inverse_kinematics {

// Root of the sum of squared joint differences (rad; a sliding joint's metres in units of unit_of_length()), as
// "nearest" means it.
[[nodiscard]] double distance(const kinematics::Chain& chain, const JointValues& a, const JointValues& b);

// The same posture of the tip with each turning joint moved by whole turns to where it is nearest to `present` within
// its limits. A value that rounding put beyond a limit is put on it.
[[nodiscard]] JointValues nearest_turns(const kinematics::Chain& chain, const JointValues& q,
                                        const JointValues& present);

// What is worth sampling of a variable's range (rad or m): of continuous joints and of more than a turn, one turn.
struct Range {
  double lower = 0;
  double width = 0;
};
[[nodiscard]] Range sampling_range(const kinematics::Chain& chain, std::size_t variable);

// Postures that cover the ranges evenly, however many are taken: an additive low-discrepancy sequence (M. Roberts, The
// unreasonable effectiveness of quasirandom sequences, 2018).
class PostureSpread {
 public:
  explicit PostureSpread(const kinematics::Chain& chain);
  [[nodiscard]] JointValues at(std::size_t index) const;

 private:
  std::size_t n_;
  std::array<Range, kinematics::kMaxVariables> range_{};
  std::array<double, kinematics::kMaxVariables> step_{};
};

}  // namespace cellmirror::inverse_kinematics
