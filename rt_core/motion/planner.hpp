// Plans moves from commands and the robot's parameters, and checks them in advance: a refused move never reaches the
// tick. Real-time class: worker threads.
#pragma once

#include <span>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::motion {

// Of a joint for which nothing is set.
inline constexpr double kDefaultTurning = 1.0;       // rad/s
inline constexpr double kDefaultSliding = 0.1;       // m/s
inline constexpr double kDefaultRampSeconds = 0.25;  // to its velocity

// The speeds of the joints: the smaller of the active and the maximum value. Where only one of them is set (positive),
// that one; where none is, 1 rad/s or 0.1 m/s, and an acceleration that reaches the velocity within 250 ms.
void set_joint_speeds(const kinematics::Chain& chain, const RobotParameters& parameters, Move& move);

// PTP to `target` (rad or m), which is refused beyond the limits (names the joint). Uses rob_jnt_act_vel, act_acc,
// max_vel, max_acc, PTPmode, vel_profile.
[[nodiscard]] Result<Move> plan_joint_move(const kinematics::Chain& chain, const RobotParameters& parameters,
                                           const JointValues& target);

// Of a move of the TCP.
struct PathPlan {
  Move move;
  JointValues end{};      // the posture in which it ends; rad or m
  double duration_s = 0;  // where nothing slows it down
};
// Straight from the posture `from` to X_BG. The way is tried out in small steps: refused where a step cannot be met or
// leads beyond a limit (says how far it got, which joint, and that a PTP move may do). Uses rob_cart_*,
// rob_jnt_max_vel, min_vel, inverse_class.
[[nodiscard]] Result<PathPlan> plan_linear_move(const kinematics::Chain& chain, const RobotParameters& parameters,
                                                const JointValues& from, const Pose& X_BG);
// The same on the arc through p_BV (m, in the base); the orientation turns about one axis from that at the start to
// that of X_BG. Refused too: points through which there is no circle, or an inverse class that leaves a part of the
// position open.
[[nodiscard]] Result<PathPlan> plan_circular_move(const kinematics::Chain& chain, const RobotParameters& parameters,
                                                  const JointValues& from, const Eigen::Vector3d& p_BV,
                                                  const Pose& X_BG);

// Seconds that a PTP move from rest in `from` takes: the slowest axis.
[[nodiscard]] double duration_of(const Move& joint_move, const JointValues& from, std::size_t joints);

}  // namespace cellmirror::motion
