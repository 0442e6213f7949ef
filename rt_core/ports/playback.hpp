// The playing of a recording, as its controls see it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"

namespace cellmirror {

inline constexpr double kSlowestPlayback = 0.01;  // times as fast as it was recorded
inline constexpr double kFastestPlayback = 20;

enum class PlaybackStatus : std::uint8_t {
  playing,
  paused,
  seeking,  // the state at the wanted time is being put together
  ended,    // paused at the end
};

// Where something began that people look for first.
enum class PlaybackMarkKind : std::uint8_t { collision, fault };
struct PlaybackMark {
  std::int64_t time_ns = 0;  // since 1970, UTC
  PlaybackMarkKind kind = PlaybackMarkKind::collision;
  std::string text;  // which bodies, which fault
};
using PlaybackMarks = std::vector<PlaybackMark>;

// Times in nanoseconds since 1970, UTC, as they were recorded.
struct PlaybackState {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
  std::int64_t now_ns = 0;
  double speed = 1;
  PlaybackStatus status = PlaybackStatus::paused;
  std::uint64_t changes = 0;  // of status and speed, and seeks; not of the time that passes
  std::uint64_t seeks = 0;    // that were asked for
  std::uint64_t gaps = 0;     // that were jumped over
  std::string file;
  std::string note;                            // the newest gap, or why nothing goes on; empty: none
  std::shared_ptr<const PlaybackMarks> marks;  // within the range, by time; null: none
};

// UTC, ns, so many finite seconds after the beginning of what is played.
[[nodiscard]] inline std::int64_t playback_time_ns(const PlaybackState& state, double after_begin_s) {
  return state.from_ns + std::llround(1e9 * std::clamp(after_begin_s, -1e9, 1e9));
}

// What is not given stays as it is.
struct PlaybackRequest {
  std::optional<bool> play;
  std::optional<double> speed;
  std::optional<std::int64_t> seek_ns;  // moved into the range that is played
};

// Any thread.
class PlaybackPort {
 public:
  virtual ~PlaybackPort() = default;
  [[nodiscard]] virtual PlaybackState state() const = 0;
  // All of it, or nothing and why.
  virtual Result<void> apply(const PlaybackRequest& request) = 0;
};

[[nodiscard]] constexpr const char* word(PlaybackMarkKind kind) {
  return kind == PlaybackMarkKind::collision ? "collision" : "fault";
}

[[nodiscard]] constexpr const char* word(PlaybackStatus status) {
  switch (status) {
    case PlaybackStatus::playing:
      return "playing";
    case PlaybackStatus::paused:
      return "paused";
    case PlaybackStatus::seeking:
      return "seeking";
    case PlaybackStatus::ended:
      return "ended";
  }
  return "";
}

}  // namespace cellmirror
