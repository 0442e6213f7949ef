// The moves of one robot that were given to the tick and have not ended, and who waits for them. Belongs to the thread
// that owns the cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/motion/executor.hpp"
#include "scripts/commands/activity.hpp"

namespace cellmirror::app {

class PendingMoves {
 public:
  explicit PendingMoves(std::string robot) : robot_(std::move(robot)) {}

  // Ids ascend as long as the robot's name is known, also when it is deleted and loaded again.
  [[nodiscard]] std::uint32_t next_id() const { return sent_ + 1; }
  // The move next_id() was given to the tick, in place of those before, whose waiters are refused.
  void superseded_all_by_next();
  // The same, behind those before.
  void queued_next() { ++sent_; }
  // Of the move that was given last: ends when the robot has arrived, or why it did not.
  [[nodiscard]] ActivityHandle watch();

  [[nodiscard]] bool in_flight() const { return ended_ < sent_; }
  // Moves that were given and have not ended, as far as follow() has seen.
  [[nodiscard]] std::size_t count() const { return sent_ - ended_; }
  // The newest move that has ended or was given up.
  [[nodiscard]] std::uint32_t ended() const { return ended_; }

  // Ends what the tick says has ended. True where the newest move of all has just ended otherwise than by arriving: the
  // robot stands elsewhere than it was commanded to.
  bool follow(const motion::MotionState& state);
  // All moves end here and now.
  void cancel(const Error& why);

 private:
  struct Watched {
    std::uint32_t id;
    std::shared_ptr<Activity> activity;
  };
  void end(const Watched& watched, motion::Outcome outcome) const;

  std::string robot_;
  std::uint32_t sent_ = 0;
  std::uint32_t ended_ = 0;
  std::vector<Watched> watched_;  // by id, ascending
};

}  // namespace cellmirror::app
