#include "rt_core/scene/pair_marks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

#include "rt_core/ports/palette.hpp"
#include "rt_core/scene/words.hpp"

namespace cellmirror::scene {

namespace {

constexpr float kWidth = 2.5F;

std::string age_words(const ProximityState& proximity, Timestamp now) {
  if (!proximity.posture_time.known() || !now.known()) return {};
  const double age = seconds(now - proximity.posture_time);
  return age > PairMarks::kOldAfter ? fmt::format(" ({} ago)", age_text(age)) : std::string();
}

SceneLine line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Colour& colour, bool dashed) {
  return {.from = from, .to = to, .rgba = colour, .width_px = kWidth, .dashed = dashed, .on_top = true};
}

}  // namespace

void PairMarks::update(const CompiledCell& cell, const Bodies& bodies) {
  drawn_of_node_.assign(cell.size(), Run());
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    Run& run = drawn_of_node_[static_cast<std::size_t>(bodies.node(i))];
    if (run.count == 0) run.first = i;
    run.count = i - run.first + 1;
  }
  if (paths_ == cell.paths) return;
  paths_ = cell.paths;
  cell_name_ = cell.name;
  names_.reset();
  node_of_path_.clear();
  if (paths_ == nullptr) return;
  for (std::size_t i = 0; i < paths_->size(); ++i) node_of_path_.emplace((*paths_)[i], static_cast<std::int32_t>(i));
}

void PairMarks::find_nodes(const BodyNames& names) {
  if (names == names_) return;
  names_ = names;
  node_of_body_.clear();
  if (names_ == nullptr) return;
  for (const std::string& name : *names_) {
    const auto at = node_of_path_.find(name);
    const std::int32_t own = name == cell_name_ ? 0 : -1;
    node_of_body_.push_back(at == node_of_path_.end() ? own : at->second);
  }
}

void PairMarks::mark(std::uint32_t body, const Eigen::Vector3d& point_m, Mark mark, const Bodies& bodies,
                     Scene& scene) const {
  if (body >= node_of_body_.size() || node_of_body_[body] < 0) return;
  const auto node = static_cast<std::size_t>(node_of_body_[body]);
  if (node >= drawn_of_node_.size()) return;
  const auto [first, count] = drawn_of_node_[node];
  const auto distance = [&](std::size_t i) {
    const Box& box = bodies.bounds(i);
    const Eigen::Vector3d p_G = scene.bodies[i].X_WG.inverse() * point_m;
    return box.isEmpty() || !p_G.allFinite() ? 0.0 : box.exteriorDistance(p_G);
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < first + count; ++i) nearest = std::min(nearest, distance(i));
  for (std::size_t i = first; i < first + count; ++i) {
    if (distance(i) <= nearest + kSameDistance) scene.bodies[i].mark = mark;
  }
}

void PairMarks::mark_touching(const TouchingPair& pair, const Bodies& bodies, Scene& scene) const {
  const auto mark_at = [&](const Eigen::Vector3d& point_m) {
    mark(pair.a, point_m, Mark::touching, bodies, scene);
    mark(pair.b, point_m, Mark::touching, bodies, scene);
  };
  mark_at(pair.point_m);
  for (const TouchingPoint& point : pair.points) mark_at(point.point_m);
}

void PairMarks::draw(const ProximityState& proximity, Timestamp now, const Bodies& bodies, Scene& scene) {
  if (proximity.touching.empty() && proximity.near.empty()) return;
  find_nodes(proximity.names);
  const std::string age = age_words(proximity, now);
  draw_near(proximity, age, bodies, scene);
  draw_touching(proximity, age, bodies, scene);
}

void PairMarks::draw_near(const ProximityState& proximity, std::string_view age, const Bodies& bodies,
                          Scene& scene) const {
  std::size_t drawn = 0;
  for (const NearPair& pair : proximity.near) {
    if (!pair.within_warning || !(pair.distance_m > 0.0)) continue;
    if (drawn == kPairs) break;
    mark(pair.a, pair.point_a_m, Mark::near, bodies, scene);
    mark(pair.b, pair.point_b_m, Mark::near, bodies, scene);
    scene.lines.push_back(line(pair.point_a_m, pair.point_b_m, palette::kNear, pair.doubtful));
    if (drawn++ >= kLabels) continue;
    scene.labels.push_back(
        {0.5 * (pair.point_a_m + pair.point_b_m),
         fmt::format("{}{}{}", pair.doubtful ? "at least " : "", distance_text(pair.distance_m), age), Mark::near});
  }
}

void PairMarks::draw_touching(const ProximityState& proximity, std::string_view age, const Bodies& bodies,
                              Scene& scene) const {
  std::size_t drawn = 0;
  for (const TouchingPair& pair : proximity.touching) {
    if (drawn == kPairs) break;
    mark_touching(pair, bodies, scene);
    const Eigen::Vector3d half = std::max(0.5 * pair.depth_m, kContactHalfLength) * pair.normal;
    scene.lines.push_back(line(pair.point_m - half, pair.point_m + half, palette::kTouching, pair.doubtful));
    if (drawn++ >= kLabels) continue;
    const std::string depth = pair.depth_m >= 0.0005 ? " " + distance_text(pair.depth_m) + " deep" : std::string();
    scene.labels.push_back(
        {pair.point_m, fmt::format("{}{}{}", pair.doubtful ? "may touch" : "touching", depth, age), Mark::touching});
  }
}

}  // namespace cellmirror::scene
