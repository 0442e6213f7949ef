// What of a target pose has to be met: the classes of rob_inverse_class (manual 1.2.2) as a few independent choices.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::kinematics {

enum class OrientationTask : std::uint8_t {
  free,      // any orientation will do
  full,      // all three axes
  normal,    // the tool's x axis (n) points as the target's; the rotation about it is free
  sliding,   // the tool's y axis (s)
  approach,  // the tool's z axis (a)
};

// What decides between postures that meet the task equally well.
enum class Secondary : std::uint8_t {
  nearest_present,  // smallest sum of squared joint differences from the present posture
  // Smallest sum of squared joint values (rad, from the straight boom) of the joints that bends() names, and of
  // differences from the present posture of the others: a snake bends evenly.
  even_bend,
};

struct Task {
  std::uint8_t position_axes = 0b111;  // bit 0 x, bit 1 y, bit 2 z of the frame in which the target is given
  OrientationTask orientation = OrientationTask::full;
  bool orientation_required = true;  // false: "try to align": as near as possible after everything that is required
  Secondary secondary = Secondary::nearest_present;
  std::uint8_t bent_joints = 0;  // of even_bend: the last turning joints, so many; 0: all turning joints
};

// The task of a class on this chain. EDITH and BOOM_n depend on what the chain can do; docs/kinematics.md defines them.
[[nodiscard]] Task task_of(InverseClass inverse_class, const Chain& chain);

// Of even_bend: whether the variable is one of those that bend evenly.
[[nodiscard]] bool bends(const Chain& chain, const Task& task, std::size_t variable) CELL_RT;

// The rows of the task as one vector, expressed in the target's reference frame (the base): three of position (m), of
// which those that the task does not name are zero, and three of orientation (rad). For a vector task the rotation
// vector that turns the tool's axis into the target's by the shortest way (perpendicular to the tool's axis; of length
// pi when they are opposite).
[[nodiscard]] Twist task_error(const Task& task, const Pose& X_BT, const Pose& X_BG) CELL_RT;

// Whether every component that the task requires is within `tolerance` (m, rad).
[[nodiscard]] bool meets(const Task& task, const Twist& error, double tolerance) CELL_RT;

}  // namespace cellmirror::kinematics
