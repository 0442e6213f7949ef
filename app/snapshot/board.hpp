// Publishes the newest state of one kind to any number of readers.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace cellmirror::app {

// An immutable object that is replaced as a whole: one writer, any readers, between worker threads. The tick has no
// part in it, so a lock is allowed; it is held for the copy of a pointer.
template <class State>
class Board {
 public:
  void publish(std::shared_ptr<const State> state) {
    const std::scoped_lock lock(mutex_);
    state_.swap(state);  // the state before is released by the parameter, after the lock
  }
  // Null before the first publish().
  [[nodiscard]] std::shared_ptr<const State> latest() const {
    const std::scoped_lock lock(mutex_);
    return state_;
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const State> state_;
};

}  // namespace cellmirror::app
