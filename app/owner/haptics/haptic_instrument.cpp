#include "app/owner/haptics/haptic_instrument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/cell/robot_chain.hpp"

namespace cellmirror::app {

namespace {

// A base that is carried by something that moves is at another place in every tick.
constexpr double kSamePlace = 1e-6;  // m, and sine of the angle

bool same_place(const Pose& a, const Pose& b) { return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() <= kSamePlace; }

bool same_joint(const kinematics::ChainJoint& a, const kinematics::ChainJoint& b) {
  return a.X_PJ.matrix() == b.X_PJ.matrix() && a.kind == b.kind && a.variable == b.variable &&
         a.multiplier == b.multiplier && a.offset == b.offset;
}

}  // namespace

Result<std::shared_ptr<const haptics::Instrument>> make_instrument(const Cell& cell, const RobotModel& robot,
                                                                   const haptics::HapticSettings& settings,
                                                                   std::span<const JointValues> q) {
  auto chain = robot_chain(cell, robot.id());
  if (!chain) return std::unexpected(chain.error());
  if (settings.gripper_joint >= static_cast<int>(robot.joint_count())) {
    return fail(fmt::format("the gripper of {} is joint {}, but it has {} joints", robot.id(),
                            settings.gripper_joint + 1, robot.joint_count()));
  }
  haptics::Instrument out{.slot = static_cast<std::uint8_t>(robot.slot()),
                          .joint_count = static_cast<std::uint8_t>(robot.joint_count()),
                          .chain = std::move(chain->chain),
                          .variable_joint = {},
                          .X_WB = cell.world_pose(robot.zero_point(), q),
                          .lower = robot.parameters().min_range,
                          .upper = robot.parameters().max_range,
                          .settings = settings};
  for (std::size_t i = 0; i < chain->joint.size(); ++i)
    out.variable_joint[i] = static_cast<std::uint8_t>(chain->joint[i]);
  return std::make_shared<const haptics::Instrument>(std::move(out));
}

bool same_instrument(const haptics::Instrument& a, const haptics::Instrument& b) {
  return a.slot == b.slot && a.joint_count == b.joint_count && a.variable_joint == b.variable_joint &&
         a.lower == b.lower && a.upper == b.upper && same_place(a.X_WB, b.X_WB) &&
         a.chain.X_LT().matrix() == b.chain.X_LT().matrix() &&
         std::ranges::equal(a.chain.joints(), b.chain.joints(), same_joint);
}

}  // namespace cellmirror::app
