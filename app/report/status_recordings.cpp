#include "app/report/status_recordings.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace cellmirror::app {

nlohmann::json recording_json(const RecordingReport& report) {
  using nlohmann::json;
  json topics = json::array();
  for (const TopicReport& topic : report.topics)
    topics.push_back({{"topic", topic.topic}, {"messages", topic.messages}, {"dropped", topic.dropped}});
  return {{"kind", report.ring ? "ring" : "file"},
          {"ended", report.ended},
          {"why", report.why},
          {"problem", report.problem},
          {"file", report.file},
          {"duration_s", report.seconds},
          {"messages", report.messages},
          {"dropped", report.dropped},
          {"bytes", report.bytes},
          {"files", report.files},
          {"kept", report.kept},
          {"topics", std::move(topics)}};
}

nlohmann::json recordings_json(std::span<const RecordingReport> reports) {
  nlohmann::json out = nlohmann::json::array();
  for (const RecordingReport& report : reports) out.push_back(recording_json(report));
  return out;
}

}  // namespace cellmirror::app
