#include "app/owner/interaction.hpp"

#include <utility>

namespace cellmirror::app {

Result<void> CellInteraction::set_force_memory(std::uint64_t /*send_type*/, std::int32_t key, std::size_t bytes) {
  if (names_.active_robot().empty()) return fail("no robot is active", "activate one with ROBACT <robot>");
  if (off_line_) return {};
  return services_.haptics.set_force_memory(names_.active_robot(), key, bytes);
}
Result<void> CellInteraction::reset_haptic(std::string_view robot) { return services_.haptics.reset(robot); }

Result<void> CellInteraction::set_switch_memory(std::uint64_t /*send_type*/, std::int32_t key, std::size_t bytes) {
  return off_line_ ? Result<void>() : services_.switches().set_memory(key, bytes);
}
Result<void> CellInteraction::set_switches_online(bool online) {
  return off_line_ ? Result<void>() : services_.switches().set_online(online);
}

Result<std::string> CellInteraction::set_force_arrows(const ForceArrowSettings& settings) {
  if (auto set = services_.forces.set_arrows(settings); !set) return std::unexpected(std::move(set.error()));
  return arrows_without_effect(settings, *cell_.compile(), services_.haptics.used());
}
Result<void> CellInteraction::set_motor_forces_only(bool on) { return services_.forces.set_motors_only(on); }
Result<void> CellInteraction::set_force_limits(const ForceLimits& limits) {
  return services_.forces.set_limits(limits);
}
Result<void> CellInteraction::set_tcp_test(bool on, const std::array<double, 4>& values) {
  return off_line_ ? Result<void>() : services_.forces.set_test(on, values);
}

Result<void> CellInteraction::couple(std::string_view master, std::span<const SlaveJoints> slaves) {
  return services_.couplings.couple(master, slaves);
}
Result<void> CellInteraction::uncouple(std::string_view master, std::span<const SlaveJoints> slaves) {
  return services_.couplings.uncouple(master, slaves);
}

}  // namespace cellmirror::app
