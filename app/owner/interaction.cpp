#include "app/owner/interaction.hpp"

#include <fmt/format.h>

#include <utility>

#include "ipc/wire/haptic_block.hpp"

namespace cellmirror::app {

Result<std::string> CellInteraction::set_force_memory(std::uint64_t /*send_type*/, std::int32_t key,
                                                      std::size_t bytes) {
  const std::string robot(names_.active_robot());
  if (robot.empty()) return fail("no robot is active", "activate one with ROBACT <robot>");
  if (off_line_) return std::string();
  const std::string other = services_.robot_forces.robot_with_key(key);
  if (!other.empty() && other != robot)
    return fail(fmt::format("the key {} is that of the forces of {}", key_text(key), other), "choose another key");
  return bytes < haptic_block_offset::kSize ? set_plain_memory(robot, key, bytes)
                                            : set_device_memory(robot, key, bytes);
}

// Beside the memory of a haptic device, which begins with the same values.
Result<std::string> CellInteraction::set_plain_memory(const std::string& robot, std::int32_t key, std::size_t bytes) {
  for (const HapticSnapshot& device : services_.haptics.snapshots()) {
    if (device.key != key) continue;
    const std::string whose = fmt::format("the key {} is that of the haptic device of {}", key_text(key), device.robot);
    if (device.robot != robot) return fail(whose, "choose another key");
    return fmt::format("{}: its {} bytes begin with these values and stay as they are", whose, device.bytes);
  }
  return services_.robot_forces.set_memory(robot, key, bytes);
}

Result<std::string> CellInteraction::set_device_memory(const std::string& robot, std::int32_t key, std::size_t bytes) {
  services_.robot_forces.release(robot, key);
  if (auto set = services_.haptics.set_force_memory(robot, key, bytes); !set) return std::unexpected(set.error());
  for (const HapticSnapshot& device : services_.haptics.snapshots()) {
    if (device.robot != robot || device.online) continue;
    return fmt::format(
        "the memory of a haptic device: its values are zero until ROBOT {} online and until the device "
        "writes; a buffer of less than {} bytes has the computed forces",
        robot, haptic_block_offset::kSize);
  }
  return std::string();
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
