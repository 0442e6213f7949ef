#include "app/playback/playback_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace cellmirror::app {

PlaybackControl::PlaybackControl(Range range, std::string file, double speed, bool playing)
    : range_(range), file_(std::move(file)), playing_(playing), speed_(speed), position_(range.from) {
  clock_.set(range.from);
}

PlaybackState PlaybackControl::state() const {
  const std::scoped_lock lock(mutex_);
  PlaybackState out;
  const auto utc = [&](Timestamp t) { return (t + range_.utc).ns; };
  out.from_ns = utc(range_.from);
  out.to_ns = utc(range_.to);
  out.now_ns = utc(seek_ ? *seek_ : clock_.now());
  out.speed = speed_;
  if (seeking_ || seek_) {
    out.status = PlaybackStatus::seeking;
  } else if (ended_) {
    out.status = PlaybackStatus::ended;
  } else {
    out.status = playing_ ? PlaybackStatus::playing : PlaybackStatus::paused;
  }
  out.changes = changes_;
  out.seeks = seeks_;
  out.gaps = gaps_;
  out.file = file_;
  out.note = note_;
  out.marks = marks_;
  return out;
}

void PlaybackControl::set_marks(PlaybackMarks marks) {
  std::erase_if(marks, [&](const PlaybackMark& mark) {
    return mark.time_ns < (range_.from + range_.utc).ns || mark.time_ns > (range_.to + range_.utc).ns;
  });
  std::ranges::sort(marks, {}, [](const PlaybackMark& mark) { return std::tie(mark.time_ns, mark.kind, mark.text); });
  if (marks.size() > kMostMarks) marks.resize(kMostMarks);
  marks_ = std::make_shared<const PlaybackMarks>(std::move(marks));
}

Result<void> PlaybackControl::apply(const PlaybackRequest& request) {
  if (request.speed && !(*request.speed >= kSlowestPlayback && *request.speed <= kFastestPlayback))
    return fail(fmt::format("the speed is not between {} and {}", kSlowestPlayback, kFastestPlayback));
  {
    const std::scoped_lock lock(mutex_);
    if (request.speed) {
      // The time up to now has passed at the speed before.
      position_ = clock_.now();
      anchor_wall_ = {};
      speed_ = *request.speed;
    }
    if (request.seek_ns) {
      // Before the subtraction: the number comes from outside.
      const std::int64_t wanted =
          std::clamp(*request.seek_ns, (range_.from + range_.utc).ns, (range_.to + range_.utc).ns);
      seek_ = Timestamp{wanted} - range_.utc;
      ++seeks_;
      ended_ = false;
    }
    if (request.play) {
      // What has ended begins again.
      if (*request.play && ended_) seek_ = range_.from;
      ended_ = ended_ && !*request.play;
      if (playing_ != *request.play) {
        position_ = clock_.now();
        anchor_wall_ = {};
      }
      playing_ = *request.play;
    }
    ++changes_;
  }
  changed_.wake();
  return {};
}

std::optional<Timestamp> PlaybackControl::take_seek() {
  const std::scoped_lock lock(mutex_);
  if (!seek_) return std::nullopt;
  seeking_ = true;
  note_.clear();
  failure_.clear();
  set_time(*seek_);
  return std::exchange(seek_, std::nullopt);
}

bool PlaybackControl::seek_waits() const {
  const std::scoped_lock lock(mutex_);
  return seek_.has_value();
}

void PlaybackControl::set_time(Timestamp recorded) {
  position_ = recorded;
  anchor_wall_ = {};
  clock_.set(recorded);
}

Timestamp PlaybackControl::due(Timestamp wall) {
  const std::scoped_lock lock(mutex_);
  if (!playing_ || seeking_ || ended_) return clock_.now();
  if (!anchor_wall_.known()) anchor(wall);
  const double passed_ns = speed_ * static_cast<double>((wall - anchor_wall_).count());
  const Timestamp now = position_ + Nanoseconds(std::llround(std::clamp(passed_ns, 0.0, 1e18)));
  clock_.set(std::min(now, range_.to));
  return now;
}

void PlaybackControl::arrived(Timestamp recorded, Timestamp wall) {
  const std::scoped_lock lock(mutex_);
  if (!seeking_) return;
  seeking_ = false;
  ++changes_;
  if (recorded > position_) set_time(recorded);
  anchor(wall);
}

void PlaybackControl::jumped(Timestamp recorded, Timestamp wall, std::string why) {
  const std::scoped_lock lock(mutex_);
  ++gaps_;
  ++changes_;
  note_ = std::move(why);
  set_time(recorded);
  anchor(wall);
}

void PlaybackControl::ended() {
  const std::scoped_lock lock(mutex_);
  if (seek_) return;
  seeking_ = false;
  ended_ = true;
  playing_ = false;
  ++changes_;
  set_time(range_.to);
}

void PlaybackControl::failed(std::string why) {
  const std::scoped_lock lock(mutex_);
  seeking_ = false;
  playing_ = false;
  ended_ = true;
  note_ = why;
  failure_ = std::move(why);
  ++changes_;
}

std::string PlaybackControl::failure() const {
  const std::scoped_lock lock(mutex_);
  return failure_;
}

}  // namespace cellmirror::app
