// The motor of one drive with what it moves, and the controller that moves it: inertia, friction, current limit,
// mechanical stops, holding brake. Everything is seen from the joint, in SI (rad or m). Pure; steps of fixed length.
#pragma once

#include "drivers/can/cia402/device/motion_plan.hpp"
#include "rt_core/ports/device_config.hpp"

namespace cellmirror::can {

class MotorModel {
 public:
  static constexpr double kStep = 0.0005;  // s

  explicit MotorModel(const DriveConfig& config);

  // One step under power. `limit`: of the torque, at most the current limit [Nm or N].
  void follow_position(const MotionPoint& demand, double limit);
  void follow_velocity(double velocity, double limit);
  void apply_torque(double torque, double limit);
  // One step without power: the holding brake stops the joint and holds it.
  void hold();
  // Forgets what the controller has integrated: power comes on.
  void start_control() { integral_ = 0; }

  [[nodiscard]] double position() const { return position_; }
  [[nodiscard]] double velocity() const { return velocity_; }
  [[nodiscard]] double torque() const { return torque_; }  // of the motor
  [[nodiscard]] bool at_torque_limit() const { return at_limit_; }

 private:
  void control_velocity(double wanted, double acceleration, double limit);
  void move(double torque, double friction);

  DriveConfig config_;
  double position_;
  double velocity_ = 0;
  double torque_ = 0;
  double integral_ = 0;  // torque that the velocity loop has found to be needed
  bool at_limit_ = false;
};

}  // namespace cellmirror::can
