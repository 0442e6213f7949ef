// A channel's counters, written by its thread and copied by any.
#pragma once

#include <mutex>
#include <string>
#include <utility>

#include "rt_core/ports/can_channel.hpp"

namespace cellmirror::can {

class StatusBoard {
 public:
  explicit StatusBoard(std::string endpoint) { status_.endpoint = std::move(endpoint); }

  template <class Change>
  void update(Change change) {
    const std::lock_guard lock(mutex_);
    change(status_);
  }
  [[nodiscard]] CanChannelStatus copy() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }

 private:
  mutable std::mutex mutex_;
  CanChannelStatus status_;
};

}  // namespace cellmirror::can
