// Manual 1.2.4.
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "scripts/commands/registry.hpp"

namespace cellmirror::script {

namespace {

constexpr std::size_t kOn = 0;  // of [on | off]

Outcome set_force_arrows(const ParsedCommand& command, CommandHost& host) {
  ForceArrowSettings settings;
  settings.joint_forces = static_cast<ArrowComponent>(command.choice(slots::force_arrow::kJointForces));
  settings.joint_torques = static_cast<ArrowComponent>(command.choice(slots::force_arrow::kJointTorques));
  settings.tcp_force = static_cast<ArrowComponent>(command.choice(slots::force_arrow::kTcpForce));
  return Outcome::with_remark(host.interaction.set_force_arrows(settings));
}

Outcome set_force_limits(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.interaction.set_force_limits(
      {command.number(slots::torque_limit::kForce), command.number(slots::torque_limit::kTorque)}));
}

Outcome set_tcp_test(const ParsedCommand& command, CommandHost& host) {
  std::array<double, 4> values{};
  command.numbers(slots::tcp_test::kFirstValue, values);
  return Outcome::of(host.interaction.set_tcp_test(command.choice(slots::tcp_test::kOn) == kOn, values));
}

Outcome set_motor_forces_only(const ParsedCommand& command, CommandHost& host) {
  return Outcome::of(host.interaction.set_motor_forces_only(command.choice(kOnlySlot) == kOn));
}

// The slaves of MASTER_SLAVE, as the matcher has laid them out: name, count, and as many pairs of joints.
class SlaveList {
 public:
  explicit SlaveList(const ParsedCommand& command) {
    const auto slaves = static_cast<std::size_t>(command.integer(slots::master_slave::kSlaves));
    std::size_t slot = slots::master_slave::kFirstSlave;
    std::size_t first_pair = 0;
    while (count_ < slaves) {
      const std::string_view robot = command.text(slot);
      const auto joints = static_cast<std::size_t>(command.integer(slot + 1));
      slot += 2;
      for (std::size_t i = 0; i < joints; ++i, slot += 2)
        pairs_[first_pair + i] = {command.text(slot), command.text(slot + 1)};
      slaves_[count_++] = {robot, std::span(pairs_).subspan(first_pair, joints)};
      first_pair += joints;
    }
  }
  SlaveList(const SlaveList&) = delete;
  SlaveList& operator=(const SlaveList&) = delete;

  [[nodiscard]] std::span<const SlaveJoints> slaves() const { return std::span(slaves_).first(count_); }

 private:
  std::array<std::pair<std::string_view, std::string_view>, kMaxSlaves * kMaxJointsPerRobot> pairs_;
  std::array<SlaveJoints, kMaxSlaves> slaves_;
  std::size_t count_ = 0;
};

Outcome master_slave(const ParsedCommand& command, CommandHost& host) {
  const SlaveList list(command);
  const std::string_view master = command.text(slots::master_slave::kMaster);
  return Outcome::of(command.choice(slots::master_slave::kOn) == kOn
                         ? host.interaction.couple(master, list.slaves())
                         : host.interaction.uncouple(master, list.slaves()));
}

constexpr Registration kHandlers[] = {
    {FormId::set_force_arrow, set_force_arrows}, {FormId::set_torque_limit, set_force_limits},
    {FormId::set_ext_tcp_test, set_tcp_test},    {FormId::set_frc_arr_special, set_motor_forces_only},
    {FormId::master_slave, master_slave},
};

}  // namespace

std::span<const Registration> dynamics_handlers() { return kHandlers; }

}  // namespace cellmirror::script
