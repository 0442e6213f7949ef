// Where the values of a command stand in its ParsedCommand: a named slot for each value of the forms with more than
// one. The tables check these constants against their forms when they are compiled (has_slots()), so that a form and
// its handler cannot drift apart.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>

#include "scripts/lang/form.hpp"
#include "scripts/lang/parsed_command.hpp"

namespace cellmirror::script {

// The only value of a command, or the first of a list of values of one kind.
inline constexpr std::size_t kOnlySlot = 0;

[[nodiscard]] constexpr bool has_slot(std::span<const Parameter> form, const Slot& slot) {
  if (slot.parameter >= form.size()) return false;
  const Parameter& parameter = form[slot.parameter];
  std::size_t before = 0;
  for (const Parameter& other : form.first(slot.parameter)) before += other.width;
  return before == slot.first && (parameter.label.empty() ? parameter.name : parameter.label) == slot.name;
}
[[nodiscard]] constexpr bool has_slots(std::span<const Parameter> form, std::initializer_list<Slot> slots) {
  for (const Slot& slot : slots) {
    if (!has_slot(form, slot)) return false;
  }
  return true;
}

namespace slots {

// A namespace a form, or for forms of one shape: STDP, STVW, ... of the synopsis.
namespace stdp {
inline constexpr Slot kDisplay{0, 0, "display_id"};
inline constexpr Slot kScreen{1, 1, "FULL | FULL_OFF"};
}  // namespace stdp
namespace stvw {
inline constexpr Slot kView{0, 0, "view_id"};
inline constexpr Slot kViewpoint{1, 1, "VP"};
inline constexpr Slot kLookpoint{4, 2, "LP"};
inline constexpr Slot kTwist{7, 3, "TW"};
inline constexpr Slot kAngle{8, 4, "VA"};
inline constexpr Slot kFrontPlane{9, 5, "FCP"};
inline constexpr Slot kBackPlane{10, 6, "BCP"};
inline constexpr Slot kSteps{11, 7, "STEPS"};
inline constexpr Slot kTime{12, 8, "TIME"};
}  // namespace stvw
namespace covw {
inline constexpr Slot kView{0, 0, "view_id"};
inline constexpr Slot kCamera{1, 1, "cam_id"};
}  // namespace covw
namespace set_mode {
inline constexpr Slot kMode{0, 0, "mode"};
inline constexpr Slot kOn{1, 1, "on | off"};
}  // namespace set_mode

namespace force_memory {
inline constexpr Slot kSendType{0, 0, "send_type"};
inline constexpr Slot kKey{1, 1, "re_shmkey"};
inline constexpr Slot kBytes{2, 2, "re_buflen"};
}  // namespace force_memory
namespace switch_memory {
inline constexpr Slot kSendType{0, 0, "send_type"};
inline constexpr Slot kKey{1, 1, "be_shmkey"};
inline constexpr Slot kBytes{2, 2, "be_buflen"};
}  // namespace switch_memory

namespace force_arrow {
inline constexpr Slot kJointForces{0, 0, "int_1"};
inline constexpr Slot kJointTorques{1, 1, "int_2"};
inline constexpr Slot kTcpForce{2, 2, "int_3"};
}  // namespace force_arrow
namespace torque_limit {
inline constexpr Slot kForce{0, 0, "max_force"};
inline constexpr Slot kTorque{1, 1, "max_torque"};
}  // namespace torque_limit
namespace tcp_test {
inline constexpr Slot kOn{0, 0, "on | off"};
inline constexpr Slot kFirstValue{1, 1, "v1"};
}  // namespace tcp_test
namespace master_slave {
inline constexpr Slot kOn{0, 0, "on | off"};
inline constexpr Slot kMaster{1, 1, "master_robot"};
inline constexpr Slot kSlaves{2, 2, "n_slaves"};
inline constexpr Slot kFirstSlave{3, 3, "slave_robot n_dof master_joint slave_joint ..."};
}  // namespace master_slave

// eladyn_geo_def with flags.
namespace tissue_attributes {
inline constexpr Slot kObject{0, 0, "geo_name | ALL"};
inline constexpr Slot kFlags{1, 1, "flags"};
}  // namespace tissue_attributes
// eladyn_geo_def with a token.
namespace tissue_attribute {
inline constexpr Slot kObject{0, 0, "geo_name | ALL"};
inline constexpr Slot kToken{1, 1, "token"};
inline constexpr Slot kOn{2, 2, "on | off"};
}  // namespace tissue_attribute
// eladyn_geo_def with cylinders.
namespace effector_cylinders {
inline constexpr Slot kGeometry{0, 0, "geo_name"};
inline constexpr Slot kFlags{1, 1, "flags"};
inline constexpr Slot kShaftDiameter{2, 2, "geom1"};
inline constexpr Slot kEffectorRadius{3, 3, "geom2"};
inline constexpr Slot kEffectorLength{4, 4, "geom3"};
inline constexpr Slot kFourth{5, 5, "geom4"};
}  // namespace effector_cylinders
// eladyn_plaus_param.
namespace tissue_limit {
inline constexpr Slot kToken{0, 0, "token"};
inline constexpr Slot kFlags{1, 1, "flags"};
inline constexpr Slot kValue{2, 2, "val"};
}  // namespace tissue_limit
// rob_ela_interact.
namespace instrument {
inline constexpr Slot kJoint{0, 0, "int_jnt"};
inline constexpr Slot kTest{1, 1, "test_function"};
inline constexpr Slot kFirstValue{2, 2, "testval1"};
inline constexpr Slot kSecondValue{3, 3, "testval2"};
inline constexpr Slot kKind{4, 4, "inst_type"};
}  // namespace instrument
// ela_clip_def.
namespace clip {
inline constexpr Slot kFile{0, 0, "clip_file"};
inline constexpr Slot kRotation{1, 1, "rx"};     // and ry, rz
inline constexpr Slot kTranslation{4, 4, "tx"};  // and ty, tz
}  // namespace clip

// VV_CLIP, VV_CLIP_POS, VV_SET_LUT, both forms of VV_SET_LUT_PAR, VV_RELOAD_LUTS.
namespace volume_plane {
inline constexpr Slot kPlane{0, 0, "plane"};
inline constexpr Slot kMode{1, 1, "active | reverse | visible | off"};
inline constexpr Slot kVolume{2, 2, "volume"};
}  // namespace volume_plane
namespace volume_plane_position {
inline constexpr Slot kPlane{0, 0, "plane"};
inline constexpr Slot kElevation{1, 1, "ELE"};
inline constexpr Slot kAzimuth{2, 2, "AZI"};
inline constexpr Slot kDistance{3, 3, "DIST"};
inline constexpr Slot kVolume{4, 4, "volume"};
}  // namespace volume_plane_position
namespace volume_table {
inline constexpr Slot kTable{0, 0, "LUT_name"};
inline constexpr Slot kVolume{1, 1, "volume"};
}  // namespace volume_table
namespace medical_table {
inline constexpr Slot kAir{0, 1, "air"};
inline constexpr Slot kFat{1, 2, "fat"};
inline constexpr Slot kTissue{2, 3, "tissue"};
inline constexpr Slot kBone{3, 4, "bone"};
inline constexpr Slot kVolume{4, 5, "volume"};
}  // namespace medical_table
namespace volume_table_parameters {
inline constexpr Slot kTable{0, 0, "LUT_name"};
inline constexpr Slot kOpacity{1, 1, "opacity"};
inline constexpr Slot kGain{2, 2, "gain"};
inline constexpr Slot kLevel{3, 3, "level"};
inline constexpr Slot kWindow{4, 4, "window"};
inline constexpr Slot kVolume{5, 5, "volume"};
}  // namespace volume_table_parameters
// VV_ISO.
namespace volume_surface {
inline constexpr Slot kOn{0, 0, "on | off"};
inline constexpr Slot kValue{1, 1, "VALUE"};
inline constexpr Slot kVolume{2, 2, "volume"};
}  // namespace volume_surface
namespace volume_reload {
inline constexpr Slot kVolume{0, 0, "volume"};
}  // namespace volume_reload

// CONNECT, and with the third value FRAME_TO_WFRM.
namespace connect {
inline constexpr Slot kAttached{0, 0, "frame_2"};
inline constexpr Slot kPredecessor{1, 2, "frame_1"};
inline constexpr Slot kWorkframe{2, 3, "WFRM_name1"};
}  // namespace connect
namespace placement {
inline constexpr Slot kFrame{0, 0, "frame_node"};
inline constexpr Slot kRotation{1, 2, "wx"};     // and wy, wz
inline constexpr Slot kTranslation{4, 5, "dx"};  // and dy, dz
}  // namespace placement
namespace render {
inline constexpr Slot kFrame{0, 0, "frame_node"};
inline constexpr Slot kMode{1, 2, "mode"};
}  // namespace render
namespace robot_online {
inline constexpr Slot kRobot{0, 0, "Robot_id"};
inline constexpr Slot kOnline{1, 1, "online | offline"};
}  // namespace robot_online
namespace robot_sending {
inline constexpr Slot kRobot{0, 0, "Robot_id"};
inline constexpr Slot kSending{1, 1, "send_on | send_off"};
}  // namespace robot_sending
namespace campar {
inline constexpr Slot kCamera{0, 0, "CAM_id"};
inline constexpr Slot kFocalDistance{1, 1, "view_dist"};
inline constexpr Slot kOpeningAngle{2, 2, "fovy_angle"};
}  // namespace campar
// CAM_TRACKING, and without the third value CAM_VIEW_PYRAMID and CAM_ONLINE.
namespace camera_switch {
inline constexpr Slot kCamera{0, 0, "cam_id"};
inline constexpr Slot kOn{1, 1, "on | off"};
inline constexpr Slot kTarget{2, 2, "frame_id"};
}  // namespace camera_switch

namespace pos_rob {
inline constexpr Slot kRobot{0, 0, "Robot_id"};
inline constexpr std::size_t kTarget = 1;  // behind the word of the mode
}  // namespace pos_rob
namespace move_rob {
inline constexpr Slot kRobot{0, 0, "Robot_id"};
inline constexpr Slot kPath{1, 1, "PTP | LIN"};
inline constexpr std::size_t kTarget = 2;  // behind the word of the mode
}  // namespace move_rob

// TF_LOAD, TF_BACK, TF_DELETE, TF_RUN and TF_RECORD begin so.
namespace program {
inline constexpr Slot kProgram{0, 0, "teach_filename"};
inline constexpr Slot kRobot{1, 1, "Robot_id"};
inline constexpr Slot kExecWait{2, 2, "exec_wait"};               // TF_RUN
inline constexpr Slot kRecordStep{2, 2, "START | POINT | STOP"};  // TF_RECORD
inline constexpr Slot kPoint{3, 3, "point"};                      // TF_RECORD
}  // namespace program
namespace program_step {
inline constexpr Slot kRobot{0, 0, "Robot_id"};
inline constexpr Slot kDirection{1, 1, "direction"};
}  // namespace program_step
// SET_INPUT and SET_ANALOG_INPUT.
namespace program_input {
inline constexpr Slot kRobot{0, 0, "Robot_id"};
inline constexpr Slot kNumber{1, 1, "number"};
inline constexpr Slot kOn{2, 2, "on | off"};
inline constexpr Slot kValue{2, 2, "value"};
}  // namespace program_input

namespace alarm_ack {
inline constexpr Slot kName{0, 0, "name"};
inline constexpr Slot kAlarm{1, 1, "alarm"};
}  // namespace alarm_ack

namespace sensor_active {
inline constexpr Slot kSensor{0, 1, "USS_id"};
inline constexpr Slot kOn{1, 2, "0 | 1"};
}  // namespace sensor_active
namespace sensor_range {
inline constexpr Slot kSensor{0, 1, "USS_id"};
inline constexpr Slot kRange{1, 2, "USS_range"};
}  // namespace sensor_range
namespace collision_pair {
inline constexpr Slot kA{0, 1, "node_a"};
inline constexpr Slot kB{1, 2, "node_b"};
inline constexpr Slot kTreatment{2, 3, "ignore | test | derive"};
}  // namespace collision_pair

namespace fly {
inline constexpr Slot kType{0, 0, "fly_type"};
inline constexpr Slot kParameter{1, 1, "fly_parameter"};
}  // namespace fly
// rob_por_def and rob_tcp_def.
namespace offset {
inline constexpr std::size_t kTranslation = 0;
inline constexpr std::size_t kRotation = 3;
}  // namespace offset

}  // namespace slots
}  // namespace cellmirror::script
