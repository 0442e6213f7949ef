#include "app/report/status_display.hpp"
#include "app/report/status_values.hpp"
#include "rt_core/ports/words.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace cellmirror::app {

namespace {

using nlohmann::json;

json sequence_json(const ViewSequence& sequence, Timestamp now) {
  if (sequence.steps > 0) return {{"steps", sequence.steps}};
  const double left = seconds(sequence.duration) - seconds(now - sequence.begin);
  return {{"duration_s", seconds(sequence.duration)}, {"left_s", std::max(0.0, left)}};
}

// Where a sequence runs: as the view will be.
json view_json(std::size_t id, std::string_view name, const DisplayView& shown, Timestamp now) {
  const View& view = shown.view;
  json out = {{"id", id},
              {"name", name},
              {"viewpoint_m", vector_json(view.viewpoint)},
              {"lookpoint_m", vector_json(view.lookpoint)},
              {"twist_rad", view.twist},
              {"opening_angle_rad", view.opening_angle},
              {"near_m", view.near_distance},
              {"far_m", view.far_distance},
              {"projection", view.orthogonal ? "parallel" : "perspective"},
              {"camera", nullptr},
              {"sequence", nullptr}};
  if (!shown.camera.empty()) out["camera"] = shown.camera;
  if (shown.sequence) out["sequence"] = sequence_json(*shown.sequence, now);
  return out;
}

// The main view first.
json displays_json(const DisplayLayout& layout) {
  json displays = json::array();
  for (std::size_t i = 0; i < kDisplays; ++i) {
    json panes = json::array();
    for (const LayoutPane& pane : layout.displays[i].panes)
      panes.push_back({{"view", pane.view}, {"area", {pane.left, pane.top, pane.width, pane.height}}});
    displays.push_back({{"id", i + 1}, {"name", layout.displays[i].name}, {"panes", std::move(panes)}});
  }
  return displays;
}

json camera_json(const CameraSetting& camera) {
  json out = {{"id", camera.name},           {"pyramid", camera.pyramid}, {"online", camera.online},
              {"mirrored", camera.mirrored}, {"tracks", nullptr},         {"tracking", camera.tracking}};
  if (!camera.tracks.empty()) out["tracks"] = camera.tracks;
  return out;
}

}  // namespace

json display_json(const DisplayState& display, Timestamp now) {
  json modes = json::object();
  for (std::size_t mode = 0; mode < kDisplayModes; ++mode)
    modes[std::string(kDisplayModeWords.at(mode))] = display.modes.test(mode);
  json views = json::array();
  for (std::size_t id = 0; id < kViews; ++id)
    views.push_back(view_json(id, display.layout.views[id].name, display.views[id], now));
  json cameras = json::array();
  for (const CameraSetting& camera : display.cameras) cameras.push_back(camera_json(camera));
  json rules = json::array();
  for (const DrawRule& rule : display.draw_rules)
    rules.push_back({{"node", rule.path}, {"with_details", rule.branch}, {"mode", word(rule.mode)}});
  json out = {{"display", display.display},
              {"full_screen", display.full_screen},
              {"modes", std::move(modes)},
              {"legend", display.legend},
              {"tag_length_m", display.tag_length_m},
              {"views", std::move(views)},
              {"current_camera", nullptr},
              {"cameras", std::move(cameras)},
              {"draw_modes", std::move(rules)},
              {"arcs", display.arcs},
              {"displays", displays_json(display.layout)}};
  if (!display.current_camera.empty()) out["current_camera"] = display.current_camera;
  return out;
}

}  // namespace cellmirror::app
