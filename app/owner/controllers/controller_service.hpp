// The ROS 2 controllers of the cell file: takes their trajectories, has them planned and gives them to the tick.
// Belongs to the thread that owns the cell. docs/hardware-in-the-loop.md has the rules for users.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/owner/controllers/trajectory_inbox.hpp"
#include "app/owner/fleet.hpp"
#include "app/owner/motion/coupled_robots.hpp"
#include "app/owner/motion/motion_service.hpp"
#include "app/snapshot/controller_snapshot.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/planning/trajectory_plan.hpp"
#include "rt_core/ports/controller_config.hpp"

namespace cellmirror::app {

class ControllerService {
 public:
  struct Parts {
    const Cell& cell;
    Fleet& fleet;
    MotionService& motion;
    const CoupledRobots& coupled;
    std::function<std::string(std::string_view robot)> moving_program;  // empty text: none moves it
    const Clock& clock;
    std::vector<ControllerConfig> controllers;  // each of another robot
    std::function<void()> wake;                 // of the owner's thread; from any thread
    std::function<Result<std::unique_ptr<TrajectoryEndpoint>>(const ControllerConfig& config)> make_endpoint;
  };
  explicit ControllerService(Parts parts);
  // Closes the endpoints.
  ~ControllerService();
  ControllerService(const ControllerService&) = delete;
  ControllerService& operator=(const ControllerService&) = delete;

  // Opens the endpoints.
  Result<void> prepare();
  // Takes what has come and looks at what the tick has done. Often. True where something has changed.
  bool follow();
  // A robot is on a trajectory, as far as follow() has seen.
  [[nodiscard]] bool moving() const;
  // The controller whose trajectory moves the robot; empty: none.
  [[nodiscard]] std::string_view moving_controller(std::string_view robot) const;
  // Brakes the robot's trajectory, if any.
  Result<void> stop(std::string_view robot);
  [[nodiscard]] std::vector<ControllerSnapshot> snapshots() const;

 private:
  struct Controller {
    ControllerConfig config;
    planning::TrajectoryController plan;
    std::shared_ptr<TrajectoryEndpoint> endpoint;
    std::unique_ptr<TrajectoryInbox> inbox;
    ControllerCounts counts = {};
    GoalCounts goals = {};
    std::optional<GoalId> goal = {};   // that runs
    bool canceled = false;             // it
    std::uint32_t newest = 0;          // id that was given to the tick
    std::uint32_t ended = 0;           // the newest id that has ended
    std::uint64_t newest_command = 0;  // of the tick, with it
    double duration_s = 0;
    std::size_t points = 0;
    std::string last_refusal = {};
    Timestamp refused_at = {};
  };

  bool follow(Controller& controller);
  void take(Controller& controller, const TrajectoryMessage& message);
  void take_goal(Controller& controller, const TrajectoryMessage& message);
  // Plans it and gives it to the tick; the trajectory before has ended then.
  [[nodiscard]] std::optional<planning::TrajectoryFault> start(Controller& controller, const JointTrajectory& message,
                                                               const TrajectoryGoal* goal);
  void end_goal(Controller& controller, const GoalResult& result);
  void end_goal(Controller& controller, const motion::TrajectoryState& state);
  void refuse(Controller& controller, TrajectoryRefusal refusal, const std::string& why);
  // Why the robot cannot be moved now.
  [[nodiscard]] std::optional<planning::TrajectoryFault> check_free(const Controller& controller) const;
  bool watch(Controller& controller);

  Parts parts_;
  std::vector<Controller> controllers_;
};

}  // namespace cellmirror::app
