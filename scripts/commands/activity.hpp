// Work that continues after its command, such as a moving robot. One thread: the owner of the cell.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "rt_core/base/result.hpp"

namespace cellmirror {

class Activity {
 public:
  enum class State : std::uint8_t { running, done, refused };

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const Error& error() const { return error_; }  // of a refused one: why it did not come to its end

  // The first end counts.
  void finish() { end(State::done, {}); }
  void refuse(Error why) { end(State::refused, std::move(why)); }

 private:
  void end(State state, Error why) {
    if (state_ != State::running) return;
    state_ = state;
    error_ = std::move(why);
  }

  State state_ = State::running;
  Error error_;
};

// Null: there is nothing to wait for.
using ActivityHandle = std::shared_ptr<const Activity>;

}  // namespace cellmirror
