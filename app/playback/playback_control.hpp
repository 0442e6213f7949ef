// Where the playing of a recording is, and how it goes on: play, pause, speed, seek. Knows neither files nor threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "app/playback/playback_clock.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/playback.hpp"
#include "rt_core/rt/wake_signal.hpp"

namespace cellmirror::app {

class PlaybackControl final : public PlaybackPort {
 public:
  // Instants of the recorder's clock.
  struct Range {
    Timestamp from;
    Timestamp to;
    Nanoseconds utc{0};  // UTC minus instant
  };
  // Plays from `range.from` on, or stands there.
  PlaybackControl(Range range, std::string file, double speed, bool playing);

  [[nodiscard]] PlaybackState state() const override;
  Result<void> apply(const PlaybackRequest& request) override;
  // Why it cannot go on where it is; empty: it can.
  [[nodiscard]] std::string failure() const;
  [[nodiscard]] const Clock& clock() const { return clock_; }
  [[nodiscard]] const Range& range() const { return range_; }

  // In any order; those out of the range are left out, and the first kMostMarks count. Before any other thread uses it.
  static constexpr std::size_t kMostMarks = 500;
  void set_marks(PlaybackMarks marks);

  // Of the player's thread. `wall`: of the machine's clock.

  // A seek that was asked for since the last call: its target; the time stands there until arrived().
  [[nodiscard]] std::optional<Timestamp> take_seek();
  // The time that is due at `wall`; the clock shows it from now on.
  [[nodiscard]] Timestamp due(Timestamp wall);
  // The first state after a start or a seek: `recorded` is its time, later than was wanted where nothing was recorded.
  void arrived(Timestamp recorded, Timestamp wall);
  // Nothing was recorded until `recorded`: the time goes on from there.
  void jumped(Timestamp recorded, Timestamp wall, std::string why);
  void ended();
  // It cannot go on.
  void failed(std::string why);
  [[nodiscard]] bool seek_waits() const;
  // Waits for a change, or so long.
  void wait(Nanoseconds at_most) { changed_.wait(at_most); }
  void wake() { changed_.wake(); }

 private:
  void set_time(Timestamp recorded);
  void anchor(Timestamp wall) { anchor_wall_ = wall; }

  const Range range_;
  const std::string file_;
  std::shared_ptr<const PlaybackMarks> marks_;
  PlaybackClock clock_;
  WakeSignal changed_;
  mutable std::mutex mutex_;  // of what follows
  bool playing_;
  bool seeking_ = true;  // to the beginning
  bool ended_ = false;
  double speed_;
  std::optional<Timestamp> seek_;
  Timestamp position_;     // at anchor_wall_
  Timestamp anchor_wall_;  // never: not known yet
  std::uint64_t changes_ = 0;
  std::uint64_t seeks_ = 0;
  std::uint64_t gaps_ = 0;
  std::string note_;
  std::string failure_;
};

}  // namespace cellmirror::app
