// The surroundings of an instrument's tip for the tick: a few linear constraints, computed by a worker. Fixed size, so
// that it crosses threads in a Latest. World frame, SI.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "rt_core/base/time.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::haptics {

inline constexpr std::size_t kMaxConstraints = 12;

// The tip's origin x (m) is free as long as a . (x - x_ref) + gap >= 0. `a` is the unit normal of the surface for a
// contact at the tip, and shorter or longer for one at the shaft, which moves less or more than the tip does.
struct ContactConstraint {
  Eigen::Vector3d a = Eigen::Vector3d::UnitZ();
  double gap = 0;                                     // m; negative: overlap at the reference posture
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of the surface, unit vector away from the obstacle
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    // on the instrument, where it would touch
};

struct ContactModel {
  std::uint64_t sequence = 0;  // counted by the worker, from 1
  Timestamp posture_time;      // of the tick whose posture it was computed for
  std::uint8_t slot = 0;       // of the instrument's robot
  bool certain = true;         // false: something could not be settled; treat what is near as touching
  std::uint64_t cell = 0;      // counted by the worker: another number where the cell was changed in between
  Eigen::Vector3d x_ref = Eigen::Vector3d::Zero();  // the tip's origin in that posture
  // The joints of that posture, rad or m: an instrument whose tip is not at x_ref with them is another one, with
  // another tool centre point or base. None: unknown.
  std::uint8_t joint_count = 0;
  JointValues q{};
  double reach = 0;  // m: everything nearer than this to the instrument is in; the proxy stays within it. 0: all is in
  std::uint8_t count = 0;
  std::array<ContactConstraint, kMaxConstraints> constraints{};
};

}  // namespace cellmirror::haptics
