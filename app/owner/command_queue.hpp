// Commands on their way from the threads that receive them to the owner of the cell.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "rt_core/engine/engine.hpp"
#include "scripts/runner/script_command.hpp"

namespace cellmirror::app {

// Any number of producers, one consumer. A lock, since neither side is the tick. What is inside at the end is answered
// as refused (CommandReply).
class CommandQueue {
 public:
  explicit CommandQueue(std::size_t capacity) : capacity_(capacity) {}

  // False, and `command` as it was, where the queue is full.
  [[nodiscard]] bool push(script::ScriptCommand& command) {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() >= capacity_) return false;
    waiting_.push_back(std::move(command));
    ++pushed_;
    high_water_ = std::max(high_water_, waiting_.size());
    return true;
  }
  [[nodiscard]] std::optional<script::ScriptCommand> pop() {
    const std::scoped_lock lock(mutex_);
    if (waiting_.empty()) return std::nullopt;
    std::optional<script::ScriptCommand> next(std::move(waiting_.front()));
    waiting_.pop_front();
    return next;
  }
  // Nothing is dropped: a producer that finds the queue full waits or refuses its command.
  [[nodiscard]] engine::QueueStatus status() const {
    const std::scoped_lock lock(mutex_);
    return {.name = "script", .capacity = capacity_, .high_water = high_water_, .passed = pushed_, .dropped = 0};
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::deque<script::ScriptCommand> waiting_;
  std::size_t high_water_ = 0;
  std::uint64_t pushed_ = 0;
};

}  // namespace cellmirror::app
