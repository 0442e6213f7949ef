// What the ticks of a recording published, put together again from its messages. Takes any bytes. One thread; not for
// the tick.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "app/recording_layout/tick_inputs.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/engine/tick_state.hpp"

namespace cellmirror::app {

class PublishedTicks {
 public:
  // With the time of each tick, whose state() can be asked for within the call. `after_gap`: ticks before this one are
  // missing, or it is the first. False: nothing more is wanted.
  using Take = std::function<bool(Timestamp time, bool after_gap)>;

  // A message of kInputsTopic; in the order of the file. True: `take` wants more. What is not sound ends with an error,
  // and what follows begins with the next start state.
  Result<bool> take(ByteSpan message, const Take& take);
  // A message is missing.
  void gap() {
    robots_.reset();
    next_capacity_.reset();
  }

  // Of the newest tick. Valid until the next message.
  [[nodiscard]] const engine::TickState& state();

  // Of the slots, as they were named last; changed with each new naming.
  [[nodiscard]] const NamesBySlot& names() const { return names_; }
  [[nodiscard]] std::uint64_t names_revision() const { return names_revision_; }

 private:
  Result<void> begin(ByteSpan start);
  void begin_with(std::size_t robots);
  Result<bool> tick(ByteSpan record, const Take& take);

  std::optional<PublishedRobots> robots_;     // none: before a start state
  std::optional<std::size_t> next_capacity_;  // of a start state right before the next tick, which may follow a gap
  std::optional<std::uint64_t> last_tick_;
  engine::TickState state_;
  NamesBySlot names_;
  std::uint64_t names_revision_ = 0;
};

// The time of the tick in a record of one.
[[nodiscard]] std::optional<Timestamp> time_of_tick(ByteSpan record);

}  // namespace cellmirror::app
