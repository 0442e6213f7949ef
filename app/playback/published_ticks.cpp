#include "app/playback/published_ticks.hpp"

#include <utility>

#include "rt_core/base/state_bytes.hpp"
#include "rt_core/engine/engine.hpp"

namespace cellmirror::app {

std::optional<Timestamp> time_of_tick(ByteSpan record) {
  StateReader in(record);
  std::uint64_t cycle = 0;
  Timestamp time;
  in(cycle, time);
  return in.ok() && time.ns > 0 && time < kLatestInstant ? std::optional(time) : std::nullopt;
}

Result<bool> PublishedTicks::take(ByteSpan message, const Take& take) {
  Result<bool> more = true;
  const auto read = for_each_record(message, [&](engine::InputRecord kind, ByteSpan content) {
    if (kind == engine::InputRecord::robots) {
      auto names = read_names(content);
      if (!names) {
        more = std::unexpected(names.error());
      } else {
        names_ = *std::move(names);
        ++names_revision_;
      }
    } else if (kind == engine::InputRecord::start) {
      if (auto begun = begin(content); !begun) more = std::unexpected(begun.error());
    } else if (kind == engine::InputRecord::tick) {
      more = tick(content, take);
    }
    return more.has_value() && *more;
  });
  if (!read) more = std::unexpected(read.error());
  if (!more) gap();
  return more;
}

// While ticks follow each other, what is known of them is right already. The next tick shows whether they do.
Result<void> PublishedTicks::begin(ByteSpan start) {
  const auto capacity = engine::Engine::capacity_of(start);
  if (!capacity) return std::unexpected(capacity.error());
  next_capacity_ = capacity->robots;
  if (!robots_) begin_with(capacity->robots);
  return {};
}

void PublishedTicks::begin_with(std::size_t robots) {
  robots_.emplace(robots);
  last_tick_.reset();
  state_ = engine::TickState(robots);
}

Result<bool> PublishedTicks::tick(ByteSpan record, const Take& take) {
  const std::optional<std::size_t> capacity = std::exchange(next_capacity_, std::nullopt);
  std::uint64_t number = 0;
  StateReader head(record);
  head(number);
  if (robots_ && last_tick_ && number != *last_tick_ + 1) {
    gap();
    if (capacity) begin_with(*capacity);
  }
  if (!robots_) return true;
  const auto inputs = read_tick(record, *robots_);
  if (!inputs) return std::unexpected(inputs.error());
  const bool first = !last_tick_.has_value();
  last_tick_ = inputs->context.cycle;
  state_.tick = inputs->context.cycle;
  state_.time = inputs->context.now;
  state_.missed_periods += inputs->context.missed;
  state_.commands_done = inputs->commands_done;
  state_.commands_refused = inputs->commands_refused;
  for (const PublishedHaptic& published : inputs->haptic_states) state_.haptics.at(published.channel) = published.state;
  return take(state_.time, first);
}

const engine::TickState& PublishedTicks::state() {
  for (std::size_t slot = 0; robots_ && slot < state_.robots.size(); ++slot) {
    const engine::RobotTickState& from = robots_->robots()[slot].state;
    if (from.mode == engine::RobotMode::absent) {
      state_.robots[slot].mode = from.mode;
    } else {
      state_.robots[slot] = from;
    }
  }
  return state_;
}

}  // namespace cellmirror::app
