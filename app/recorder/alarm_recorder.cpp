#include "app/recorder/alarm_recorder.hpp"

#include <utility>

namespace cellmirror::app {

namespace {

constexpr Nanoseconds kBetweenAlarmLooks{100'000'000};

}  // namespace

void AlarmRecorder::look(Timestamp now) {
  if (!alarms_.revision || !hub_.wants(*topic_)) return;
  if (last_look_.known() && now >= last_look_ && now - last_look_ < kBetweenAlarmLooks) return;
  last_look_ = now;
  const std::uint64_t files = hub_.files_begun();
  if (std::exchange(files_, files) != files) {
    known_.clear();
    revision_ = 0;
  }
  const std::uint64_t revision = alarms_.revision();
  if (std::exchange(revision_, revision) == revision) return;
  std::map<std::uint64_t, std::string> newest;
  for (AlarmLines::Line& line : alarms_.newest()) {
    const auto known = known_.find(line.id);
    if (known == known_.end() || known->second != line.text)
      hub_.put(topic_, to_wall_clock_ns(now), mcap::view_of(line.text));
    newest[line.id] = std::move(line.text);
  }
  known_ = std::move(newest);
}

}  // namespace cellmirror::app
