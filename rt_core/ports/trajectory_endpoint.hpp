// The way between a ROS 2 controller's peers and the owner of the cell, whatever carries it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/joint_trajectory.hpp"

namespace cellmirror {

// Takes what peers send. Threads of the driver call it.
class TrajectorySink {
 public:
  virtual ~TrajectorySink() = default;
  // Of the topic. No points: stop.
  virtual void command(JointTrajectory&& trajectory) = 0;
  // What could not be read.
  virtual void refused(TrajectoryRefusal refusal, const std::string& why) = 0;
  // Of the action: TrajectoryEndpoint::answer() is due.
  virtual void goal(TrajectoryGoal&& goal, JointTrajectory&& trajectory) = 0;
  // A goal that was taken shall stop: TrajectoryEndpoint::finish() follows when it has.
  virtual void cancel(const GoalId& goal) = 0;
};

struct TrajectoryEndpointStatus {
  std::string endpoint;            // "domain 0 topic rt/arm_controller/joint_trajectory on 127.0.0.1"
  int publishers = 0;              // matched now
  std::uint64_t messages = 0;      // on the topic, of any content
  int state_readers = 0;           // matched now
  std::uint64_t states = 0;        // sent
  int clients = 0;                 // of the action, matched now
  std::uint64_t feedback = 0;      // sent
  std::uint64_t bad_requests = 0;  // of the action, that could not be read
  std::uint64_t unanswered = 0;    // replies dropped, since the client has no reader of them
};

// What a controller wants and what its robot does, by joint in the order of the configuration.
struct ControllerState {
  Timestamp time;  // of the tick
  std::vector<AxisState> reference = {};
  std::vector<AxisState> feedback = {};
  double elapsed = 0;      // s from the start of the trajectory
  std::int32_t point = 0;  // of it, where the joints go to, from 0
};

enum class GoalEnd : std::uint8_t { succeeded, canceled, aborted };
struct GoalResult {
  GoalEnd end = GoalEnd::aborted;
  std::int32_t error_code = 0;  // control_msgs/action/FollowJointTrajectory
  std::string text = {};
};

class TrajectoryEndpoint {
 public:
  virtual ~TrajectoryEndpoint() = default;
  // `sink` is there until close().
  virtual Result<void> open(TrajectorySink& sink) = 0;
  // Nothing is pushed any more when it returns.
  virtual void close() = 0;
  [[nodiscard]] virtual TrajectoryEndpointStatus status() const = 0;  // any thread

  // One thread. The feedback of the goal that runs goes with it.
  virtual void publish(const ControllerState& state) = 0;

  // One thread.
  virtual void answer(const GoalId& goal, bool taken) = 0;
  virtual void finish(const GoalId& goal, const GoalResult& result) = 0;
};

}  // namespace cellmirror
