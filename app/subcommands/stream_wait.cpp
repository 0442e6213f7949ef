#include "app/subcommands/stream_wait.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

bool is_online(const json& robot) { return robot.at("mode") == "mirrored"; }

std::string state_in_words(const json& robot) {
  const json& stream = robot.at("stream");
  if (stream.at("kind") == "none") return "has no stream";
  const auto state = stream.at("state").get<std::string>();
  if (state == "off") return "is not online";
  const std::string condition = stream.value("condition", "");
  return condition.empty() ? "is " + state : fmt::format("is {} ({})", state, condition);
}

}  // namespace

StreamWaitResult look_at_streams(const json& status, const StreamWait& wanted) {
  StreamWaitResult out;
  std::vector<std::string> known;
  const auto note = [&](const std::string& text) { out.missing += (out.missing.empty() ? "" : ", ") + text; };
  for (const json& robot : status.at("robots")) {
    const auto id = robot.at("id").get<std::string>();
    const bool is_named = std::ranges::find(wanted.robots, id) != wanted.robots.end();
    if (is_named) known.push_back(id);
    if (wanted.robots.empty() ? !is_online(robot) : !is_named) continue;
    if (robot.at("stream").at("state") == wanted.state) {
      out.there.push_back(id);
    } else {
      note(id + " " + state_in_words(robot));
    }
  }
  for (const std::string& id : wanted.robots) {
    if (std::ranges::find(known, id) == known.end()) note("there is no robot " + id);
  }
  if (wanted.robots.empty() && out.there.empty() && out.missing.empty()) note("no robot is online");
  return out;
}

}  // namespace cellmirror::app
