#include "app/gateway/interaction.hpp"

#include <fmt/format.h>

namespace cellmirror::app {

namespace {

Result<void> not_there(std::string_view what) { return fail(fmt::format("{} are not available yet", what)); }

}  // namespace

Result<void> CellInteraction::set_force_memory(std::uint64_t /*send_type*/, std::int32_t /*key*/,
                                               std::size_t /*bytes*/) {
  return not_there("haptic devices");
}
Result<void> CellInteraction::reset_haptic(std::string_view /*robot*/) { return not_there("haptic devices"); }

Result<void> CellInteraction::set_switch_memory(std::uint64_t /*send_type*/, std::int32_t /*key*/,
                                                std::size_t /*bytes*/) {
  return not_there("foot switches");
}
Result<void> CellInteraction::set_switches_online(bool /*online*/) { return not_there("foot switches"); }

Result<void> CellInteraction::set_force_arrows(const ForceArrowSettings& /*settings*/) { return not_there("forces"); }
Result<void> CellInteraction::set_motor_forces_only(bool /*on*/) { return not_there("forces"); }
Result<void> CellInteraction::set_force_limits(const ForceLimits& /*limits*/) { return not_there("forces"); }
Result<void> CellInteraction::set_tcp_test(bool /*on*/, const std::array<double, 4>& /*values*/) {
  return not_there("forces");
}

Result<void> CellInteraction::couple(std::string_view /*master*/, std::span<const SlaveJoints> /*slaves*/) {
  return not_there("couplings");
}
Result<void> CellInteraction::uncouple(std::string_view /*master*/, std::span<const SlaveJoints> /*slaves*/) {
  return not_there("couplings");
}

}  // namespace cellmirror::app
