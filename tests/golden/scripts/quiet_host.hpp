// A gateway for benchmarks and fuzzing: accepts everything, remembers only which robot is active.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scripts/commands/host.hpp"
#include "tests/golden/scripts/fake_names.hpp"

namespace cellmirror::testing {

class QuietHost final : public WorldHost,
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
  FakeNames names;
  std::size_t calls = 0;

  [[nodiscard]] CommandHost host() {
    return {names, *this, *this, *this, *this, *this, *this, *this, *this, *this, *this};
  }

  Result<void> activate(std::string_view /*node*/) override { return called(); }
  Result<void> deactivate(std::string_view /*node*/) override { return called(); }
  Result<void> delete_node(std::string_view /*node*/) override { return called(); }
  Result<void> swap_node(std::string_view /*node*/) override { return called(); }
  Result<void> level_down(std::string_view /*node*/) override { return called(); }
  Result<void> level_up(std::string_view /*node*/) override { return called(); }
  Result<void> set_placement(std::string_view /*node*/, const Pose& /*X_PF*/) override { return called(); }
  Result<void> connect(std::string_view /*part*/, std::string_view /*predecessor*/) override { return called(); }
  Result<void> attach_at_workframe(std::string_view /*part*/, std::string_view /*predecessor*/,
                                   std::string_view /*workframe*/) override {
    return called();
  }
  Result<void> draw_scene() override { return called(); }
  Result<void> set_active_robot(std::string_view robot) override {
    names.active = robot;
    return called();
  }
  Result<void> set_online(std::string_view /*robot*/, bool /*online*/) override { return called(); }
  Result<void> set_sending(std::string_view /*robot*/, bool /*sending*/) override { return called(); }
  Result<ActivityHandle> position(std::string_view /*robot*/, const MotionTarget& /*target*/) override {
    ++calls;
    return ActivityHandle();
  }
  Result<void> queue_move(std::string_view /*robot*/, MovePath /*path*/, const MotionTarget& /*target*/) override {
    return called();
  }
  Result<void> stop(std::string_view /*robot*/) override { return called(); }
  Result<void> set_positioning(Positioning /*positioning*/) override { return called(); }
  [[nodiscard]] bool moving() const override { return false; }
  Result<std::string> set_joint_parameter(JointParameter /*which*/, std::span<const double> /*values*/) override {
    if (auto done = called(); !done) return std::unexpected(done.error());
    return std::string();
  }
  Result<void> set_scalar_parameter(ScalarParameter /*which*/, double /*value*/) override { return called(); }
  Result<void> set_fly(FlyType /*type*/, double /*parameter*/) override { return called(); }
  Result<void> set_ptp_mode(PtpMode /*mode*/) override { return called(); }
  Result<void> set_velocity_profile(VelocityProfile /*profile*/) override { return called(); }
  Result<void> set_inverse_class(InverseClass /*inverse_class*/) override { return called(); }
  Result<void> set_point_of_reference(const Pose& /*X_FP*/) override { return called(); }
  Result<void> set_tool_center_point(const Pose& /*X_PT*/) override { return called(); }
  Result<void> set_language(std::string_view /*language*/) override { return called(); }
  Result<ActivityHandle> load_program(std::string_view /*program*/, std::string_view /*robot*/) override {
    ++calls;
    return ActivityHandle();
  }
  Result<ActivityHandle> run_program(std::string_view /*program*/, std::string_view /*robot*/,
                                     ProgramBegin /*begin*/) override {
    ++calls;
    return ActivityHandle();
  }
  Result<void> delete_program(std::string_view /*program*/, std::string_view /*robot*/) override { return called(); }
  Result<void> hold_program(std::string_view /*robot*/) override { return called(); }
  Result<void> resume_program(std::string_view /*robot*/) override { return called(); }
  Result<void> step_program(std::string_view /*robot*/, bool /*backward*/) override { return called(); }
  Result<void> stop_programs(std::string_view /*robot*/) override { return called(); }
  Result<ActivityHandle> await_programs(std::string_view /*robot*/) override {
    ++calls;
    return ActivityHandle();
  }
  Result<void> record_program(std::string_view /*program*/, std::string_view /*robot*/, RecordStep /*step*/,
                              std::string_view /*point*/) override {
    return called();
  }
  Result<void> set_digital_input(std::string_view /*robot*/, std::size_t /*number*/, bool /*on*/) override {
    return called();
  }
  Result<void> set_analogue_input(std::string_view /*robot*/, std::size_t /*number*/, double /*value*/) override {
    return called();
  }
  [[nodiscard]] std::uint64_t failures() const override { return 0; }
  [[nodiscard]] Result<void> verdict(std::uint64_t /*since*/) const override { return {}; }
  [[nodiscard]] bool busy() const override { return false; }
  Result<void> set_display(int /*display*/, bool /*full_screen*/) override { return called(); }
  Result<void> set_view(int /*view*/, const ViewChange& /*change*/, const ViewPace& /*pace*/) override {
    return called();
  }
  Result<void> connect_view(int /*view*/, std::string_view /*camera*/) override { return called(); }
  Result<void> load_views(std::string_view /*file*/) override { return called(); }
  Result<void> save_views(std::string_view /*file*/) override { return called(); }
  Result<void> set_mode(DisplayMode /*mode*/, bool /*on*/) override { return called(); }
  Result<void> set_legend(bool /*on*/) override { return called(); }
  Result<std::string> set_draw_mode(std::string_view /*node*/, bool /*branch*/, DrawMode /*mode*/) override {
    ++calls;
    return std::string();
  }
  Result<void> set_tag_length(double /*length_m*/) override { return called(); }
  Result<void> track(std::string_view /*camera*/, std::optional<std::string_view> /*frame*/) override {
    return called();
  }
  Result<void> show_pyramid(std::string_view /*camera*/, bool /*on*/) override { return called(); }
  Result<void> set_camera_online(std::string_view /*camera*/, bool /*on*/) override { return called(); }
  Result<void> set_arc(bool /*on*/) override { return called(); }
  Result<void> set_camera(std::string_view /*camera*/, double /*focal_distance_m*/, double /*fovy_rad*/) override {
    return called();
  }
  Result<void> show_message(std::string_view /*text*/) override { return called(); }
  Result<void> set_sensor_active(std::string_view /*sensor*/, bool /*active*/) override { return called(); }
  Result<void> set_sensor_range(std::string_view /*sensor*/, double /*range_m*/) override { return called(); }
  Result<void> set_range_send_mode(RangeSendMode /*mode*/) override { return called(); }
  Result<void> set_collision_active(bool /*active*/) override { return called(); }
  Result<void> set_collision_warning(double /*distance_m*/) override { return called(); }
  Result<void> set_collision_pair(std::string_view /*a*/, std::string_view /*b*/,
                                  PairTreatment /*treatment*/) override {
    return called();
  }
  Result<std::string> set_force_memory(std::uint64_t /*send_type*/, std::int32_t /*key*/,
                                       std::size_t /*bytes*/) override {
    ++calls;
    return std::string();
  }
  Result<void> reset_haptic(std::string_view /*robot*/) override { return called(); }
  Result<void> set_switch_memory(std::uint64_t /*send_type*/, std::int32_t /*key*/, std::size_t /*bytes*/) override {
    return called();
  }
  Result<void> set_switches_online(bool /*online*/) override { return called(); }
  Result<std::string> set_force_arrows(const ForceArrowSettings& /*settings*/) override {
    ++calls;
    return std::string();
  }
  Result<void> set_motor_forces_only(bool /*on*/) override { return called(); }
  Result<void> set_force_limits(const ForceLimits& /*limits*/) override { return called(); }
  Result<void> set_tcp_test(bool /*on*/, const std::array<double, 4>& /*values*/) override { return called(); }
  // Looks at every name, so that the sanitizers see where they point to.
  Result<void> couple(std::string_view master, std::span<const SlaveJoints> slaves) override {
    std::size_t letters = master.size();
    for (const SlaveJoints& slave : slaves) {
      for (const auto& [of_master, of_slave] : slave.joints) letters += of_master.size() + of_slave.size();
    }
    return letters > 0 ? called() : fail("names are empty");
  }
  Result<void> uncouple(std::string_view master, std::span<const SlaveJoints> slaves) override {
    return couple(master, slaves);
  }
  Result<std::string> set_attributes(std::string_view /*object*/, std::uint16_t /*mask*/,
                                     std::uint16_t /*values*/) override {
    return remarked();
  }
  Result<std::string> set_cylinders(std::string_view /*geometry*/, const EffectorCylinders& /*cylinders*/) override {
    return remarked();
  }
  Result<std::string> set_connections(std::string_view /*hyper_file*/) override { return remarked(); }
  Result<std::string> set_network_shown(bool /*on*/) override { return remarked(); }
  Result<std::string> reset_model() override { return remarked(); }
  Result<std::string> set_limit(TissueLimit /*limit*/, std::uint8_t /*actions*/, double /*value*/) override {
    return remarked();
  }
  Result<std::string> set_effect(TissueEffect /*effect*/, bool /*on*/) override { return remarked(); }
  Result<std::string> reset_pool() override { return remarked(); }
  Result<std::string> clean_lens() override { return remarked(); }
  Result<std::string> set_calculating(bool /*on*/) override { return remarked(); }
  Result<std::string> set_trigger(const InstrumentTrigger& /*trigger*/) override { return remarked(); }
  Result<std::string> set_clip(std::string_view /*file*/, const Pose& /*X_TC*/) override { return remarked(); }
  Result<std::string> set_plane_mode(std::size_t /*plane*/, VolumePlaneMode /*mode*/,
                                     std::string_view /*volume*/) override {
    return remarked();
  }
  Result<std::string> set_plane_position(std::size_t /*plane*/, const VolumePlanePosition& /*position*/,
                                         std::string_view /*volume*/) override {
    return remarked();
  }
  Result<std::string> set_table(VolumeTable /*table*/, std::string_view /*volume*/) override { return remarked(); }
  Result<std::string> set_medical_table(const MedicalTableParameters& /*parameters*/,
                                        std::string_view /*volume*/) override {
    return remarked();
  }
  Result<std::string> set_table_parameters(VolumeTable /*table*/, const VolumeTableParameters& /*parameters*/,
                                           std::string_view /*volume*/) override {
    return remarked();
  }
  Result<std::string> set_surface(bool /*on*/, std::optional<double> /*value*/, std::string_view /*volume*/) override {
    return remarked();
  }
  Result<std::string> reload_tables(std::string_view /*volume*/) override { return remarked(); }
  Result<void> save_flight_record(std::string_view /*file_name*/) override { return called(); }
  Result<void> record(RecordAction /*action*/) override { return called(); }
  Result<std::string> acknowledge_alarms(std::string_view /*name*/, std::uint64_t /*alarm*/) override {
    return remarked();
  }

 private:
  Result<void> called() {
    ++calls;
    return {};
  }
  Result<std::string> remarked() {
    ++calls;
    return std::string();
  }
};

}  // namespace cellmirror::testing
