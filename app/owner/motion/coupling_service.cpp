#include "app/owner/motion/coupling_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "rt_core/motion/planner.hpp"

namespace cellmirror::app {

namespace {

std::uint16_t mask_of(std::span<const CoupledJoint> joints) {
  unsigned mask = 0;
  for (const CoupledJoint& joint : joints) mask |= 1U << joint.slave_joint;
  return static_cast<std::uint16_t>(mask);
}

}  // namespace

Result<void> CouplingService::couple(std::string_view master, std::span<const SlaveJoints> slaves) {
  follow();
  const auto changes = couplings_.coupled(cell_, master, slaves,
                                          [this](std::string_view robot) { return !fleet_.check_simulated(robot); });
  if (!changes) return std::unexpected(changes.error());
  return carry_out(*changes, "now");
}

Result<void> CouplingService::uncouple(std::string_view master, std::span<const SlaveJoints> slaves) {
  follow();
  const auto changes = couplings_.freed(cell_, master, slaves);
  if (!changes) return std::unexpected(changes.error());
  return carry_out(*changes, "no longer");
}

Result<void> CouplingService::carry_out(const planning::RobotCouplings::Changes& changes, std::string_view when) {
  for (const auto& [slave, coupling] : changes) {
    if (auto sent = coupling.joints.empty() ? send_free(slave) : send(slave, coupling); !sent) return sent;
    couplings_.apply(slave, coupling);
    motion_.cancel(slave, {fmt::format("{} follows {} {}", slave, coupling.master, when), {}});
  }
  return {};
}

Result<void> CouplingService::send(std::string_view slave, const planning::RobotCoupling& coupled) {
  const RobotModel& robot = *cell_.robot(slave);
  engine::Coupling coupling{.master = static_cast<std::uint8_t>(cell_.robot(coupled.master)->slot()),
                            .slave = static_cast<std::uint8_t>(robot.slot()),
                            .count = static_cast<std::uint8_t>(coupled.joints.size()),
                            .joints = {},
                            .max_velocity = robot.parameters().max_velocity};
  for (std::size_t i = 0; i < robot.joint_count(); ++i) {
    const double acceleration = robot.parameters().max_acceleration[i];
    // A move makes the same assumption for a component file without accelerations.
    coupling.max_acceleration[i] =
        acceleration > 0 ? acceleration : coupling.max_velocity[i] / motion::kDefaultRampSeconds;
  }
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
  std::vector<std::string> gone;
  for (const auto& [slave, coupling] : couplings_.all()) {
    if (cell_.robot(slave) != nullptr && cell_.robot(coupling.master) != nullptr) continue;
    motion_.cancel(slave, {fmt::format("{} was deleted, whom {} followed", coupling.master, slave), {}});
    gone.push_back(slave);
  }
  for (const std::string& slave : gone) couplings_.forget(slave);
}

Result<void> CouplingService::update_limits(const RobotModel& robot) {
  follow();  // a command before this one may have deleted the master
  const planning::RobotCoupling* found = couplings_.find(robot.id());
  return found == nullptr ? Result<void>() : send(robot.id(), *found);
}

std::uint16_t CouplingService::coupled_joints(std::string_view robot) const {
  const planning::RobotCoupling* found = couplings_.find(robot);
  return found == nullptr ? std::uint16_t{0} : mask_of(found->joints);
}

std::string_view CouplingService::master_of(std::string_view robot) const {
  const planning::RobotCoupling* found = couplings_.find(robot);
  return found == nullptr ? std::string_view() : std::string_view(found->master);
}

std::vector<CouplingSnapshot> CouplingService::snapshots() const {
  std::vector<CouplingSnapshot> all;
  for (const auto& [name, coupled] : couplings_.all()) {
    const RobotModel* master = cell_.robot(coupled.master);
    const RobotModel* slave = cell_.robot(name);
    if (master == nullptr || slave == nullptr) continue;
    CouplingSnapshot snapshot{coupled.master, name, master->slot(), slave->slot(), {}};
    for (const CoupledJoint& joint : coupled.joints) {
      if (joint.master_joint >= master->joint_count() || joint.slave_joint >= slave->joint_count()) continue;
      const RobotJoint& of_slave = slave->joints()[joint.slave_joint];
      snapshot.joints.push_back({master->joints()[joint.master_joint].name, of_slave.name, joint, of_slave.kind});
    }
    all.push_back(std::move(snapshot));
  }
  return all;
}

}  // namespace cellmirror::app
