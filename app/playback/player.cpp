#include "app/playback/player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "rt_core/base/log.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kStep{1'000'000};         // of the machine's time, from one look at what is due to the next
constexpr std::chrono::milliseconds kRest{50};  // while nothing is due; changes wake

}  // namespace

Result<void> Player::start() {
  bool published = false;
  auto read = run_.read(control_.range().from, [&](Timestamp /*time*/, bool /*after_gap*/) {
    publish();
    published = true;
    return false;
  });
  if (!published) return read ? fail("the recording has no ticks") : read;
  thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
  return {};
}

void Player::stop() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  control_.wake();
  thread_.join();
}

void Player::loop(const std::stop_token& stop) {
  set_thread_name("player");
  play(control_.range().from, stop);
  while (!stop.stop_requested()) {
    if (const auto target = control_.take_seek()) {
      play(*target, stop);
    } else {
      control_.wait(kRest);
    }
  }
}

bool Player::wait_for(Timestamp tick, const std::stop_token& stop) {
  while (!stop.stop_requested() && !control_.seek_waits()) {
    const Timestamp due = control_.due(wall_.now());
    if (due >= tick) return true;
    control_.wait(control_.state().status == PlaybackStatus::playing ? kStep : Nanoseconds(kRest));
  }
  return false;
}

void Player::publish() {
  // First: who sees the tick sees what belongs to it.
  run_.tissue().publish();
  ticks_.publish(run_.state(), run_.names(), run_.names_revision());
  if (ticks_.missing().size() == told_missing_) return;
  told_missing_ = ticks_.missing().size();
  for (const std::string& robot : ticks_.missing())
    log_warning("replay.robot", "the recording has no robot {} with these joints; it stands where it starts", robot);
}

void Player::play(Timestamp from, const std::stop_token& stop) {
  const Nanoseconds period(static_cast<std::int64_t>(1e9 / run_.rate_hz()));
  const Timestamp end = control_.range().to;
  bool arrived = false;
  bool over = false;
  Timestamp last;
  const auto read = run_.read(from, [&](Timestamp time, bool after_gap) {
    if (time > end) {
      over = true;
      return false;
    }
    if (!arrived) {
      last = time;
      if (time + period / 2 < from) return !stop.stop_requested() && !control_.seek_waits();
      arrived = true;
      // First, so that who sees that it has arrived sees its state.
      publish();
      control_.arrived(time, wall_.now());
      return true;
    }
    if (after_gap) {
      control_.jumped(time, wall_.now(),
                      fmt::format("nothing was recorded for {:.3f} s; they were jumped over", seconds(time - last)));
      log_warning("replay.gap", "nothing was recorded for {:.3f} s; they are jumped over", seconds(time - last));
    }
    last = time;
    const Timestamp now = control_.due(wall_.now());
    if (now < time && !wait_for(time, stop)) return false;
    // One of several that are due at once is passed over, as by readers of the loop that come too late.
    if (time + period + period / 2 > control_.clock().now() || time == end) publish();
    return true;
  });
  const bool interrupted = stop.stop_requested() || control_.seek_waits();
  if (!read && !interrupted) {
    log_error("replay.file", "the recording cannot be read on: {}", read.error().text());
    return control_.failed(read.error().text());
  }
  if (!interrupted || over) control_.ended();
}

}  // namespace cellmirror::app
