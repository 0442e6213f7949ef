#include "app/subcommands/status_table_display.hpp"

#include "app/subcommands/status_words.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

void add(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

// Of views that are moved by something.
std::string view_lines(const json& views) {
  std::string out;
  for (const json& view : views) {
    const auto id = view.at("id").get<int>();
    if (view.at("camera").is_string()) out += fmt::format("  view {} at the camera {}\n", id, text(view.at("camera")));
    const json& sequence = view.at("sequence");
    if (!sequence.is_object()) continue;
    out += sequence.contains("left_s")
               ? fmt::format("  view {} on its way, {:.1f} s left\n", id, sequence.at("left_s").get<double>())
               : fmt::format("  view {} on its way, {} steps\n", id, sequence.at("steps").get<std::uint64_t>());
  }
  return out;
}

std::string camera_line(const json& camera) {
  std::string what;
  if (camera.at("tracks").is_string()) add(what, "tracks " + text(camera.at("tracks")));
  if (camera.at("pyramid").get<bool>()) add(what, "pyramid");
  if (camera.at("online").get<bool>()) add(what, "online");
  if (camera.at("mirrored").get<bool>()) add(what, "mirrored");
  return what.empty() ? std::string() : fmt::format("  camera {}: {}\n", text(camera.at("id")), what);
}

}  // namespace

std::string display_table(const json& status) {
  if (!status.contains("display")) return {};
  const json& display = status.at("display");
  std::string modes;
  for (const auto& [name, on] : display.at("modes").items()) {
    if (on.get<bool>()) add(modes, name);
  }
  if (display.at("legend").get<bool>()) add(modes, "LEGEND");
  std::string out =
      fmt::format("\ndisplay  {}{}; {}\n", display.at("display").get<int>(),
                  display.at("full_screen").get<bool>() ? " FULL" : "", modes.empty() ? "no modes" : modes);
  out += view_lines(display.at("views"));
  for (const json& camera : display.at("cameras")) out += camera_line(camera);
  for (const json& rule : display.at("draw_modes"))
    out += fmt::format("  {}{} drawn {}\n", text(rule.at("node")),
                       rule.at("with_details").get<bool>() ? " and its details" : "", text(rule.at("mode")));
  for (const json& robot : display.at("arcs")) out += fmt::format("  arc at {}\n", text(robot));
  return out;
}

}  // namespace cellmirror::app
