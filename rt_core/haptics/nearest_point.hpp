// The point nearest to a goal that meets the constraints of a contact model: the position of a god object (Zilles,
// Salisbury, IROS 1995; Ruspini, Kolarov, Khatib, SIGGRAPH 1997). Exact.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "rt_core/base/real_time.hpp"
#include "rt_core/haptics/contact_model.hpp"

namespace cellmirror::haptics {

// In space no more than three constraints hold a point at a time.
inline constexpr std::size_t kMaxActive = 3;

struct NearestPoint {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  // m
  std::uint8_t active_count = 0;                // of the constraints that hold it
  std::array<std::uint8_t, kMaxActive> active{};
  std::array<double, kMaxActive> multiplier{};  // > 0; x - goal is the sum of multiplier * a
  bool found = true;                            // false: no point meets them all; x is the goal
};

// A constraint whose normal is too short to say anything, or that is not finite, is left out. Bounded time: at most 298
// candidates of a few operations each, one in free space.
[[nodiscard]] NearestPoint nearest_point(const ContactModel& model, const Eigen::Vector3d& goal) CELL_RT;

// How far x is on the forbidden side of the worst constraint, in m of its own; 0 where it meets them all.
[[nodiscard]] double violation(const ContactModel& model, const Eigen::Vector3d& x) CELL_RT;

// A unit basis of the directions that the active constraints hold: its number is the rank, 0 to 3.
struct HeldDirections {
  std::array<Eigen::Vector3d, kMaxActive> unit{};
  std::uint8_t count = 0;

  // The part of v that the constraints leave free.
  [[nodiscard]] Eigen::Vector3d free_part(const Eigen::Vector3d& v) const CELL_RT;
};
[[nodiscard]] HeldDirections held_directions(const ContactModel& model, const NearestPoint& at) CELL_RT;

}  // namespace cellmirror::haptics
