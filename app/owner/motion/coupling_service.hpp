// Master and slave (MASTER_SLAVE, manual 1.2.4): checks what SCRIPT asks for and tells the tick. Belongs to the thread
// that owns the cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/owner/fleet.hpp"
#include "app/owner/motion/coupled_robots.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/snapshot/coupling_snapshot.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/engine/coupling.hpp"
#include "scripts/commands/interaction_host.hpp"

namespace cellmirror::app {

class CouplingService final : public CoupledRobots {
 public:
  static constexpr std::size_t kMaxSlaves = 5;  // of a master, manual 1.2.4

  CouplingService(const Cell& cell, Fleet& fleet, MotionService& motion)
      : cell_(cell), fleet_(fleet), motion_(motion) {}

  // All slaves or none. A slave of the same master gets these joints in place of those before. Refused: a slave that is
  // mirrored or follows another master, circles, unknown joints, one that is driven twice, joints of different kinds,
  // more slaves than the manual allows.
  Result<void> couple(std::string_view master, std::span<const SlaveJoints> slaves);
  // Frees these joints; slaves without others are free. Refused, as a whole, where one of them is not coupled so.
  Result<void> uncouple(std::string_view master, std::span<const SlaveJoints> slaves);
  // Forgets couplings of robots that the cell does not have any more. Often.
  void follow();
  // After a change of the robot's velocity limits.
  Result<void> update_velocities(const RobotModel& robot);

  [[nodiscard]] std::uint16_t coupled_joints(std::string_view robot) const override;
  [[nodiscard]] std::string_view master_of(std::string_view robot) const override;
  [[nodiscard]] std::vector<CouplingSnapshot> snapshots() const;

 private:
  struct Coupled {
    std::string master;
    std::vector<engine::CoupledJoint> joints;
  };
  using ByName = std::map<std::string, Coupled, std::less<>>;  // by the slave

  Result<Coupled> checked(const RobotModel& master, const SlaveJoints& slave, const ByName& others) const;
  Result<engine::CoupledJoint> joint_pair(const RobotModel& master, const RobotModel& slave,
                                          const std::pair<std::string_view, std::string_view>& names) const;
  Result<void> send(std::string_view slave, const Coupled& coupled);
  Result<void> send_free(std::string_view slave);

  const Cell& cell_;
  Fleet& fleet_;
  MotionService& motion_;
  ByName by_slave_;
};

}  // namespace cellmirror::app
