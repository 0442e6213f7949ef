// Master and slave (MASTER_SLAVE, manual 1.2.4): what SCRIPT asks for, on its way to the tick. Belongs to the thread
// that owns the cell.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/owner/fleet.hpp"
#include "app/owner/motion/coupled_robots.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/snapshot/coupling_snapshot.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/planning/robot_couplings.hpp"
#include "rt_core/ports/coupled_joint.hpp"

namespace cellmirror::app {

class CouplingService final : public CoupledRobots {
 public:
  CouplingService(const Cell& cell, Fleet& fleet, MotionService& motion)
      : cell_(cell), fleet_(fleet), motion_(motion) {}

  // All slaves or none, by the rules of planning::RobotCouplings.
  Result<void> couple(std::string_view master, std::span<const SlaveJoints> slaves);
  // Frees these joints; slaves without others are free. Refused, as a whole, where one of them is not coupled so.
  Result<void> uncouple(std::string_view master, std::span<const SlaveJoints> slaves);
  // Forgets couplings of robots that the cell does not have any more. Often.
  void follow();
  // After a change of the robot's velocities or accelerations.
  Result<void> update_limits(const RobotModel& robot);

  [[nodiscard]] std::uint16_t coupled_joints(std::string_view robot) const override;
  [[nodiscard]] std::string_view master_of(std::string_view robot) const override;
  [[nodiscard]] std::vector<CouplingSnapshot> snapshots() const;

 private:
  // `when`: for the senders of moves that end with it.
  Result<void> carry_out(const planning::RobotCouplings::Changes& changes, std::string_view when);
  Result<void> send(std::string_view slave, const planning::RobotCoupling& coupled);
  Result<void> send_free(std::string_view slave);

  const Cell& cell_;
  Fleet& fleet_;
  MotionService& motion_;
  planning::RobotCouplings couplings_;
};

}  // namespace cellmirror::app
