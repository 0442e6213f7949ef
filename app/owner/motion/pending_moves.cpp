#include "app/owner/motion/pending_moves.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cellmirror::app {

void PendingMoves::superseded_all_by_next() {
  for (const Watched& watched : watched_) end(watched, motion::Outcome::superseded);
  watched_.clear();
  ended_ = sent_;
  ++sent_;
}

ActivityHandle PendingMoves::watch() {
  watched_.push_back({sent_, std::make_shared<Activity>()});
  return watched_.back().activity;
}

bool PendingMoves::follow(const motion::MotionState& state) {
  // What the tick shows may be older than what was given up here.
  if (state.finished <= ended_) return false;
  ended_ = std::min(state.finished, sent_);
  const auto first_open = std::ranges::find_if(watched_, [&](const Watched& w) { return w.id > ended_; });
  for (auto watched = watched_.begin(); watched != first_open; ++watched) {
    // The tick does not keep the outcome of older moves; a later move began, so they were gone to their
    // end.
    end(*watched, watched->id >= state.finished_from ? state.outcome : motion::Outcome::arrived);
  }
  watched_.erase(watched_.begin(), first_open);
  return !in_flight() && state.outcome != motion::Outcome::arrived;
}

void PendingMoves::cancel(const Error& why) {
  for (const Watched& watched : watched_) watched.activity->refuse(why);
  watched_.clear();
  ended_ = sent_;
}

void PendingMoves::end(const Watched& watched, motion::Outcome outcome) const {
  switch (outcome) {
    case motion::Outcome::none:
    case motion::Outcome::arrived:
      watched.activity->finish();
      return;
    case motion::Outcome::superseded:
      watched.activity->refuse({fmt::format("a newer command took the place of this move of {}", robot_),
                                "MOVE_ROB queues a move behind its present ones"});
      return;
    case motion::Outcome::stopped:
      watched.activity->refuse({fmt::format("{} was stopped before it arrived", robot_), {}});
      return;
    case motion::Outcome::blocked:
      watched.activity->refuse(
          {fmt::format("{} could not continue along the straight line and stopped before it arrived", robot_),
           fmt::format("cellmirror status shows where it stands; MOVE_ROB {} PTP does not need the line", robot_)});
      return;
  }
}

}  // namespace cellmirror::app
