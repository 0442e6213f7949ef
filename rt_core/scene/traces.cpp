#include "rt_core/scene/traces.hpp"

#include <algorithm>
#include <iterator>

#include "rt_core/ports/palette.hpp"
#include "rt_core/scene/frames.hpp"

namespace cellmirror::scene {

Traces::Trace& Traces::trace_of(const std::string& robot) {
  const auto at = std::ranges::find(traces_, robot, &Trace::robot);
  if (at != traces_.end()) {
    // To the end, among those used last.
    std::rotate(at, std::next(at), traces_.end());
    return traces_.back();
  }
  if (traces_.size() == kTraces) traces_.pop_front();
  traces_.push_back({robot, {}});
  return traces_.back();
}

void Traces::extend(const SceneInput& input) {
  const CompiledRobot* robot = active_robot(input);
  if (robot == nullptr) return;
  const Eigen::Vector3f tcp = tcp_poses(*robot, *input.poses).X_WT.translation().cast<float>();
  if (!tcp.allFinite()) return;
  std::deque<Eigen::Vector3f>& points = trace_of(robot->id).points;
  if (!points.empty() && (tcp - points.back()).norm() < static_cast<float>(kShortestStep)) return;
  points.push_back(tcp);
  if (points.size() > SceneBuilder::kTracePoints) points.pop_front();
}

void Traces::draw(const SceneInput& input, Scene& scene) {
  const bool on = input.display->on(DisplayMode::smear);
  // It may have been off between two scenes.
  if (!on || input.display->smear_ends != smear_ends_) traces_.clear();
  smear_ends_ = input.display->smear_ends;
  if (!on) return;
  std::erase_if(traces_, [&](const Trace& trace) {
    return std::ranges::find(input.cell->robots, trace.robot, &CompiledRobot::id) == input.cell->robots.end();
  });
  extend(input);
  for (const Trace& trace : traces_) {
    if (trace.points.size() < 2) continue;
    scene.traces.push_back({{trace.points.begin(), trace.points.end()}, palette::kTrace});
  }
}

}  // namespace cellmirror::scene
