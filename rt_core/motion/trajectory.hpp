// A trajectory of all joints of a robot over time, as a ROS 2 controller commands it: computed beforehand, followed by
// the tick. Between two points the joints go on polynomials, of degree 5 where both points have velocities and
// accelerations, 3 where both have velocities, else on straight lines.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rt_core/base/object_id.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_trajectory.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::motion {

// What a point gives beside positions; each includes those before.
enum class KnotOrder : std::uint8_t { positions, velocities, accelerations };

using KnotState = AxisState;

// Of the two ends only what both orders give is used.
struct KnotPair {
  KnotOrder order = KnotOrder::positions;  // the lesser one of both ends
  double duration = 0;                     // s, positive
};
// `t` s behind `from`, within [0, duration].
[[nodiscard]] KnotState interpolate(const KnotPair& pair, const KnotState& from, const KnotState& to, double t) CELL_RT;
// c[0] + c[1] t + ... + c[5] t^5, rad or m over s: what interpolate() evaluates.
[[nodiscard]] std::array<double, 6> polynomial(const KnotPair& pair, const KnotState& from,
                                               const KnotState& to) CELL_RT;

// Immutable while the tick has it.
struct Trajectory {
  std::uint32_t id = 0;        // of this robot, ascending from 1
  Timestamp start = {};        // never: when the tick takes it
  std::uint8_t joints = 0;     // of the robot
  std::uint16_t given = 0;     // the joints (bits) that it moves; the others stay where they stand
  JointValues max_velocity{};  // never exceeded; positive; a joint that cannot follow lags behind
  JointValues deceleration{};  // with which a joint stops; positive
  // Differences to the trajectory at which it fails; 0: none is too large.
  JointValues path_tolerance{};    // while it goes on, rad or m
  JointValues goal_tolerance{};    // at its end, rad or m
  JointValues stopped_velocity{};  // at its end, rad/s or m/s
  double goal_time = 0;            // s behind its end, within which the goal has to be met; 0: no limit
  std::vector<double> times;       // s from the start, ascending
  std::vector<KnotOrder> orders;   // of each point
  std::vector<KnotState> knots;    // point by point, `joints` each

  [[nodiscard]] std::size_t points() const CELL_RT { return times.size(); }
  [[nodiscard]] double duration() const CELL_RT { return times.empty() ? 0.0 : times.back(); }
  [[nodiscard]] const KnotState& knot(std::size_t point, std::size_t joint) const CELL_RT {
    return knots[point * joints + joint];
  }
  [[nodiscard]] std::uint64_t reference_id() const CELL_RT { return object.value(); }

  ObjectId object;
};

// Whether the tick takes it for a robot with that many joints.
[[nodiscard]] bool is_sound(const Trajectory& trajectory, std::size_t joints) CELL_RT;

}  // namespace cellmirror::motion
