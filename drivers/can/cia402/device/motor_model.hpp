// The motor of one drive with what it moves, and the controller that moves it: inertia, friction, torque limits,
// mechanical stops, obstacles, holding brake. Everything is seen from the joint, in SI (rad or m). Pure; steps of fixed
// length.
#pragma once

#include <limits>

#include "drivers/can/cia402/device/motion_plan.hpp"
#include "rt_core/ports/device_config.hpp"

namespace cellmirror::can {

// Of the motor, in the joint's direction [Nm or N]; zero lies within.
struct TorqueLimits {
  double lower = 0;
  double upper = 0;
};

// What an obstacle leaves of the joint's velocity [rad/s or m/s]; zero lies within.
struct VelocityBounds {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

class MotorModel {
 public:
  static constexpr double kStep = 0.0005;  // s

  explicit MotorModel(const DriveConfig& config);

  // One step under power. `limits` lie within the current limit.
  void follow_position(const MotionPoint& demand, const TorqueLimits& limits);
  void follow_velocity(double velocity, const TorqueLimits& limits);
  void apply_torque(double torque, const TorqueLimits& limits);
  // One step without power: the holding brake stops the joint and holds it.
  void hold();
  // Forgets what the controller has integrated: power comes on.
  void start_control() { integral_ = 0; }
  // From the next step on: an obstacle that gives way to no torque. It takes speed from the joint and gives it none.
  void set_bounds(const VelocityBounds& bounds) { bounds_ = bounds; }

  [[nodiscard]] double position() const { return position_; }
  [[nodiscard]] double velocity() const { return velocity_; }
  [[nodiscard]] double torque() const { return torque_; }  // of the motor
  [[nodiscard]] bool at_torque_limit() const { return at_limit_; }
  // In the last step an obstacle or a mechanical stop kept the joint from moving up (1) or down (-1); 0: nothing did.
  [[nodiscard]] int held_back() const { return held_back_; }

 private:
  void control_velocity(double wanted, double acceleration, const TorqueLimits& limits);
  void move(double torque, double friction);

  DriveConfig config_;
  double position_;
  double velocity_ = 0;
  double torque_ = 0;
  double integral_ = 0;  // torque that the velocity loop has found to be needed
  bool at_limit_ = false;
  VelocityBounds bounds_;
  int held_back_ = 0;
};

}  // namespace cellmirror::can
