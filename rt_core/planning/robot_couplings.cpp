#include "rt_core/planning/robot_couplings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::planning {

namespace {

constexpr std::string_view kFreeFirst = "free it first: MASTER_SLAVE off with its master";

std::optional<std::uint8_t> joint_number(const RobotModel& robot, std::string_view name) {
  const auto found = std::ranges::find(robot.joints(), name, &RobotJoint::name);
  if (found == robot.joints().end()) return std::nullopt;
  return static_cast<std::uint8_t>(found - robot.joints().begin());
}

Error no_joint(const RobotModel& robot, std::string_view name) {
  const std::vector<std::string> names = robot.joint_names();
  std::string remedy = did_you_mean(name, names);
  if (remedy.empty()) remedy = fmt::format("its joints: {}", fmt::join(names, ", "));
  return {fmt::format("{} has no joint {}", robot.id(), printable(name)), std::move(remedy)};
}

bool same_kind(JointKind a, JointKind b) { return (a == JointKind::prismatic) == (b == JointKind::prismatic); }

const char* kind_word(JointKind kind) { return kind == JointKind::prismatic ? "slides" : "turns"; }

Result<CoupledJoint> joint_pair(const RobotModel& master, const RobotModel& slave,
                                const std::pair<std::string_view, std::string_view>& names) {
  const auto of_master = joint_number(master, names.first);
  if (!of_master) return std::unexpected(no_joint(master, names.first));
  const auto of_slave = joint_number(slave, names.second);
  if (!of_slave) return std::unexpected(no_joint(slave, names.second));
  const JointKind master_kind = master.joints()[*of_master].kind;
  const JointKind slave_kind = slave.joints()[*of_slave].kind;
  if (!same_kind(master_kind, slave_kind)) {
    return fail(fmt::format("{} of {} {}, {} of {} {}: one cannot follow the other", names.first, master.id(),
                            kind_word(master_kind), names.second, slave.id(), kind_word(slave_kind)),
                "couple joints of one kind");
  }
  const double velocity = slave.parameters().max_velocity[*of_slave];
  if (!std::isfinite(velocity) || velocity <= 0.0) {
    return fail(fmt::format("{} of {} has no velocity limit, so it cannot follow", names.second, slave.id()),
                "set one with rob_jnt_max_vel");
  }
  return CoupledJoint{*of_master, *of_slave};
}

// The joints of a slave without those that are freed.
Result<void> free_joints(const RobotModel& master, const RobotModel& slave, const SlaveJoints& freed,
                         std::vector<CoupledJoint>& joints) {
  for (const auto& names : freed.joints) {
    const auto of_master = joint_number(master, names.first);
    if (!of_master) return std::unexpected(no_joint(master, names.first));
    const auto of_slave = joint_number(slave, names.second);
    if (!of_slave) return std::unexpected(no_joint(slave, names.second));
    const auto taken = std::erase_if(joints, [&](const CoupledJoint& joint) {
      return joint.master_joint == *of_master && joint.slave_joint == *of_slave;
    });
    if (taken == 0)
      return fail(fmt::format("{} of {} does not follow {} of {}", names.second, slave.id(), names.first, master.id()));
  }
  return {};
}

}  // namespace

Result<RobotCoupling> RobotCouplings::checked(const Cell& cell, const RobotModel& master, const SlaveJoints& slave,
                                              const BySlave& others,
                                              const std::function<bool(std::string_view robot)>& is_mirrored) {
  const RobotModel* robot = cell.robot(slave.robot);
  if (robot == nullptr) return std::unexpected(cell.explain_robot(slave.robot));
  if (robot->id() == master.id()) return fail(fmt::format("{} cannot be its own slave", robot->id()));
  if (is_mirrored(robot->id())) {
    return fail(fmt::format("{} is mirrored, so it cannot follow {}", robot->id(), master.id()),
                fmt::format("take it offline first: ROBOT {} offline", robot->id()));
  }
  const auto present = others.find(robot->id());
  if (present != others.end() && present->second.master != master.id())
    return fail(fmt::format("{} follows {} already", robot->id(), present->second.master), std::string(kFreeFirst));
  // Up from the master: whom does it follow, and whom does that one follow?
  for (auto up = others.find(master.id()); up != others.end(); up = others.find(up->second.master)) {
    if (up->second.master == robot->id()) {
      return fail(fmt::format("{} follows {}: they would follow each other in a circle", master.id(), robot->id()),
                  "take one coupling of the circle off first");
    }
  }
  RobotCoupling coupled{master.id(), {}};
  unsigned driven = 0;
  for (const auto& names : slave.joints) {
    const auto pair = joint_pair(master, *robot, names);
    if (!pair) return std::unexpected(pair.error());
    const unsigned bit = 1U << pair->slave_joint;
    if ((driven & bit) != 0)
      return fail(fmt::format("the joint {} of {} would follow two joints", names.second, robot->id()));
    driven |= bit;
    coupled.joints.push_back(*pair);
  }
  if (coupled.joints.empty()) return fail(fmt::format("no joints of {} are named", robot->id()));
  return coupled;
}

Result<RobotCouplings::Changes> RobotCouplings::coupled(
    const Cell& cell, std::string_view master_name, std::span<const SlaveJoints> slaves,
    const std::function<bool(std::string_view robot)>& is_mirrored) const {
  const RobotModel* master = cell.robot(master_name);
  if (master == nullptr) return std::unexpected(cell.explain_robot(master_name));
  BySlave all = by_slave_;
  Changes changes;
  for (const SlaveJoints& slave : slaves) {
    auto coupling = checked(cell, *master, slave, all, is_mirrored);
    if (!coupling) return std::unexpected(std::move(coupling.error()));
    std::string name(slave.robot);
    if (std::ranges::find(changes, name, &Changes::value_type::first) != changes.end())
      return fail(fmt::format("{} is named twice", name));
    all[name] = *coupling;
    changes.emplace_back(std::move(name), std::move(*coupling));
  }
  const auto of_master =
      std::ranges::count_if(all, [&](const auto& entry) { return entry.second.master == master->id(); });
  if (static_cast<std::size_t>(of_master) > kMaxSlaves) {
    return fail(fmt::format("{} would have {} slaves", master->id(), of_master),
                fmt::format("{} are the most; a slave may have slaves of its own", kMaxSlaves));
  }
  return changes;
}

Result<RobotCouplings::Changes> RobotCouplings::freed(const Cell& cell, std::string_view master_name,
                                                      std::span<const SlaveJoints> slaves) const {
  const RobotModel* master = cell.robot(master_name);
  if (master == nullptr) return std::unexpected(cell.explain_robot(master_name));
  Changes changes;
  for (const SlaveJoints& slave : slaves) {
    const RobotModel* robot = cell.robot(slave.robot);
    if (robot == nullptr) return std::unexpected(cell.explain_robot(slave.robot));
    const RobotCoupling* present = find(slave.robot);
    if (present == nullptr || present->master != master->id())
      return fail(fmt::format("{} does not follow {}", robot->id(), master->id()));
    auto change = std::ranges::find(changes, robot->id(), &Changes::value_type::first);
    if (change == changes.end()) change = changes.emplace(change, robot->id(), *present);
    if (auto done = free_joints(*master, *robot, slave, change->second.joints); !done)
      return std::unexpected(std::move(done.error()));
  }
  return changes;
}

void RobotCouplings::apply(const std::string& slave, const RobotCoupling& coupling) {
  if (coupling.joints.empty()) {
    by_slave_.erase(slave);
  } else {
    by_slave_[slave] = coupling;
  }
}

void RobotCouplings::forget(std::string_view slave) {
  if (const auto found = by_slave_.find(slave); found != by_slave_.end()) by_slave_.erase(found);
}

const RobotCoupling* RobotCouplings::find(std::string_view slave) const {
  const auto found = by_slave_.find(slave);
  return found == by_slave_.end() ? nullptr : &found->second;
}

}  // namespace cellmirror::planning
