// POS_ROB and its kin, kept from robots that a robot program or a ROS 2 controller moves. Belongs to the thread that
// owns the cell.
#pragma once

#include <string_view>

#include "app/owner/controllers/controller_service.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/owner/programs/program_service.hpp"
#include "scripts/commands/motion_host.hpp"

namespace cellmirror::app {

class GuardedMotion final : public MotionHost {
 public:
  GuardedMotion(MotionService& motion, ProgramService& programs, ControllerService& controllers)
      : motion_(motion), programs_(programs), controllers_(controllers) {}

  // Refused while a program or a controller moves the robot.
  Result<ActivityHandle> position(std::string_view robot, const MotionTarget& target) override;
  Result<void> queue_move(std::string_view robot, MovePath path, const MotionTarget& target) override;
  // Never refused for that: STOP_ROB stops the program with its robot, and those that wait until they are loaded.
  Result<void> stop(std::string_view robot) override;
  Result<void> set_positioning(Positioning positioning) override { return motion_.set_positioning(positioning); }
  [[nodiscard]] bool moving() const override { return motion_.moving(); }

 private:
  [[nodiscard]] Result<void> check_free(std::string_view robot) const;

  MotionService& motion_;
  ProgramService& programs_;
  ControllerService& controllers_;
};

}  // namespace cellmirror::app
