// SCRIPT's only interfaces to the gateway, which implements them. Every call comes from the thread that owns the cell.
// Quantities are SI. A refusal has a reason and a remedy; a refused call changes nothing.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/base/pose.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/proximity_state.hpp"
#include "rt_core/ports/robot_parameters.hpp"
#include "rt_core/ports/robot_state.hpp"
#include "scripts/commands/display_host.hpp"
#include "scripts/commands/interaction_host.hpp"
#include "scripts/commands/motion_host.hpp"
#include "scripts/commands/program_host.hpp"
#include "scripts/commands/tissue_host.hpp"
#include "scripts/commands/volume_host.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror {

// The tree of the cell (manual 1.2.1).
class WorldHost {
 public:
  virtual ~WorldHost() = default;
  virtual Result<void> activate(std::string_view node) = 0;
  virtual Result<void> deactivate(std::string_view node) = 0;
  virtual Result<void> delete_node(std::string_view node) = 0;
  virtual Result<void> swap_node(std::string_view node) = 0;
  virtual Result<void> level_down(std::string_view node) = 0;
  virtual Result<void> level_up(std::string_view node) = 0;
  // X_PF: the frame's new pose in its kinematic predecessor.
  virtual Result<void> set_placement(std::string_view node, const Pose& X_PF) = 0;
  // `predecessor` becomes the kinematic predecessor of `part`, whose world pose stays.
  virtual Result<void> connect(std::string_view part, std::string_view predecessor) = 0;
  // The same with the relative pose of the workframe: the part jumps there.
  virtual Result<void> attach_at_workframe(std::string_view part, std::string_view predecessor,
                                           std::string_view workframe) = 0;
  // Recalculates the kinematics with everything commanded so far and publishes the result.
  virtual Result<void> draw_scene() = 0;
};

// Robots (manual 1.2.1 and 1.2.2). The parameter calls concern the active robot and are refused when there is none.
class RobotHost {
 public:
  virtual ~RobotHost() = default;
  virtual Result<void> set_active_robot(std::string_view robot) = 0;
  virtual Result<void> set_online(std::string_view robot, bool online) = 0;    // ROBOT online / offline
  virtual Result<void> set_sending(std::string_view robot, bool sending) = 0;  // ROBOT send_on / send_off
  // A remark where what is in force is not what was given.
  virtual Result<std::string> set_joint_parameter(JointParameter which, std::span<const double> values) = 0;
  virtual Result<void> set_scalar_parameter(ScalarParameter which, double value) = 0;
  virtual Result<void> set_fly(FlyType type, double parameter) = 0;
  virtual Result<void> set_ptp_mode(PtpMode mode) = 0;
  virtual Result<void> set_velocity_profile(VelocityProfile profile) = 0;
  virtual Result<void> set_inverse_class(InverseClass inverse_class) = 0;
  virtual Result<void> set_point_of_reference(const Pose& X_FP) = 0;
  virtual Result<void> set_tool_center_point(const Pose& X_PT) = 0;
};

// What SET_COLLPAR says of pairs of bodies.
enum class PairTreatment : std::uint8_t { ignore, test, derive };

// Ultrasonic sensors (manual 1.2.1) and, of ours, collision tests.
class SensingHost {
 public:
  virtual ~SensingHost() = default;
  virtual Result<void> set_sensor_active(std::string_view sensor, bool active) = 0;
  virtual Result<void> set_sensor_range(std::string_view sensor, double range_m) = 0;
  virtual Result<void> set_range_send_mode(RangeSendMode mode) = 0;
  virtual Result<void> set_collision_active(bool active) = 0;
  virtual Result<void> set_collision_warning(double distance_m) = 0;
  // For bodies of the branch of `a` against those of the branch of `b`.
  virtual Result<void> set_collision_pair(std::string_view a, std::string_view b, PairTreatment treatment) = 0;
};

// RECORD, in the order of its choices.
enum class RecordAction : std::uint8_t { on, off, keep };

// Of ours: what the manual does not have.
class DiagnosisHost {
 public:
  virtual ~DiagnosisHost() = default;
  virtual Result<void> save_flight_record(
      std::string_view file_name) = 0;                   // SAVE_FLIGHT, into the cell folder's records/
  virtual Result<void> record(RecordAction action) = 0;  // of the black box
  // ALARM_ACK: one alarm, or all (0). The remark says how many.
  virtual Result<std::string> acknowledge_alarms(std::string_view name, std::uint64_t alarm) = 0;
};

struct CommandHost {
  NameDirectory& names;
  WorldHost& world;
  RobotHost& robots;
  MotionHost& motion;
  ProgramHost& programs;
  DisplayHost& display;
  SensingHost& sensing;
  InteractionHost& interaction;
  TissueHost& tissue;
  VolumeHost& volumes;
  DiagnosisHost& diagnosis;
};

}  // namespace cellmirror
