// The goals of an action and who waits for what of them: the server's side of ROS 2's actions (design.ros2.org,
// "Actions"), without a clock and without DDS. One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "drivers/dds/controller_messages.hpp"
#include "drivers/dds/service_mapping.hpp"

namespace cellmirror::dds {

class GoalBook {
 public:
  static constexpr std::size_t kMostGoals = 32;    // the oldest that has ended is forgotten for a new one
  static constexpr std::size_t kMostWaiting = 16;  // for the result of one goal

  // False where the id is known, or too many goals have not ended: refused at once.
  bool ask(const GoalId& id, const RequestName& from, RosTime now);
  // Ends ask(). Who asked; none: there is no such question.
  std::optional<RequestName> answer(const GoalId& id, bool taken);

  struct Cancel {
    CancelCode code = CancelCode::none;
    std::vector<GoalInfo> goals;  // that shall stop
  };
  Cancel cancel(const CancelRequest& request);

  struct Reply {
    GoalStatus status = GoalStatus::unknown;
    GoalResult result;
  };
  // What to answer at once; none: when the goal has ended.
  std::optional<Reply> result_of(const GoalId& id, const RequestName& from);
  struct Finished {
    Reply reply;
    std::vector<RequestName> waiting;
  };
  std::optional<Finished> finish(const GoalId& id, const GoalResult& result);

  // That were taken, the oldest first.
  [[nodiscard]] std::vector<GoalInfo> status() const;
  // The newest that has not ended; none: there is none.
  [[nodiscard]] std::optional<GoalId> running() const;

 private:
  struct Goal {
    GoalInfo info;  // unknown: it was not answered yet
    RequestName asked_by;
    std::vector<RequestName> waiting = {};
    GoalResult result = {};
  };
  [[nodiscard]] Goal* find(const GoalId& id);
  [[nodiscard]] static bool ended(const Goal& goal) { return goal.info.status >= GoalStatus::succeeded; }
  [[nodiscard]] static bool active(const Goal& goal) {
    return goal.info.status == GoalStatus::executing || goal.info.status == GoalStatus::canceling;
  }

  std::deque<Goal> goals_;  // the oldest first
};

}  // namespace cellmirror::dds
