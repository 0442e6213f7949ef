// Haptic devices, foot switches, forces and coupled robots behind SCRIPT's interface: hands each command to the service
// that it concerns. Belongs to the thread that owns the cell.
#pragma once

#include <string>

#include "app/owner/foot_switch_service.hpp"
#include "app/owner/haptics/haptic_service.hpp"
#include "app/owner/motion/coupling_service.hpp"
#include "app/owner/tcp_force_service.hpp"
#include "rt_core/cell/cell.hpp"
#include "scripts/commands/interaction_host.hpp"
#include "scripts/lang/names.hpp"

namespace cellmirror::app {

class CellInteraction final : public InteractionHost {
 public:
  CellInteraction(const Cell& cell, const NameDirectory& names, HapticService& haptics, TcpForceService& forces)
      : cell_(cell), names_(names), haptics_(haptics), forces_(forces) {}
  // Before the first command. The services outlive this.
  void set_services(FootSwitchService& switches, CouplingService& couplings) {
    switches_ = &switches;
    couplings_ = &couplings;
  }

  // Memories that other processes attach to are not made, and nobody is listened to: what asks for them is taken and
  // has no effect.
  void set_off_line() { off_line_ = true; }

  Result<void> set_force_memory(std::uint64_t send_type, std::int32_t key, std::size_t bytes) override;
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
  const Cell& cell_;
  const NameDirectory& names_;
  HapticService& haptics_;
  TcpForceService& forces_;
  FootSwitchService* switches_ = nullptr;
  CouplingService* couplings_ = nullptr;
  bool off_line_ = false;
};

}  // namespace cellmirror::app
