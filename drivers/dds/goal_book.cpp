#include "drivers/dds/goal_book.hpp"

#include <algorithm>

namespace cellmirror::dds {

namespace {

GoalStatus status_of(GoalEnd end) {
  if (end == GoalEnd::succeeded) return GoalStatus::succeeded;
  return end == GoalEnd::canceled ? GoalStatus::canceled : GoalStatus::aborted;
}

bool is_before(RosTime a, RosTime b) { return a.sec != b.sec ? a.sec < b.sec : a.nanosec <= b.nanosec; }

}  // namespace

GoalBook::Goal* GoalBook::find(const GoalId& id) {
  const auto found = std::ranges::find_if(goals_, [&](const Goal& goal) { return goal.info.id == id; });
  return found == goals_.end() ? nullptr : &*found;
}

bool GoalBook::ask(const GoalId& id, const RequestName& from, RosTime now) {
  if (find(id) != nullptr) return false;
  if (goals_.size() >= kMostGoals) {
    const auto oldest = std::ranges::find_if(goals_, ended);
    if (oldest == goals_.end()) return false;
    goals_.erase(oldest);
  }
  goals_.push_back({.info = {.id = id, .stamp = now, .status = GoalStatus::unknown}, .asked_by = from});
  return true;
}

std::optional<RequestName> GoalBook::answer(const GoalId& id, bool taken) {
  Goal* const goal = find(id);
  if (goal == nullptr || goal->info.status != GoalStatus::unknown) return std::nullopt;
  const RequestName from = goal->asked_by;
  if (taken) {
    goal->info.status = GoalStatus::executing;
  } else {
    std::erase_if(goals_, [&](const Goal& one) { return one.info.id == id; });
  }
  return from;
}

GoalBook::Cancel GoalBook::cancel(const CancelRequest& request) {
  const bool any_id = request.id == GoalId{};
  const bool any_time = request.stamp == RosTime{};
  Cancel out;
  for (Goal& goal : goals_) {
    const bool named = !any_id && goal.info.id == request.id;
    const bool in_time = any_time ? any_id : is_before(goal.info.stamp, request.stamp);
    if (!active(goal) || (!named && !in_time)) continue;
    goal.info.status = GoalStatus::canceling;
    out.goals.push_back(goal.info);
  }
  if (any_id || !out.goals.empty()) return out;
  const Goal* const known = find(request.id);
  out.code = known == nullptr ? CancelCode::unknown_goal : CancelCode::terminated;
  return out;
}

std::optional<GoalBook::Reply> GoalBook::result_of(const GoalId& id, const RequestName& from) {
  Goal* const goal = find(id);
  if (goal == nullptr || goal->info.status == GoalStatus::unknown) return Reply{};
  if (ended(*goal)) return Reply{goal->info.status, goal->result};
  if (goal->waiting.size() >= kMostWaiting) return Reply{};
  goal->waiting.push_back(from);
  return std::nullopt;
}

std::optional<GoalBook::Finished> GoalBook::finish(const GoalId& id, const GoalResult& result) {
  Goal* const goal = find(id);
  if (goal == nullptr || !active(*goal)) return std::nullopt;
  goal->info.status = status_of(result.end);
  goal->result = result;
  Finished out{{goal->info.status, result}, {}};
  out.waiting.swap(goal->waiting);
  return out;
}

std::vector<GoalInfo> GoalBook::status() const {
  std::vector<GoalInfo> out;
  for (const Goal& goal : goals_) {
    if (goal.info.status != GoalStatus::unknown) out.push_back(goal.info);
  }
  return out;
}

std::optional<GoalId> GoalBook::running() const {
  for (auto goal = goals_.rbegin(); goal != goals_.rend(); ++goal) {
    if (active(*goal)) return goal->info.id;
  }
  return std::nullopt;
}

}  // namespace cellmirror::dds
