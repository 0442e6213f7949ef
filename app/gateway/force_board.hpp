// Where the worker of forces hangs up what it computed, for the publisher and for status.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "rt_core/ports/force_state.hpp"

namespace cellmirror::app {

// Between workers only; the tick has no part in it, so a lock is allowed.
class ForceBoard {
 public:
  void hang_up(std::shared_ptr<const ForceState> state) {
    const std::scoped_lock lock(mutex_);
    state_.swap(state);  // the one before is let go by the caller's argument
  }
  // The newest; null: nothing was computed yet.
  [[nodiscard]] std::shared_ptr<const ForceState> look() const {
    const std::scoped_lock lock(mutex_);
    return state_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const ForceState> state_;
};

}  // namespace cellmirror::app
