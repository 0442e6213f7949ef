#include "app/owner/motion/guarded_motion.hpp"

#include <fmt/format.h>

namespace cellmirror::app {

Result<void> GuardedMotion::check_free(std::string_view robot) const {
  if (const std::string_view controller = controllers_.moving_controller(robot); !controller.empty())
    return fail(fmt::format("{} is on a trajectory of the controller {}", robot, controller),
                fmt::format("wait until it has ended, or end it with STOP_ROB {}", robot));
  const std::string program = programs_.moving_program(robot);
  if (program.empty()) return {};
  return fail(fmt::format("the robot program {} moves {}", program, robot),
              fmt::format("wait until it has ended (TF_WAIT {}), or end it with TF_STOP {}", robot, robot));
}

Result<ActivityHandle> GuardedMotion::position(std::string_view robot, const MotionTarget& target) {
  if (auto is_free = check_free(robot); !is_free) return std::unexpected(std::move(is_free.error()));
  return motion_.position(robot, target);
}

Result<void> GuardedMotion::queue_move(std::string_view robot, MovePath path, const MotionTarget& target) {
  if (auto is_free = check_free(robot); !is_free) return is_free;
  return motion_.queue_move(robot, path, target);
}

Result<void> GuardedMotion::stop(std::string_view robot) {
  programs_.give_up_waiting(robot, {"stopped by STOP_ROB", {}});
  if (auto stopped = controllers_.stop(robot); !stopped) return stopped;
  if (programs_.moving_program(robot).empty()) return motion_.stop(robot);
  return programs_.stop_programs(robot);
}

}  // namespace cellmirror::app
