// A gateway for tests: writes down each call as one canonical line in SI. Refuses what it is told to refuse.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "scripts/commands/host.hpp"
#include "tests/golden/scripts/fake_names.hpp"

namespace cellmirror::testing {

class RecordingHost final : public WorldHost,
                            public RobotHost,
                            public MotionHost,
                            public ProgramHost,
                            public DisplayHost,
                            public SensingHost,
                            public InteractionHost,
                            public TissueHost,
                            public VolumeHost,
                            public DiagnosisHost {
 public:
  std::vector<std::string> calls;
  FakeNames names;
  std::string refused_call;         // the first word of calls that are refused
  mutable int busy_checks = 0;      // how many more times busy() answers true
  std::vector<std::string> failed;  // robot programs: why
  // What POS_ROB begins; null: the robot stands there at once.
  std::shared_ptr<Activity> activity;

  [[nodiscard]] CommandHost host() {
    return {names, *this, *this, *this, *this, *this, *this, *this, *this, *this, *this};
  }
  [[nodiscard]] std::string trace() const {
    std::string text;
    for (const std::string& call : calls) text += call + "\n";
    return text;
  }

  Result<void> activate(std::string_view node) override {
    if (!names.knows(NameKind::frame_node, node)) return std::unexpected(names.explain(NameKind::frame_node, node));
    return record("activate {}", node);
  }
  Result<void> deactivate(std::string_view node) override { return record("deactivate {}", node); }
  Result<void> delete_node(std::string_view node) override { return record("delete_node {}", node); }
  Result<void> swap_node(std::string_view node) override { return record("swap_node {}", node); }
  Result<void> level_down(std::string_view node) override { return record("level_down {}", node); }
  Result<void> level_up(std::string_view node) override { return record("level_up {}", node); }
  Result<void> set_placement(std::string_view node, const Pose& X_PF) override {
    return record("set_placement {} {}", node, pose_text(X_PF));
  }
  Result<void> connect(std::string_view part, std::string_view predecessor) override {
    return record("connect {} to {}", part, predecessor);
  }
  Result<void> attach_at_workframe(std::string_view part, std::string_view predecessor,
                                   std::string_view workframe) override {
    return record("attach_at_workframe {} to {} at {}", part, predecessor, workframe);
  }
  Result<void> draw_scene() override { return record("draw_scene"); }

  Result<void> set_active_robot(std::string_view robot) override {
    names.active = robot;
    return record("set_active_robot {}", robot);
  }
  Result<void> set_online(std::string_view robot, bool online) override {
    return record("set_online {} {}", robot, online);
  }
  Result<void> set_sending(std::string_view robot, bool sending) override {
    return record("set_sending {} {}", robot, sending);
  }
  Result<ActivityHandle> position(std::string_view robot, const MotionTarget& target) override {
    if (auto recorded = record("position {} {}", robot, target_text(target)); !recorded)
      return std::unexpected(recorded.error());
    return activity;
  }
  Result<void> queue_move(std::string_view robot, MovePath path, const MotionTarget& target) override {
    return record("queue_move {} {} {}", robot, path == MovePath::linear ? "LIN" : "PTP", target_text(target));
  }
  Result<void> stop(std::string_view robot) override { return record("stop {}", robot); }
  Result<void> set_positioning(Positioning positioning) override {
    return record("set_positioning {}", positioning == Positioning::jumping ? "jump" : "move");
  }
  [[nodiscard]] bool moving() const override { return false; }
  Result<std::string> set_joint_parameter(JointParameter which, std::span<const double> values) override {
    constexpr std::array<std::string_view, 9> kNames = {
        "max_range",    "min_range",       "start_position",   "reference_position", "max_velocity",
        "min_velocity", "active_velocity", "max_acceleration", "active_acceleration"};
    auto done = record("set_joint_parameter {} {}", kNames[static_cast<std::size_t>(which)], list_text(values));
    if (!done) return std::unexpected(done.error());
    return std::string();
  }
  Result<void> set_scalar_parameter(ScalarParameter which, double value) override {
    constexpr std::array<std::string_view, 7> kNames = {
        "linear_velocity", "linear_acceleration", "rotational_velocity", "rotational_acceleration",
        "velocity_scale",  "acceleration_scale",  "program_delay"};
    return record("set_scalar_parameter {} {:.9g}", kNames[static_cast<std::size_t>(which)], value);
  }
  Result<void> set_fly(FlyType type, double parameter) override {
    constexpr std::array<std::string_view, 3> kNames = {"speed_fraction", "distance", "angle"};
    return record("set_fly {} {:.9g}", kNames[static_cast<std::size_t>(type)], parameter);
  }
  Result<void> set_ptp_mode(PtpMode mode) override {
    return record("set_ptp_mode {}", mode == PtpMode::synchronous ? "synchronous" : "asynchronous");
  }
  Result<void> set_velocity_profile(VelocityProfile profile) override {
    return record("set_velocity_profile {}", profile == VelocityProfile::sine ? "sine" : "ramp");
  }
  Result<void> set_inverse_class(InverseClass inverse_class) override {
    return record("set_inverse_class {}", static_cast<int>(inverse_class));
  }
  Result<void> set_point_of_reference(const Pose& X_FP) override {
    return record("set_point_of_reference {}", pose_text(X_FP));
  }
  Result<void> set_tool_center_point(const Pose& X_PT) override {
    return record("set_tool_center_point {}", pose_text(X_PT));
  }

  Result<void> set_language(std::string_view language) override { return record("set_language {}", language); }
  Result<ActivityHandle> load_program(std::string_view program, std::string_view robot) override {
    if (auto done = record("load_program {} {}", program, robot); !done) return std::unexpected(done.error());
    return activity;
  }
  Result<ActivityHandle> run_program(std::string_view program, std::string_view robot, ProgramBegin begin) override {
    constexpr std::array<std::string_view, 3> kNames = {"now", "exec_wait", "backward"};
    const auto done = record("run_program {} {} {}", program, robot, kNames[static_cast<std::size_t>(begin)]);
    if (!done) return std::unexpected(done.error());
    return activity;
  }
  Result<void> delete_program(std::string_view program, std::string_view robot) override {
    return record("delete_program {} {}", program, robot);
  }
  Result<void> hold_program(std::string_view robot) override { return record("hold_program {}", robot); }
  Result<void> resume_program(std::string_view robot) override { return record("resume_program {}", robot); }
  Result<void> step_program(std::string_view robot, bool backward) override {
    return record("step_program {} {}", robot, backward ? "backward" : "forward");
  }
  Result<void> stop_programs(std::string_view robot) override { return record("stop_programs {}", robot); }
  Result<ActivityHandle> await_programs(std::string_view robot) override {
    if (auto recorded = record("await_programs {}", robot); !recorded) return std::unexpected(recorded.error());
    return activity;
  }
  Result<void> record_program(std::string_view program, std::string_view robot, RecordStep step,
                              std::string_view point) override {
    constexpr std::array<std::string_view, 3> kNames = {"start", "point", "stop"};
    return record("record_program {} {} {} [{}]", program, robot, kNames[static_cast<std::size_t>(step)], point);
  }
  Result<void> set_digital_input(std::string_view robot, std::size_t number, bool on) override {
    return record("set_digital_input {} {} {}", robot, number, on);
  }
  Result<void> set_analogue_input(std::string_view robot, std::size_t number, double value) override {
    return record("set_analogue_input {} {} {:.9g}", robot, number, value);
  }
  [[nodiscard]] bool busy() const override { return busy_checks > 0 && busy_checks-- > 0; }
  [[nodiscard]] std::uint64_t failures() const override { return failed.size(); }
  [[nodiscard]] Result<void> verdict(std::uint64_t since) const override {
    return since < failed.size() ? Result<void>(fail(failed.back())) : Result<void>();
  }

  Result<void> set_display(int display, bool full_screen) override {
    return record("set_display {} {}", display, full_screen ? "FULL" : "FULL_OFF");
  }
  Result<void> set_view(int view, const ViewChange& change, const ViewPace& pace) override {
    std::string text;
    const auto vector = [&](const char* name, const std::optional<Eigen::Vector3d>& v) {
      if (v) text += fmt::format(" {} {:.9g} {:.9g} {:.9g}", name, v->x(), v->y(), v->z());
    };
    const auto number = [&](const char* name, const std::optional<double>& value) {
      if (value) text += fmt::format(" {} {:.9g}", name, *value);
    };
    vector("viewpoint", change.viewpoint);
    vector("lookpoint", change.lookpoint);
    number("twist", change.twist);
    number("opening_angle", change.opening_angle);
    number("near", change.near_distance);
    number("far", change.far_distance);
    if (const auto* steps = std::get_if<InSteps>(&pace)) text += fmt::format(" in {} updates", steps->updates);
    if (const auto* time = std::get_if<InTime>(&pace)) text += fmt::format(" in {:.9g} s", seconds(time->time));
    return record("set_view {}{}", view, text);
  }
  Result<void> connect_view(int view, std::string_view camera) override {
    return record("connect_view {} {}", view, camera);
  }
  Result<void> load_views(std::string_view file) override { return record("load_views {}", file); }
  Result<void> save_views(std::string_view file) override { return record("save_views {}", file); }
  Result<void> set_mode(DisplayMode mode, bool on) override {
    constexpr std::array<std::string_view, kDisplayModes> kNames = {"workframes",
                                                                    "smear",
                                                                    "backface_removal",
                                                                    "cpu_backface_removal",
                                                                    "camera_main_view",
                                                                    "two_sided_light",
                                                                    "tcp_frame",
                                                                    "zero_point",
                                                                    "floor",
                                                                    "visibility_test",
                                                                    "shadows",
                                                                    "bell",
                                                                    "textures",
                                                                    "antialiasing"};
    return record("set_mode {} {}", kNames[static_cast<std::size_t>(mode)], on);
  }
  Result<void> set_legend(bool on) override { return record("set_legend {}", on); }
  std::string draw_mode_remark;  // the answer to RENDER
  Result<std::string> set_draw_mode(std::string_view node, bool branch, DrawMode mode) override {
    auto done = record("set_draw_mode {}{} {}", node, branch ? " and below" : "", static_cast<int>(mode));
    return done ? Result<std::string>(draw_mode_remark) : std::unexpected(std::move(done.error()));
  }
  Result<void> set_tag_length(double length_m) override { return record("set_tag_length {:.9g}", length_m); }
  Result<void> track(std::string_view camera, std::optional<std::string_view> frame) override {
    return frame ? record("track {} {}", camera, *frame) : record("track {} nothing", camera);
  }
  Result<void> show_pyramid(std::string_view camera, bool on) override {
    return record("show_pyramid {} {}", camera, on);
  }
  Result<void> set_camera_online(std::string_view camera, bool on) override {
    return record("set_camera_online {} {}", camera, on);
  }
  Result<void> set_arc(bool on) override { return record("set_arc {}", on); }
  Result<void> set_camera(std::string_view camera, double focal_distance_m, double fovy_rad) override {
    return record("set_camera {} {:.9g} {:.9g}", camera, focal_distance_m, fovy_rad);
  }
  Result<void> show_message(std::string_view text) override { return record("show_message [{}]", text); }
  Result<void> set_sensor_active(std::string_view sensor, bool active) override {
    return record("set_sensor_active {} {}", sensor, active);
  }
  Result<void> set_sensor_range(std::string_view sensor, double range_m) override {
    return record("set_sensor_range {} {:.9g}", sensor, range_m);
  }
  Result<void> set_range_send_mode(RangeSendMode mode) override {
    return record("set_range_send_mode {}",
                  mode == RangeSendMode::one_message_for_all ? "one_message_for_all" : "one_message_a_sensor");
  }
  Result<void> set_collision_active(bool active) override { return record("set_collision_active {}", active); }
  Result<void> set_collision_warning(double distance_m) override {
    return record("set_collision_warning {:.9g}", distance_m);
  }
  Result<void> set_collision_pair(std::string_view a, std::string_view b, PairTreatment treatment) override {
    constexpr std::array<std::string_view, 3> kNames = {"ignore", "test", "derive"};
    return record("set_collision_pair {} {} {}", a, b, kNames[static_cast<std::size_t>(treatment)]);
  }
  Result<std::string> set_force_memory(std::uint64_t send_type, std::int32_t key, std::size_t bytes) override {
    auto done = record("set_force_memory {} {:#x} {}", send_type, static_cast<std::uint32_t>(key), bytes);
    return done ? Result<std::string>(std::string()) : std::unexpected(std::move(done.error()));
  }
  Result<void> reset_haptic(std::string_view robot) override { return record("reset_haptic {}", robot); }
  Result<void> set_switch_memory(std::uint64_t send_type, std::int32_t key, std::size_t bytes) override {
    return record("set_switch_memory {} {:#x} {}", send_type, static_cast<std::uint32_t>(key), bytes);
  }
  Result<void> set_switches_online(bool online) override { return record("set_switches_online {}", online); }
  Result<std::string> set_force_arrows(const ForceArrowSettings& settings) override {
    constexpr std::array<std::string_view, 5> kNames = {"none", "x", "y", "z", "resultant"};
    auto done = record("set_force_arrows {} {} {}", kNames[static_cast<std::size_t>(settings.joint_forces)],
                       kNames[static_cast<std::size_t>(settings.joint_torques)],
                       kNames[static_cast<std::size_t>(settings.tcp_force)]);
    return done ? Result<std::string>(std::string()) : std::unexpected(std::move(done.error()));
  }
  Result<void> set_motor_forces_only(bool on) override { return record("set_motor_forces_only {}", on); }
  Result<void> set_force_limits(const ForceLimits& limits) override {
    return record("set_force_limits {:.9g} {:.9g}", limits.max_force, limits.max_torque);
  }
  Result<void> set_tcp_test(bool on, const std::array<double, 4>& values) override {
    return record("set_tcp_test {} {}", on, list_text(values));
  }
  Result<void> couple(std::string_view master, std::span<const SlaveJoints> slaves) override {
    return record("couple {}{}", master, slaves_text(slaves));
  }
  Result<void> uncouple(std::string_view master, std::span<const SlaveJoints> slaves) override {
    return record("uncouple {}{}", master, slaves_text(slaves));
  }
  Result<std::string> set_attributes(std::string_view object, std::uint16_t mask, std::uint16_t values) override {
    return remarked(record("set_attributes {} mask {:#05x} values {:#05x}", object, mask, values));
  }
  Result<std::string> set_cylinders(std::string_view geometry, const EffectorCylinders& cylinders) override {
    return remarked(record("set_cylinders {} flags {} shaft {:.9g} effector {:.9g} {:.9g} fourth {:.9g}", geometry,
                           cylinders.flags, cylinders.shaft_diameter_m, cylinders.effector_radius_m,
                           cylinders.effector_length_m, cylinders.fourth));
  }
  Result<std::string> set_connections(std::string_view hyper_file) override {
    return remarked(record("set_connections {}", hyper_file));
  }
  Result<std::string> set_network_shown(bool on) override { return remarked(record("set_network_shown {}", on)); }
  Result<std::string> reset_model() override { return remarked(record("reset_model")); }
  Result<std::string> set_limit(TissueLimit limit, std::uint8_t actions, double value) override {
    return remarked(record("set_limit {} actions {:#04x} value {:.9g}", word(limit), actions, value));
  }
  Result<std::string> set_effect(TissueEffect effect, bool on) override {
    return remarked(record("set_effect {} {}", word(effect), on));
  }
  Result<std::string> reset_pool() override { return remarked(record("reset_pool")); }
  Result<std::string> clean_lens() override { return remarked(record("clean_lens")); }
  Result<std::string> set_calculating(bool on) override { return remarked(record("set_calculating {}", on)); }
  Result<std::string> set_trigger(const InstrumentTrigger& trigger) override {
    constexpr std::array<std::string_view, 5> kTests = {"off", "at_least", "below", "within", "outside"};
    return remarked(record("set_trigger joint {} {} {:.9g} {:.9g} {}", trigger.joint,
                           kTests.at(std::to_underlying(trigger.test)), trigger.value_1, trigger.value_2,
                           word(trigger.kind)));
  }
  Result<std::string> set_clip(std::string_view file, const Pose& X_TC) override {
    return remarked(record("set_clip {} {}", file, pose_text(X_TC)));
  }
  Result<std::string> set_plane_mode(std::size_t plane, VolumePlaneMode mode, std::string_view volume) override {
    constexpr std::array<std::string_view, 4> kModes = {"active", "reverse", "visible", "off"};
    return remarked(record("set_plane_mode {} {} of [{}]", plane, kModes.at(static_cast<std::size_t>(mode)), volume));
  }
  Result<std::string> set_plane_position(std::size_t plane, const VolumePlanePosition& position,
                                         std::string_view volume) override {
    return remarked(record("set_plane_position {} {:.9g} {:.9g} {:.9g} of [{}]", plane, position.elevation_rad,
                           position.azimuth_rad, position.distance_m, volume));
  }
  Result<std::string> set_table(VolumeTable table, std::string_view volume) override {
    return remarked(record("set_table {} of [{}]", kVolumeTableWords.at(static_cast<std::size_t>(table)), volume));
  }
  Result<std::string> set_medical_table(const MedicalTableParameters& parameters, std::string_view volume) override {
    return remarked(record("set_medical_table air {:.9g} fat {:.9g} tissue {:.9g} bone {:.9g} of [{}]", parameters.air,
                           parameters.fat, parameters.tissue, parameters.bone, volume));
  }
  Result<std::string> set_table_parameters(VolumeTable table, const VolumeTableParameters& parameters,
                                           std::string_view volume) override {
    return remarked(record("set_table_parameters {} opacity {:.9g} gain {:.9g} level {:.9g} window {:.9g} of [{}]",
                           kVolumeTableWords.at(static_cast<std::size_t>(table)), parameters.opacity, parameters.gain,
                           parameters.level, parameters.window, volume));
  }
  Result<std::string> set_surface(bool on, std::optional<double> value, std::string_view volume) override {
    return remarked(record("set_surface {}{} of [{}]", on, value ? fmt::format(" {:.9g}", *value) : "", volume));
  }
  Result<std::string> reload_tables(std::string_view volume) override {
    return remarked(record("reload_tables of [{}]", volume));
  }
  Result<void> save_flight_record(std::string_view file_name) override {
    return record("save_flight_record {}", file_name);
  }
  Result<void> record(RecordAction action) override { return record("record {}", static_cast<int>(action)); }
  Result<std::string> acknowledge_alarms(std::string_view name, std::uint64_t alarm) override {
    return remarked(record("acknowledge_alarms {} {}", name, alarm));
  }

 private:
  // The answer of a call that may have a remark.
  static Result<std::string> remarked(Result<void> done) {
    return done ? Result<std::string>(std::string()) : std::unexpected(std::move(done.error()));
  }
  template <class... Args>
  Result<void> record(fmt::format_string<Args...> format, Args&&... args) {
    const std::string line = fmt::format(format, std::forward<Args>(args)...);
    if (!refused_call.empty() && line.starts_with(refused_call)) return fail("the test refuses " + line);
    calls.push_back(line);
    return {};
  }
  static double tidy(double value) { return std::abs(value) < 5e-13 ? 0.0 : value; }  // no -0 and no rounding dust
  static std::string target_text(const MotionTarget& target) {
    const std::string mode(name_of(target.mode));
    switch (target.mode) {
      case TargetMode::joint_abs:
      case TargetMode::joint_inc:
        return mode + " " + list_text(target.joints);
      case TargetMode::start_position:
      case TargetMode::reference_position:
        return mode;
      default:
        return mode + " " + pose_text(target.pose);
    }
  }
  static std::string slaves_text(std::span<const SlaveJoints> slaves) {
    std::string text;
    for (const SlaveJoints& slave : slaves) {
      text += fmt::format(" > {}", slave.robot);
      for (const auto& [of_master, of_slave] : slave.joints) text += fmt::format(" {}={}", of_slave, of_master);
    }
    return text;
  }
  static std::string list_text(std::span<const double> values) {
    std::string text;
    for (const double value : values) text += fmt::format("{}{:.9g}", text.empty() ? "" : " ", tidy(value));
    return text;
  }
  // Row by row, so that no convention of angles is needed to read it.
  static std::string pose_text(const Pose& X) {
    std::string text;
    for (Eigen::Index row = 0; row < 3; ++row) {
      text += fmt::format("{}[{:.6g} {:.6g} {:.6g} | {:.9g}]", row == 0 ? "" : " ", tidy(X.matrix()(row, 0)),
                          tidy(X.matrix()(row, 1)), tidy(X.matrix()(row, 2)), tidy(X.matrix()(row, 3)));
    }
    return text;
  }
};

}  // namespace cellmirror::testing
