#include "app/subcommands/status_table_recordings.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cellmirror::app {

std::string recording_figures(const nlohmann::json& recording) {
  return fmt::format("{:.1f} s, {} messages, {:.1f} MB, {} dropped", recording.at("duration_s").get<double>(),
                     recording.at("messages").get<std::uint64_t>(),
                     1e-6 * static_cast<double>(recording.at("bytes").get<std::uint64_t>()),
                     recording.at("dropped").get<std::uint64_t>());
}

std::string recordings_table(const nlohmann::json& status) {
  if (!status.contains("recordings")) return {};  // an older gateway
  std::string out;
  for (const nlohmann::json& recording : status.at("recordings")) {
    const bool ring = recording.at("kind").get<std::string>() == "ring";
    const bool ended = recording.at("ended").get<bool>();
    out += fmt::format("{} {}  {}{}\n", ring ? "black box" : "recording", recording.at("file").get<std::string>(),
                       recording_figures(recording), ended ? ", ended" : "");
    for (const char* key : {"why", "problem"}) {
      const auto text = recording.at(key).get<std::string>();
      if (!text.empty()) out += fmt::format("  {}\n", text);
    }
    for (const nlohmann::json& topic : recording.at("topics")) {
      if (const auto dropped = topic.at("dropped").get<std::uint64_t>(); dropped > 0)
        out += fmt::format("  {}: {} dropped\n", topic.at("topic").get<std::string>(), dropped);
    }
  }
  return out.empty() ? out : "\n" + out;
}

}  // namespace cellmirror::app
