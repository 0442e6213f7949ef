// Haptic devices, foot switches, forces and coupled robots behind SCRIPT's interface: hands each command to the service
// that it concerns. Belongs to the thread that owns the cell.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "app/owner/foot_switch_service.hpp"
#include "app/owner/haptics/haptic_service.hpp"
#include "app/owner/motion/coupling_service.hpp"
#include "app/owner/robot_force_service.hpp"
#include "app/owner/tcp_force_service.hpp"
#include "rt_core/cell/cell.hpp"
#include "scripts/commands/interaction_host.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::app {

class CellInteraction final : public InteractionHost {
 public:
  // What is referred to outlives this.
  struct Services {
    HapticService& haptics;
    TcpForceService& forces;
    RobotForceService& robot_forces;
    CouplingService& couplings;
    std::function<FootSwitchService&()> switches;  // asked at each command: they start scripts, which begin here
  };
  // `off_line`: memories that other processes attach to are not made, and no device is read: commands that ask for them
  // are accepted and have no effect.
  CellInteraction(const Cell& cell, const NameDirectory& names, Services services, bool off_line)
      : cell_(cell), names_(names), services_(std::move(services)), off_line_(off_line) {}

  Result<std::string> set_force_memory(std::uint64_t send_type, std::int32_t key, std::size_t bytes) override;
  Result<void> reset_haptic(std::string_view robot) override;
  Result<void> set_switch_memory(std::uint64_t send_type, std::int32_t key, std::size_t bytes) override;
  Result<void> set_switches_online(bool online) override;
  Result<std::string> set_force_arrows(const ForceArrowSettings& settings) override;
  Result<void> set_motor_forces_only(bool on) override;
  Result<void> set_force_limits(const ForceLimits& limits) override;
  Result<void> set_tcp_test(bool on, const std::array<double, 4>& values) override;
  Result<void> couple(std::string_view master, std::span<const SlaveJoints> slaves) override;
  Result<void> uncouple(std::string_view master, std::span<const SlaveJoints> slaves) override;

 private:
  Result<std::string> set_plain_memory(const std::string& robot, std::int32_t key, std::size_t bytes);
  Result<std::string> set_device_memory(const std::string& robot, std::int32_t key, std::size_t bytes);

  const Cell& cell_;
  const NameDirectory& names_;
  Services services_;
  bool off_line_;
};

}  // namespace cellmirror::app
