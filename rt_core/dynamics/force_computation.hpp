// The forces of all robots of a cell at one instant: efforts of the drives, wrenches in the joints, forces at the tool
// centre points. Keeps the estimate of the accelerations from call to call. Formula: see inverse_dynamics.hpp.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/time.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/dynamics/inverse_dynamics.hpp"
#include "rt_core/dynamics/motion_estimate.hpp"
#include "rt_core/dynamics/robot_mechanism.hpp"
#include "rt_core/ports/force_state.hpp"
#include "rt_core/ports/haptic_state.hpp"
#include "rt_core/ports/instrument_load.hpp"

namespace cellmirror::dynamics {

struct NotComputed {
  std::string robot;
  std::string why;
};

// What is known of the motion of one robot; rad, rad/s (m, m/s).
struct RobotMotion {
  Timestamp time;         // of the values: of a mirrored robot the receive time of the sample
  bool mirrored = false;  // the velocities were measured, or estimated by the stream
  bool fresh = true;      // false: the robot counts as standing still
  JointValues position{};
  JointValues velocity{};
};

// One thread, not for the tick: allocates when the cell has changed.
class ForceComputation {
 public:
  // In the world, m/s2.
  explicit ForceComputation(const Eigen::Vector3d& gravity_W) : gravity_W_(gravity_W) {}

  // True where the mechanisms are other ones than before.
  bool take_cell(const std::shared_ptr<const CompiledCell>& cell);
  // Computes the robots with masses, with the instrument of a haptic device, or in tissue, at `time`. The force at the
  // TCP is the contact force of the haptic device, else that of tissue; for a robot with masses also the load that is
  // attached at or beyond the TCP's link (RobotMechanism::load). `motions`: of the robots of the cell, in its order;
  // `haptics`: the devices; `loads`: of tissue on instruments, null: none. Call it after take_cell().
  void compute(Timestamp time, std::span<const RobotMotion> motions, std::span<const HapticState> haptics,
               const InstrumentLoads* loads, ForceState& state);

  [[nodiscard]] bool has_mechanisms() const { return has_mechanisms_; }
  [[nodiscard]] const std::vector<NotComputed>& not_computed() const { return not_computed_; }
  // How often the effort of some joint has exceeded its limit.
  [[nodiscard]] std::uint64_t limit_warnings() const { return limit_warnings_; }

 private:
  // Of a robot slot.
  struct SlotState {
    MotionEstimate motion;
    std::array<bool, kMaxJointsPerRobot> beyond_limit{};
  };

  [[nodiscard]] SlotState& slot_state(std::size_t slot);
  void update_motions(std::span<const RobotMotion> motions);
  void compute_robot(const RobotMechanism& robot, RobotForces& out);
  void place_links(const Mechanism& mechanism, std::span<const double> q);
  void compute_contact(const HapticState* haptic, const InstrumentLoad* load, std::size_t robot, RobotForces& out);
  void compute_joints_of_load(const CompiledRobot& robot, RobotForces& out);
  void add_load(const Mechanism& load, const DynamicsInput& motion, RobotForces& out);
  void check_limits(const RobotForces& robot);

  Eigen::Vector3d gravity_W_;
  std::shared_ptr<const CompiledCell> cell_;
  std::vector<RobotMechanism> mechanisms_;  // one a robot of the cell
  bool has_mechanisms_ = false;
  std::vector<NotComputed> not_computed_;
  std::vector<SlotState> slots_;        // by slot, as the positions
  std::vector<JointValues> positions_;  // rad or m
  std::uint64_t limit_warnings_ = 0;
  CellPoses poses_;
  // Of the robot that is being computed.
  DynamicsOutput output_;
  std::array<Pose, kMaxLinks> X_WJ_;
};

}  // namespace cellmirror::dynamics
