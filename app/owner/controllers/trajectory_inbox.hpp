// What the peers of a ROS 2 controller have sent and its owner has not taken yet.
#pragma once

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/ports/trajectory_endpoint.hpp"

namespace cellmirror::app {

struct TrajectoryMessage {
  JointTrajectory trajectory = {};
  std::optional<TrajectoryGoal> goal = {};  // of the action
  std::optional<GoalId> cancel = {};
  std::optional<TrajectoryRefusal> refused = {};  // it could not be read
  std::string why = {};
};

// Any thread.
class TrajectoryInbox final : public TrajectorySink {
 public:
  static constexpr std::size_t kMostWaiting = 8;

  // `arrived`: called with each message.
  explicit TrajectoryInbox(std::function<void()> arrived) : arrived_(std::move(arrived)) {}

  void command(JointTrajectory&& trajectory) override { push({.trajectory = std::move(trajectory)}); }
  void refused(TrajectoryRefusal refusal, const std::string& why) override { push({.refused = refusal, .why = why}); }
  void goal(TrajectoryGoal&& goal, JointTrajectory&& trajectory) override {
    push({.trajectory = std::move(trajectory), .goal = std::move(goal)});
  }
  void cancel(const GoalId& goal) override { push({.cancel = goal}); }

  [[nodiscard]] std::optional<TrajectoryMessage> take() {
    const std::scoped_lock lock(mutex_);
    if (waiting_.empty()) return std::nullopt;
    TrajectoryMessage first = std::move(waiting_.front());
    waiting_.pop_front();
    return first;
  }
  // Messages that found no room since the last call, and the goals among them, which are to be answered.
  struct Dropped {
    std::size_t count = 0;
    std::vector<GoalId> goals = {};
  };
  [[nodiscard]] Dropped take_dropped() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(dropped_, {});
  }

 private:
  void push(TrajectoryMessage message) {
    {
      const std::scoped_lock lock(mutex_);
      // A goal is cancelled once: that finds room behind a flood of trajectories.
      if (waiting_.size() < (message.cancel ? 2 * kMostWaiting : kMostWaiting)) {
        waiting_.push_back(std::move(message));
      } else {
        ++dropped_.count;
        if (message.goal) dropped_.goals.push_back(message.goal->id);
      }
    }
    arrived_();
  }

  const std::function<void()> arrived_;
  std::mutex mutex_;
  std::deque<TrajectoryMessage> waiting_;
  Dropped dropped_;
};

}  // namespace cellmirror::app
