// A CiA 402 servo drive with its motor, as one node of a CAN bus: what a controller commands, the drive does. CANopen
// by canopen/slave.hpp, the power state machine by power_state.hpp, the modes by mode_motion.hpp and homing.hpp, the
// motor by motor_model.hpp. No I/O, no clock: frames and time are pushed in, frames come out; motion advances in steps
// of MotorModel::kStep. One thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/can/canopen/frame_output.hpp"
#include "drivers/can/canopen/slave.hpp"
#include "drivers/can/cia402/device/homing.hpp"
#include "drivers/can/cia402/device/mode_motion.hpp"
#include "drivers/can/cia402/device/motor_model.hpp"
#include "drivers/can/cia402/device/power_state.hpp"
#include "drivers/can/cia402/device/servo_objects.hpp"
#include "drivers/can/cia402/state.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/device_config.hpp"

namespace cellmirror::can {

class ServoDrive final : private SlaveApplication {
 public:
  // `output` outlives the drive. Off until power_on(). `config` has a valid node number and positive constants.
  ServoDrive(const DriveConfig& config, std::uint16_t heartbeat_ms, FrameOutput& output);

  // Boot-up message, then NMT pre-operational; a drive that waits for its number has them when it has got one.
  void power_on(Timestamp now);

  // Any frame of the bus. What concerns this node is carried out at once; SYNC is answered before the motion goes on.
  void receive(const CanFrame& frame, Timestamp now);
  // As those of CanopenSlave.
  void list_identifiers(std::vector<std::uint32_t>& identifiers) const { slave_.list_identifiers(identifiers); }
  [[nodiscard]] std::uint64_t identifiers_revision() const { return slave_.identifiers_revision(); }
  // Motion and timers until `now`. At most 0.1 s of motion is made up for.
  void advance(Timestamp now);
  [[nodiscard]] Timestamp next_timer() const { return slave_.next_due(); }  // heartbeat and the like; not the motion
  // Faults: slave.hpp. Without power the brake holds; after an error the master resets the fault.
  void inject(const NodeFault& fault, Timestamp now) { slave_.inject(fault, now); }
  void end_faults(Timestamp now) { slave_.end_faults(now); }
  [[nodiscard]] const FaultGate& faults() const { return slave_.faults(); }
  // What the robot touches leaves of the joint's velocity, from now on.
  void set_bounds(const VelocityBounds& bounds) { motor_.set_bounds(bounds); }

  // Of the joint: rad or m, rad/s or m/s, Nm or N, in the joint's direction.
  [[nodiscard]] double joint_position() const { return motor_.position(); }
  [[nodiscard]] double joint_velocity() const { return motor_.velocity(); }
  [[nodiscard]] double joint_torque() const { return motor_.torque(); }
  // An obstacle or a mechanical stop kept it from moving as its torque wanted.
  [[nodiscard]] bool is_held_back() const { return motor_.held_back() != 0; }

  [[nodiscard]] std::uint8_t node_id() const { return slave_.node(); }
  [[nodiscard]] NmtState nmt_state() const { return slave_.state(); }
  [[nodiscard]] Cia402State state() const { return power_.state(); }
  [[nodiscard]] DriveMode mode() const { return mode_; }
  [[nodiscard]] std::uint16_t error_code() const { return error_code_; }
  [[nodiscard]] const ObjectDictionary& objects() const { return slave_.objects(); }

 private:
  // SlaveApplication
  [[nodiscard]] std::optional<SdoAbort> check(ObjectAddress address, std::int64_t value) override;
  void written(std::span<const ObjectAddress> addresses, Timestamp now) override;
  void on_reset(Timestamp now) override;
  void synced(Timestamp now) override;
  bool communication_lost(Timestamp now) override;
  [[nodiscard]] bool is_stored(ObjectAddress address) const override;
  bool fail(std::uint16_t code, std::uint8_t error_register, Timestamp now) override;

  void on_controlword(std::uint16_t controlword);
  void on_mode(DriveMode mode);
  void start_mode();
  void on_mode_bits(std::uint16_t before, std::uint16_t controlword);
  void on_set_point(std::uint16_t controlword);
  void on_halt(bool halt);
  void take_targets();
  void take_position(double target);

  void move(Timestamp now);
  void step();
  void step_mode();
  void step_torque();
  void step_stop();
  void step_homing();
  void take_home();
  void follow(const MotionPoint& demand);
  void watch_block();
  void watch_following_error();
  void watch_windows();
  void release_acknowledgement();
  void note_target_reached(bool now, double after);
  void raise_fault(std::uint16_t code, std::uint8_t error_register);
  void write_objects();
  [[nodiscard]] std::uint16_t statusword() const;
  [[nodiscard]] bool runs_mode() const;
  [[nodiscard]] bool is_position_mode() const;
  [[nodiscard]] bool is_torque_mode() const;
  [[nodiscard]] std::uint32_t digital_inputs() const;

  // Positions: `raw` increments are those of the encoder; a drive's own are shifted by homing.
  [[nodiscard]] double raw_of_joint(double joint) const;
  [[nodiscard]] double actual() const { return raw_of_joint(motor_.position()) - shift_; }
  [[nodiscard]] double actual_velocity() const { return motor_.velocity() * joint_sign_ * scale_; }
  [[nodiscard]] MotionPoint joint_of(const MotionPoint& demand) const;
  [[nodiscard]] HomingInputs homing_inputs() const;
  [[nodiscard]] double within_limits(double target);
  // Converts a target within the position range (0x607B) to the position of the axis, which does not wrap. The
  // direction is the one of 0x60F2, or the shorter way if `nearest`.
  [[nodiscard]] double target_of(double wanted, bool nearest) const;
  [[nodiscard]] TorqueLimits torque_limits() const;
  [[nodiscard]] double halt_deceleration() const;
  [[nodiscard]] std::int64_t object(std::uint16_t index, std::uint8_t subindex = 0) const;

  DriveConfig config_;
  double scale_;       // increments a joint unit
  double joint_sign_;  // 1 or -1
  CanopenSlave slave_;
  MotorModel motor_;
  PowerState power_;
  ServoParameters parameters_;
  DriveMode mode_ = DriveMode::none;
  ProfilePosition profile_position_;
  ProfileVelocity profile_velocity_;
  CyclicPosition cyclic_position_;
  Homing homing_;
  RunningPlan stop_plan_;
  std::optional<StopRamp> stop_ramp_;  // that stop_plan_ was made for
  MotionPoint demand_;                 // increments
  double shift_ = 0;                   // raw minus own increments
  double torque_demand_ = 0;           // torque modes: Nm or N
  double torque_target_ = 0;           // profile torque: where the demand goes
  double velocity_demand_ = 0;         // cyclic synchronous velocity: increments/s
  std::uint16_t controlword_ = 0;
  std::uint16_t error_code_ = 0;
  bool set_point_acknowledged_ = false;
  bool interpolating_ = false;
  bool limited_ = false;         // a set-point was cut to the software limits
  bool target_reached_ = false;  // bit 10
  double reached_for_ = 0;       // s within the window
  double beyond_for_ = 0;        // s beyond the window of the following error
  double standing_for_ = 0;      // s below the velocity threshold
  double blocked_for_ = 0;       // s that it has pressed against what blocks it
  Timestamp moved_;              // until when the motor has moved
};

}  // namespace cellmirror::can
