// A chain and a target in the form that the damped search reads: plain numbers, no Eigen, so that the same source can
// be compiled for several instruction sets. Internal to the folders of kinematics.
#pragma once

#include <array>
#include <cstdint>

#include "rt_core/kinematics/chain.hpp"
#include "rt_core/kinematics/task.hpp"

namespace cellmirror::kinematics {

// The turn u = multiplier * q + offset about z (prismatic: the way multiplier * q + slide along z and the constant turn
// `offset`), then the way t in the turned frame, then a turn about x. Between two joints lies any constant rotation:
// its Euler angles are z, x, z, and the outer two are part of the turns of the joints before and after.
struct PackedJoint {
  double offset = 0;  // rad
  double multiplier = 1;
  double slide = 0;  // in the unit of length
  std::array<double, 3> t{};
  double cos_x = 1;
  double sin_x = 0;
  std::uint8_t variable = 0;
  bool prismatic = false;
};

// Lengths, and with them the values of prismatic joints, are in units of `length`, so that a metre of error and a
// radian weigh alike on arms of any size.
struct PackedChain {
  explicit PackedChain(const Chain& chain) CELL_RT;

  // How q of the chain (rad, m) reads here and back.
  [[nodiscard]] double packed(std::size_t variable, double value) const CELL_RT { return value * scale[variable]; }

  int joints = 0;
  int variables = 0;
  bool plain = true;
  double length = 1;                // m
  double reach = 0;                 // m; from the first joint to the tip at most
  std::array<double, 9> start_R{};  // columns x, y, z
  std::array<double, 3> start_p{};
  std::array<double, 9> tool_R{};  // the tip's rotation in the frame after the last joint, column by column
  std::array<PackedJoint, kMaxChainJoints> joint{};
  std::array<double, kMaxVariables> lower{};
  std::array<double, kMaxVariables> upper{};
  std::array<double, kMaxVariables> scale{};  // 1 for turning variables, 1 / length for sliding ones
};

// A target for a task.
struct PackedGoal {
  PackedGoal(const PackedChain& chain, const Task& task, const Pose& X_BG) CELL_RT;

  std::array<double, 3> p{};
  std::array<double, 3> row{};   // 1 for a coordinate that counts, 0 for one that does not
  std::array<double, 9> R{};     // full: where the frame after the last joint has to point, column by column
  std::array<double, 3> tool{};  // vector tasks: the tool's axis in the frame after the last joint
  std::array<double, 3> aim{};   // vector tasks: where it has to point
  OrientationTask orientation = OrientationTask::full;
};

}  // namespace cellmirror::kinematics
