#include "app/owner/motion/coupling_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "rt_core/base/text.hpp"

namespace cellmirror::app {

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

std::uint16_t mask_of(std::span<const engine::CoupledJoint> joints) {
  unsigned mask = 0;
  for (const engine::CoupledJoint& joint : joints) mask |= 1U << joint.slave_joint;
  return static_cast<std::uint16_t>(mask);
}

}  // namespace

Result<engine::CoupledJoint> CouplingService::joint_pair(
    const RobotModel& master, const RobotModel& slave,
    const std::pair<std::string_view, std::string_view>& names) const {
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
  return engine::CoupledJoint{*of_master, *of_slave};
}

Result<CouplingService::Coupled> CouplingService::checked(const RobotModel& master, const SlaveJoints& slave,
                                                          const ByName& others) const {
  const RobotModel* robot = cell_.robot(slave.robot);
  if (robot == nullptr) return std::unexpected(cell_.explain_robot(slave.robot));
  if (robot->id() == master.id()) return fail(fmt::format("{} cannot be its own slave", robot->id()));
  if (const auto simulated = fleet_.check_simulated(robot->id()); !simulated) {
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
  Coupled coupled{master.id(), {}};
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

Result<void> CouplingService::couple(std::string_view master_name, std::span<const SlaveJoints> slaves) {
  follow();
  const RobotModel* master = cell_.robot(master_name);
  if (master == nullptr) return std::unexpected(cell_.explain_robot(master_name));
  ByName all = by_slave_;
  std::vector<std::string> changed;
  for (const SlaveJoints& slave : slaves) {
    auto coupled = checked(*master, slave, all);
    if (!coupled) return std::unexpected(std::move(coupled.error()));
    std::string name(slave.robot);
    if (std::ranges::find(changed, name) != changed.end()) return fail(fmt::format("{} is named twice", name));
    changed.push_back(name);
    all[name] = std::move(*coupled);
  }
  const auto of_master =
      std::ranges::count_if(all, [&](const auto& entry) { return entry.second.master == master->id(); });
  if (static_cast<std::size_t>(of_master) > kMaxSlaves) {
    return fail(fmt::format("{} would have {} slaves", master->id(), of_master),
                fmt::format("{} are the most; a slave may have slaves of its own", kMaxSlaves));
  }
  for (const std::string& name : changed) {
    if (auto sent = send(name, all[name]); !sent) return sent;
    by_slave_[name] = all[name];
    motion_.cancel(name, {fmt::format("{} follows {} now", name, master->id()), {}});
  }
  return {};
}

Result<void> CouplingService::uncouple(std::string_view master_name, std::span<const SlaveJoints> slaves) {
  follow();
  const RobotModel* master = cell_.robot(master_name);
  if (master == nullptr) return std::unexpected(cell_.explain_robot(master_name));
  ByName changed;
  for (const SlaveJoints& slave : slaves) {
    const RobotModel* robot = cell_.robot(slave.robot);
    if (robot == nullptr) return std::unexpected(cell_.explain_robot(slave.robot));
    const auto found = by_slave_.find(slave.robot);
    if (found == by_slave_.end() || found->second.master != master->id())
      return fail(fmt::format("{} does not follow {}", robot->id(), master->id()));
    Coupled rest = changed.contains(robot->id()) ? changed[robot->id()] : found->second;
    for (const auto& names : slave.joints) {
      const auto of_master = joint_number(*master, names.first);
      if (!of_master) return std::unexpected(no_joint(*master, names.first));
      const auto of_slave = joint_number(*robot, names.second);
      if (!of_slave) return std::unexpected(no_joint(*robot, names.second));
      const auto taken = std::erase_if(rest.joints, [&](const engine::CoupledJoint& joint) {
        return joint.master_joint == *of_master && joint.slave_joint == *of_slave;
      });
      if (taken == 0) {
        return fail(
            fmt::format("{} of {} does not follow {} of {}", names.second, robot->id(), names.first, master->id()));
      }
    }
    changed[robot->id()] = std::move(rest);
  }
  for (auto& [name, rest] : changed) {
    if (auto sent = rest.joints.empty() ? send_free(name) : send(name, rest); !sent) return sent;
    motion_.cancel(name, {fmt::format("{} follows {} no longer", name, master->id()), {}});
    if (rest.joints.empty()) {
      by_slave_.erase(name);
    } else {
      by_slave_[name] = std::move(rest);
    }
  }
  return {};
}

Result<void> CouplingService::send(std::string_view slave, const Coupled& coupled) {
  const RobotModel& robot = *cell_.robot(slave);
  engine::Coupling coupling{.master = static_cast<std::uint8_t>(cell_.robot(coupled.master)->slot()),
                            .slave = static_cast<std::uint8_t>(robot.slot()),
                            .count = static_cast<std::uint8_t>(coupled.joints.size()),
                            .joints = {},
                            .max_velocity = robot.parameters().max_velocity};
  std::ranges::copy(coupled.joints, coupling.joints.begin());
  auto sent = fleet_.send(engine::Couple{fleet_.lend(std::make_shared<const engine::Coupling>(coupling))});
  if (!sent) return std::unexpected(std::move(sent.error()));
  return {};
}

Result<void> CouplingService::send_free(std::string_view slave) {
  auto sent = fleet_.send(engine::Uncouple{static_cast<std::uint8_t>(cell_.robot(slave)->slot())});
  if (!sent) return std::unexpected(std::move(sent.error()));
  return {};
}

// The tick has forgotten the couplings when the robot was removed.
void CouplingService::follow() {
  for (auto entry = by_slave_.begin(); entry != by_slave_.end();) {
    const bool there = cell_.robot(entry->first) != nullptr && cell_.robot(entry->second.master) != nullptr;
    if (there) {
      ++entry;
      continue;
    }
    motion_.cancel(entry->first,
                   {fmt::format("{} was deleted, whom {} followed", entry->second.master, entry->first), {}});
    entry = by_slave_.erase(entry);
  }
}

Result<void> CouplingService::update_velocities(const RobotModel& robot) {
  follow();  // a command before this one may have deleted the master
  const auto found = by_slave_.find(robot.id());
  return found == by_slave_.end() ? Result<void>() : send(robot.id(), found->second);
}

std::uint16_t CouplingService::coupled_joints(std::string_view robot) const {
  const auto found = by_slave_.find(robot);
  return found == by_slave_.end() ? std::uint16_t{0} : mask_of(found->second.joints);
}

std::string_view CouplingService::master_of(std::string_view robot) const {
  const auto found = by_slave_.find(robot);
  return found == by_slave_.end() ? std::string_view() : std::string_view(found->second.master);
}

std::vector<CouplingSnapshot> CouplingService::snapshots() const {
  std::vector<CouplingSnapshot> all;
  for (const auto& [name, coupled] : by_slave_) {
    const RobotModel* master = cell_.robot(coupled.master);
    const RobotModel* slave = cell_.robot(name);
    if (master == nullptr || slave == nullptr) continue;
    CouplingSnapshot snapshot{coupled.master, name, master->slot(), slave->slot(), {}};
    for (const engine::CoupledJoint& joint : coupled.joints) {
      if (joint.master_joint >= master->joint_count() || joint.slave_joint >= slave->joint_count()) continue;
      const RobotJoint& of_slave = slave->joints()[joint.slave_joint];
      snapshot.joints.push_back({master->joints()[joint.master_joint].name, of_slave.name, joint, of_slave.kind});
    }
    all.push_back(std::move(snapshot));
  }
  return all;
}

}  // namespace cellmirror::app
