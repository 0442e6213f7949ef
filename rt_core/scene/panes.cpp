#include "rt_core/scene/panes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "rt_core/base/contract.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/scene/paths.hpp"

namespace cellmirror::scene {

namespace {

constexpr int kBirdsEye = 6;

// Of an unknown display: those of the first one.
std::span<const LayoutPane> panes_of_layout(const DisplayState& display) {
  const int known = display.display >= 1 && display.display <= static_cast<int>(kDisplays) ? display.display : 1;
  return display.layout.displays[static_cast<std::size_t>(known - 1)].panes;
}

Pane pane_of(const PaneInput& input, int id) {
  const DisplayView& shown = input.display.views[static_cast<std::size_t>(id)];
  Pane pane;
  pane.view = id;
  pane.eye = eye_of(view_now(input, id));
  if (shown.camera.empty()) return pane;
  if (const auto camera = camera_now(input.cell, input.poses, input.display, shown.camera))
    pane.camera = object_of_camera(input.cell, *camera);
  return pane;
}

std::string title_of(const PaneInput& input, const Pane& pane) {
  const auto index = static_cast<std::size_t>(pane.view);
  if (pane.camera != 0) return fmt::format("{} {}", pane.view, last_name(input.display.views[index].camera));
  return fmt::format("{} {}", pane.view, input.display.layout.views[index].name);
}

std::optional<Pane> pane_of_current_camera(const PaneInput& input) {
  if (input.cell.cameras.empty()) return std::nullopt;
  auto camera = camera_now(input.cell, input.poses, input.display, input.display.current_camera);
  if (!camera) camera = cameras_now(input.cell, input.poses, input.display).front();
  Pane pane;
  pane.view = kBirdsEye;
  pane.camera = object_of_camera(input.cell, *camera);
  pane.eye = eye_of(view_of_camera(*camera, input.display.views[kBirdsEye].view));
  if (!input.display.full_screen) pane.title = input.cell.cameras[camera->camera].name;
  return pane;
}

}  // namespace

std::vector<Pane> panes_of_display(const PaneInput& input) {
  if (input.display.on(DisplayMode::camera_main_view)) {
    if (auto pane = pane_of_current_camera(input)) return {*std::move(pane)};
  }
  const std::span<const LayoutPane> placed = panes_of_layout(input.display);
  CELLMIRROR_EXPECTS(!placed.empty());
  std::vector<Pane> panes;
  for (const LayoutPane& area : placed) {
    Pane pane = pane_of(input, area.view);
    pane.left = area.left;
    pane.top = area.top;
    pane.width = area.width;
    pane.height = area.height;
    if (!input.display.full_screen) pane.title = title_of(input, pane);
    panes.push_back(std::move(pane));
  }
  return panes;
}

std::vector<Pane> panes_of_view(const PaneInput& input, int id) {
  return {pane_of(input, std::clamp(id, 0, static_cast<int>(kViews) - 1))};
}

Result<std::vector<Pane>> panes_of_camera(const PaneInput& input, std::string_view camera) {
  const auto now = camera_now(input.cell, input.poses, input.display, camera);
  if (!now) {
    std::vector<std::string> names;
    for (const CompiledCamera& known : input.cell.cameras) names.push_back(known.name);
    return fail(fmt::format("there is no camera {}", printable(camera)),
                names.empty() ? "the cell has no cameras" : did_you_mean(camera, names));
  }
  Pane pane;
  pane.view = -1;
  pane.camera = object_of_camera(input.cell, *now);
  pane.eye = eye_of(view_of_camera(*now, input.display.views[0].view));
  return std::vector<Pane>{std::move(pane)};
}

}  // namespace cellmirror::scene
