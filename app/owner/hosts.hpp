// The gateway behind SCRIPT's narrow interfaces. All of it belongs to the thread that owns the cell.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "app/owner/display/display_service.hpp"
#include "app/owner/fleet.hpp"
#include "app/owner/motion/coupling_service.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/owner/programs/program_service.hpp"
#include "app/owner/volume/volume_service.hpp"
#include "rt_core/cell/cell.hpp"
#include "scripts/commands/host.hpp"

namespace cellmirror::app {

class CellNames final : public NameDirectory {
 public:
  explicit CellNames(const Cell& cell) : cell_(cell) {}
  [[nodiscard]] bool knows(NameKind kind, std::string_view name) const override;
  [[nodiscard]] Error explain(NameKind kind, std::string_view name) const override;
  [[nodiscard]] std::span<const JointKind> joints(std::string_view robot) const override;
  [[nodiscard]] std::vector<std::string> joint_names(std::string_view robot) const override;
  [[nodiscard]] std::string_view active_robot() const override;
  [[nodiscard]] std::vector<std::string> all(NameKind kind) const override;

  void set_active(std::string_view robot) { active_ = robot; }

 private:
  const Cell& cell_;
  std::string active_;
};

class CellWorld final : public WorldHost {
 public:
  // They outlive this.
  struct Parts {
    Cell& cell;
    Fleet& fleet;
    MotionService& motion;
    ProgramService& programs;
    VolumeService& volumes;
    std::function<void()> draw;  // publishes the picture of the cell
  };
  explicit CellWorld(Parts parts) : parts_(std::move(parts)) {}
  Result<void> activate(std::string_view node) override;
  Result<void> deactivate(std::string_view node) override;
  Result<void> delete_node(std::string_view node) override;
  Result<void> swap_node(std::string_view node) override;
  Result<void> level_down(std::string_view node) override;
  Result<void> level_up(std::string_view node) override;
  Result<void> set_placement(std::string_view node, const Pose& X_PF) override;
  Result<void> connect(std::string_view part, std::string_view predecessor) override;
  Result<void> attach_at_workframe(std::string_view part, std::string_view predecessor,
                                   std::string_view workframe) override;
  Result<void> draw_scene() override;

 private:
  // After a change that may have brought or taken robots.
  Result<void> followed(Result<void> changed);

  Parts parts_;
};

class CellRobots final : public RobotHost {
 public:
  CellRobots(Cell& cell, Fleet& fleet, MotionService& motion, CouplingService& couplings, ProgramService& programs,
             CellNames& names)
      : cell_(cell), fleet_(fleet), motion_(motion), couplings_(couplings), programs_(programs), names_(names) {}
  Result<void> set_active_robot(std::string_view robot) override;
  Result<void> set_online(std::string_view robot, bool online) override;
  Result<void> set_sending(std::string_view robot, bool sending) override { return fleet_.set_sending(robot, sending); }
  Result<std::string> set_joint_parameter(JointParameter which, std::span<const double> values) override;
  Result<void> set_scalar_parameter(ScalarParameter which, double value) override;
  Result<void> set_fly(FlyType type, double parameter) override;
  Result<void> set_ptp_mode(PtpMode mode) override;
  Result<void> set_velocity_profile(VelocityProfile profile) override;
  Result<void> set_inverse_class(InverseClass inverse_class) override;
  Result<void> set_point_of_reference(const Pose& X_FP) override;
  Result<void> set_tool_center_point(const Pose& X_PT) override;

 private:
  Result<RobotModel*> active();
  // rob_jnt_start_pos: the robot goes there while the simulation has not begun for it. A remark where it has.
  Result<std::string> begin_at_start(const RobotModel& robot);

  Cell& cell_;
  Fleet& fleet_;
  MotionService& motion_;
  CouplingService& couplings_;
  ProgramService& programs_;
  CellNames& names_;
};

class CellDiagnosis final : public DiagnosisHost {
 public:
  using Acknowledge = std::function<Result<std::string>(std::string_view name, std::uint64_t alarm)>;
  CellDiagnosis(std::function<Result<void>(std::string_view)> save, std::function<Result<void>(RecordAction)> record,
                Acknowledge acknowledge = {})
      : save_(std::move(save)), record_(std::move(record)), acknowledge_(std::move(acknowledge)) {}
  Result<void> save_flight_record(std::string_view file_name) override { return save_(file_name); }
  Result<void> record(RecordAction action) override {
    if (record_) return record_(action);
    return fail("off line nothing is recorded");
  }
  Result<std::string> acknowledge_alarms(std::string_view name, std::uint64_t alarm) override {
    if (acknowledge_) return acknowledge_(name, alarm);
    return fail("off line there are no alarms");
  }

 private:
  std::function<Result<void>(std::string_view)> save_;
  std::function<Result<void>(RecordAction)> record_;  // empty: off line
  Acknowledge acknowledge_;                           // empty: off line
};

}  // namespace cellmirror::app
