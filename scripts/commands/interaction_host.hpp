// Interface of SCRIPT to haptic devices, foot switches, forces and coupled robots (manual 1.2.4, 1.2.6). As host.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/coupled_joint.hpp"
#include "rt_core/ports/force_state.hpp"

namespace cellmirror {

class InteractionHost {
 public:
  virtual ~InteractionHost() = default;
  // rob_ela_shm of the active robot; the send type has no effect. With the size of a haptic device's memory it reopens
  // the robot's haptic channel; a smaller buffer holds force and torques only. Done with a remark on values that do not
  // fit or stay zero.
  virtual Result<std::string> set_force_memory(std::uint64_t send_type, std::int32_t key, std::size_t bytes) = 0;
  virtual Result<void> reset_haptic(std::string_view robot) = 0;  // RESET_HAPTIC, ours
  virtual Result<void> set_switch_memory(std::uint64_t send_type, std::int32_t key, std::size_t bytes) = 0;
  virtual Result<void> set_switches_online(bool online) = 0;  // BIN_ELA
  // The first three settings count. Done with a remark if they have no visible effect.
  virtual Result<std::string> set_force_arrows(const ForceArrowSettings& settings) = 0;
  virtual Result<void> set_motor_forces_only(bool on) = 0;               // SET_FRC_ARR_SPECIAL
  virtual Result<void> set_force_limits(const ForceLimits& limits) = 0;  // SET_TORQUE_LIMIT
  // SET_EXT_TCP_TEST: force x, y, z [N] and torque about the tool axis [Nm].
  virtual Result<void> set_tcp_test(bool on, const std::array<double, 4>& values) = 0;
  // MASTER_SLAVE: all slaves or none.
  virtual Result<void> couple(std::string_view master, std::span<const SlaveJoints> slaves) = 0;
  virtual Result<void> uncouple(std::string_view master, std::span<const SlaveJoints> slaves) = 0;
};

}  // namespace cellmirror
