#include "app/render/scene_source.hpp"

#include <utility>

#include "rt_core/dynamics/arrows.hpp"

namespace cellmirror::app {

Result<std::vector<Pane>> panes_of(const scene::PaneInput& input, const PictureRequest& request) {
  if (request.camera) return scene::panes_of_camera(input, *request.camera);
  if (request.view) return scene::panes_of_view(input, *request.view);
  if (!request.free_view) return scene::panes_of_display(input);
  Pane pane;
  pane.view = -1;
  pane.eye = scene::eye_of(*request.free_view);
  return std::vector<Pane>{std::move(pane)};
}

void SceneSource::take_conditions(const engine::TickState& tick, Timestamp now) {
  conditions_.clear();
  for (const CompiledRobot& robot : cell_->robots) {
    const engine::RobotTickState& state = tick.robots[robot.slot];
    scene::RobotCondition condition;
    condition.slot = robot.slot;
    condition.mirrored = state.mode == engine::RobotMode::mirrored;
    condition.state = state.state;
    if (state.receive_time.known()) condition.age_s = seconds(now - state.receive_time);
    conditions_.push_back(condition);
  }
}

bool SceneSource::refresh() {
  std::shared_ptr<const CellState> picture = boards_.pictures.latest();
  const engine::TickState& tick = boards_.ticks.newest();
  if (!picture || !picture->display || !tick.time.known() || !poser_.take(*picture->cell, tick)) return false;
  picture_ = std::move(picture);
  cell_ = picture_->cell;
  now_ = boards_.clock.now();
  cell_now_ = boards_.cell_now();
  take_conditions(tick, cell_now_);
  const auto proximity = boards_.proximity.latest();
  const auto ranges = boards_.ranges.latest();
  const auto forces = boards_.forces.latest();
  const auto traces = boards_.traces.latest();
  std::vector<ForceArrow> arrows;
  if (forces) arrows = dynamics::force_arrows(picture_->forces.arrows, *forces);
  scene::SceneInput input;
  input.cell = cell_.get();
  input.poses = &poser_.poses();
  input.display = picture_->display.get();
  input.active_robot = picture_->active_robot;
  input.robots = conditions_;
  input.proximity = proximity.get();
  if (ranges) input.ranges = ranges->readings;
  if (ranges) input.barriers = ranges->barriers;
  input.forces = forces.get();
  input.arrows = arrows;
  if (traces && traces->smear_ends == picture_->display->smear_ends) input.traces = traces->traces;
  if (boards_.tissue) input.tissue = boards_.tissue();
  input.volumes = picture_->volumes.get();
  input.posture_time = tick.time;
  input.now = cell_now_;
  builder_.build(input, scene_);
  return true;
}

Result<std::vector<Pane>> SceneSource::panes(const PictureRequest& request, std::uint64_t updates) const {
  return panes_of({*cell_, poser_.poses(), *picture_->display, cell_now_, updates}, request);
}

}  // namespace cellmirror::app
