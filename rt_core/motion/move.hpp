// One canonical motion command for one robot, as the owner of the cell gives it to the tick: SI, explicit frames, fixed
// size. Whatever the language or command a motion comes from, it ends as one of these.
#pragma once

#include <cstddef>
#include <cstdint>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/real_time.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/kinematics/task.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::motion {

enum class MoveKind : std::uint8_t {
  joints,    // point to point (PTP)
  linear,    // the TCP on a straight line, the orientation about one axis
  circular,  // the TCP on the arc through a via point, the orientation about one axis
  delay,     // stand still for a time
};

// What a new move does to the one that is running.
enum class Start : std::uint8_t {
  supersede,  // takes the place of whatever runs or waits. Same kind: blended, from the present position and velocity;
              // another kind: after the running move has braked on its own path
  queue,      // waits its turn; between two moves of the TCP, and between two PTP moves, the next one begins at the
              // fly point of the one before
};

struct Move {
  MoveKind kind = MoveKind::joints;
  Start start = Start::supersede;
  std::uint32_t id = 0;  // of this robot, ascending from 1
  VelocityProfile profile = VelocityProfile::sine;
  PtpMode ptp_mode = PtpMode::synchronous;  // joints

  // Never exceeded at any tick. rad/s or m/s, positive.
  JointValues max_velocity{};
  // Linear and circular: a joint that moves at all moves at least this fast (stepping motors): manual, rob_jnt_min_vel.
  JointValues min_velocity{};

  // joints; the acceleration also where a move of the TCP has to brake off its way (0: within a tenth of a second). It
  // is the one that, with the velocity, gives the duration of the acceleration period (manual, rob_cart_lin_acc: 1200
  // mm/s and 4800 mm/s2 take 250 ms); a sine profile has pi/2 times as much at its steepest.
  JointValues target{};        // rad or m
  JointValues velocity{};      // of the cruise; rad/s or m/s
  JointValues acceleration{};  // rad/s2 or m/s2

  // linear and circular; scaled already
  Pose X_BG = Pose::Identity();                    // where the TCP ends, in the base of the robot
  kinematics::Task task;                           // what of it has to be met
  double linear_velocity = 0;                      // m/s
  double linear_acceleration = 0;                  // m/s2, as above
  double rotational_velocity = 0;                  // rad/s
  double rotational_acceleration = 0;              // rad/s2
  Eigen::Vector3d p_BV = Eigen::Vector3d::Zero();  // m; circular: a point on the arc between its ends

  // All but delay: where the next move may begin. 0: not before this one has ended.
  FlyType fly_type = FlyType::distance;
  double fly_parameter = 0;  // fraction 0..1, m or rad, by fly_type

  double delay_s = 0;  // delay

  // When it should have begun, if that has passed and the robot is at rest: it makes up for the lost time
  // (kMostCatchUp). Never: it begins in its turn.
  Timestamp begin;
  // Where `begin` is never and it finds the robot standing, no longer than kMostCatchUp after the move before arrived:
  // as if it had been there then. For moves that are given one after the other.
  bool follows_on = false;
};

// Whether the tick takes this move of a robot with that many joints: everything finite, the velocities and
// accelerations that it uses positive, the pose a pose.
[[nodiscard]] bool is_sound(const Move& move, std::size_t joints) CELL_RT;

}  // namespace cellmirror::motion
