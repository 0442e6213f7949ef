#include "rt_core/scene/traces.hpp"

#include <algorithm>

#include "rt_core/ports/palette.hpp"

namespace cellmirror::scene {

namespace {

constexpr double kFramePart = 0.2;  // of the length of workframes

}  // namespace

void draw_traces(const SceneInput& input, Scene& scene) {
  if (!input.display->on(DisplayMode::smear)) return;
  for (const TcpTrace& trace : input.traces) {
    if (std::ranges::find(input.cell->robots, trace.robot, &CompiledRobot::id) == input.cell->robots.end()) continue;
    if (trace.points.size() > 1) scene.traces.push_back({trace.points, palette::kTrace});
    if (!input.display->on(DisplayMode::tcp_frame)) continue;
    for (const Pose& X_WT : trace.frames) {
      scene.axes.push_back(
          {.X_WF = X_WT, .length_m = kFramePart * input.display->tag_length_m, .emphasized = false, .name = {}});
    }
  }
}

}  // namespace cellmirror::scene
