// POS_ROB (manual 1.2.1) and our own commands for motion.
#include <array>

#include "rt_core/base/capacity.hpp"
#include "scripts/commands/registry.hpp"

namespace cellmirror {

namespace script {

namespace {

// The target behind the robot's name and, in MOVE_ROB, the path.
class TargetReader {
 public:
  TargetReader(const ParsedCommand& command, TargetMode mode, std::size_t first_slot) {
    target_.mode = mode;
    switch (mode) {
      case TargetMode::joint_abs:
      case TargetMode::joint_inc:
        target_.joints = std::span(joints_).first(command.numbers(first_slot, joints_));
        break;
      case TargetMode::start_position:
      case TargetMode::reference_position:
        break;
      default:
        target_.pose = pose_at(command, first_slot);
        break;
    }
  }
  TargetReader(const TargetReader&) = delete;
  TargetReader& operator=(const TargetReader&) = delete;

  [[nodiscard]] const MotionTarget& target() const { return target_; }

 private:
  // Translation first, then roll, pitch, yaw.
  static Pose pose_at(const ParsedCommand& command, std::size_t slot) {
    return pose_from_xyz_rpy(vector_at(command, slot), vector_at(command, slot + 3));
  }

  std::array<double, kMaxJointsPerRobot> joints_;
  MotionTarget target_;
};

template <TargetMode mode>
Outcome position(const ParsedCommand& command, CommandHost& host) {
  const TargetReader reader(command, mode, slots::pos_rob::kTarget);
  auto begun = host.motion.position(command.text(slots::pos_rob::kRobot), reader.target());
  if (!begun) return Outcome::refused(std::move(begun.error()));
  return *begun ? Outcome::pending(std::move(*begun)) : Outcome::done();
}

template <TargetMode mode>
Outcome queue_move(const ParsedCommand& command, CommandHost& host) {
  const TargetReader reader(command, mode, slots::move_rob::kTarget);
  const auto path = static_cast<MovePath>(command.choice(slots::move_rob::kPath));
  return Outcome::of(host.motion.queue_move(command.text(slots::move_rob::kRobot), path, reader.target()));
}

Outcome stop(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.motion.stop(command.text(kOnlySlot)));
}

Outcome set_positioning(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.motion.set_positioning(static_cast<Positioning>(command.choice(kOnlySlot))));
}

constexpr Registration kHandlers[] = {
    {FormId::pos_rob_joint_abs, position<TargetMode::joint_abs>},
    {FormId::pos_rob_joint_inc, position<TargetMode::joint_inc>},
    {FormId::pos_rob_frame_abs, position<TargetMode::frame_abs>},
    {FormId::pos_rob_frame_inc, position<TargetMode::frame_inc>},
    {FormId::pos_rob_tool_inc, position<TargetMode::tool_inc>},
    {FormId::pos_rob_screen_inc, position<TargetMode::screen_inc>},
    {FormId::rob_positioning, set_positioning},
    {FormId::move_rob_joint_abs, queue_move<TargetMode::joint_abs>},
    {FormId::move_rob_joint_inc, queue_move<TargetMode::joint_inc>},
    {FormId::move_rob_frame_abs, queue_move<TargetMode::frame_abs>},
    {FormId::move_rob_frame_inc, queue_move<TargetMode::frame_inc>},
    {FormId::move_rob_tool_inc, queue_move<TargetMode::tool_inc>},
    {FormId::move_rob_screen_inc, queue_move<TargetMode::screen_inc>},
    {FormId::move_rob_start, queue_move<TargetMode::start_position>},
    {FormId::move_rob_reference, queue_move<TargetMode::reference_position>},
    {FormId::stop_rob, stop},
};

}  // namespace

std::span<const Registration> motion_handlers() { return kHandlers; }

}  // namespace script
}  // namespace cellmirror
