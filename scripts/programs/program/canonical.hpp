// Canonical commands: the output of every robot language. SI; frames are named. A command is self-contained: its
// execution needs nothing of the program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "rt_core/base/pose.hpp"
#include "rt_core/ports/robot_parameters.hpp"

namespace cellmirror::program {

enum class PathKind : std::uint8_t {
  joints,    // point to point
  linear,    // the TCP on a straight line to a pose, or to where joint values put it
  circular,  // the TCP on the arc through a via point
};

enum class TargetKind : std::uint8_t {
  joints_absolute,  // rad or m; joints beyond the count stay
  joints_relative,
  pose_absolute,  // X_ZT: the TCP in the robot's ZP frame
  pose_relative,  // from where the move before ends: translation and rotation in the axes of the ZP frame
  tool_relative,  // from where the move before ends: X_TT', in the axes of the TCP
};

struct Target {
  TargetKind kind = TargetKind::joints_absolute;
  std::uint8_t joint_count = 0;
  JointValues joints{};          // rad or m (or differences)
  Pose pose = Pose::Identity();  // by kind
};

// What a program has set. Where it has set nothing the robot's own parameters are in force (manual 1.2.2).
struct MotionSettings {
  std::optional<double> joint_velocity;      // share of rob_jnt_max_vel, (0, 1]
  std::optional<double> joint_acceleration;  // share of rob_jnt_max_acc, (0, 1]
  std::optional<double> linear_velocity;     // m/s; these four take the place of the scaled values of rob_cart_*, which
  std::optional<double> linear_acceleration;      // m/s2; stay the upper bounds
  std::optional<double> rotational_velocity;      // rad/s
  std::optional<double> rotational_acceleration;  // rad/s2
  // Shares of the robot's own values, (0, 1]; never together with the value itself.
  std::optional<double> linear_velocity_share;
  std::optional<double> linear_acceleration_share;
  std::optional<double> rotational_velocity_share;
  std::optional<double> rotational_acceleration_share;
  std::optional<FlyType> fly_type;  // with the parameter
  double fly_parameter = 0;         // fraction, m or rad, by type
  bool operator==(const MotionSettings&) const = default;
};

struct MoveCommand {
  PathKind path = PathKind::joints;
  Target target;
  std::optional<Target> via;  // circular: of the kind of the target
  bool fly = false;           // the next move may begin before this one has ended
  MotionSettings settings;
};
struct DelayCommand {
  double seconds = 0;
};
// The TCP from now on, as rob_tcp_def; none: the robot's own again.
struct ToolCommand {
  std::optional<Pose> X_PT;
};
struct OutputCommand {
  bool analogue = false;
  std::uint16_t number = 0;  // from 1
  double value = 0;          // 0 or 1 for a digital one
};
// Until the condition of the statement holds (Machine::holds()).
struct WaitCommand {
  std::string condition;            // for people: "input 3 is on"
  std::optional<double> timeout_s;  // then the program continues, or fails: Machine::time_out()
};
struct AcquireCommand {
  std::string semaphore;
};
struct ReleaseCommand {
  std::string semaphore;
};
struct ScriptCommand {
  std::string text;  // one SCRIPT command
};
// Until the program is resumed.
struct PauseCommand {};
// The robot must be at rest before the machine continues, because the next statement reads its position or an input.
// Not part of traces.
struct RestCommand {};

struct CanonicalCommand {
  std::uint32_t statement = 0;  // index, for status and errors
  std::variant<MoveCommand, DelayCommand, ToolCommand, OutputCommand, WaitCommand, AcquireCommand, ReleaseCommand,
               ScriptCommand, PauseCommand, RestCommand>
      what;
};

}  // namespace cellmirror::program
