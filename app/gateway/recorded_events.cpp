#include "app/gateway/recorded_events.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "app/playback/playback_control.hpp"
#include "app/recording_layout/recording_names.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/utf8.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::size_t kMostEventBytes = 4096;
constexpr std::size_t kMostNameBytes = 200;
constexpr std::int64_t kNsOfMs = 1'000'000;  // times of alarms fit (alarm_line.cpp)

std::string_view text_of(const mcap::Message& message) {
  return {reinterpret_cast<const char*>(message.data.data()), message.data.size()};
}

std::string text_member(const json& object, const char* key) {
  const auto found = object.find(key);
  const auto* text = found == object.end() ? nullptr : found->get_ptr<const std::string*>();
  return text == nullptr ? std::string() : std::string(cut_utf8(drawable_utf8(*text), kMostNameBytes));
}

// None: no bodies that begin to touch.
std::string touching(std::string_view event) {
  if (event.size() > kMostEventBytes) return {};
  const json document = json::parse(event, nullptr, /*allow_exceptions=*/false);
  if (!document.is_object() || text_member(document, "change") != "touched") return {};
  return text_member(document, "a") + ", " + text_member(document, "b");
}

void read_topic(RecordedRun& run, std::string_view topic, const mcap::Reader::Take& take) {
  if (auto read = run.read_topic(topic, take); !read)
    log_warning("replay.events", "not all of {} can be read: {}", topic, printable(read.error().text()));
}

}  // namespace

void read_alarms(RecordedRun& run, AlarmHistory& alarms) {
  read_topic(run, kAlarmsTopic, [&](const mcap::Message& message, const mcap::Channel& channel) {
    if (channel.encoding == "json" && std::in_range<std::int64_t>(message.publish_time))
      alarms.add(static_cast<std::int64_t>(message.publish_time), text_of(message));
    return true;
  });
}

PlaybackMarks read_marks(RecordedRun& run, const AlarmHistory& alarms) {
  PlaybackMarks out;
  read_topic(run, kCollisionEventsTopic, [&](const mcap::Message& message, const mcap::Channel& channel) {
    if (channel.encoding != "json" || !std::in_range<std::int64_t>(message.publish_time)) return true;
    if (std::string text = touching(text_of(message)); !text.empty())
      out.push_back({static_cast<std::int64_t>(message.publish_time), PlaybackMarkKind::collision, std::move(text)});
    return out.size() < PlaybackControl::kMostMarks;
  });
  for (const AlarmHistory::Raised& raised : alarms.raised()) {
    if (raised.alarm.priority != AlarmPriority::high || raised.alarm.kind == "collision") continue;
    out.push_back({raised.time_ms * kNsOfMs, PlaybackMarkKind::fault, raised.alarm.text});
  }
  return out;
}

}  // namespace cellmirror::app
