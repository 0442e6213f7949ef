#include "rt_core/scene/bodies.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/scene/draw_rules.hpp"

namespace cellmirror::scene {

namespace {

SceneBody body_of(const CompiledGeometry& part, DrawMode mode) {
  const Geometry& geometry = *part.geometry;
  SceneBody body;
  body.object = static_cast<std::uint32_t>(part.node) + 1;
  body.shape = geometry.shape;
  body.size = geometry.size;
  body.mesh = geometry.mesh;
  body.look = geometry.look;
  body.rgba = geometry.rgba;
  body.mode = mode;
  // Wireframes are see-through; so are transparent colours.
  body.casts_shadow = mode != DrawMode::wireframe && geometry.rgba[3] > 0.5F;
  return body;
}

// A box, lying along the axes of the world, at least eight times as wide as high, that is drawn solid.
bool is_level_slab(const SceneBody& body) {
  constexpr double kAlong = 1.0 - 1e-9;
  constexpr double kWide = 8.0;
  if (body.shape != Shape::box || !body.casts_shadow || body.mode == DrawMode::transparent) return false;
  const Eigen::Matrix3d R = body.X_WG.linear().cwiseAbs();
  if (!(R.colwise().maxCoeff().minCoeff() > kAlong)) return false;
  const Eigen::Vector3d size_W = R * body.size;
  return std::min(size_W.x(), size_W.y()) > kWide * size_W.z();
}

bool equal(const DrawRule& a, const DrawRule& b) {
  return a.branch == b.branch && a.mode == b.mode && a.path == b.path;
}

}  // namespace

bool Bodies::same(const CompiledCell& cell, std::span<const DrawRule> rules) const {
  return version_.cell == &cell && version_.revision == cell.revision &&
         std::ranges::equal(version_.rules, rules, equal);
}

bool Bodies::update(const CompiledCell& cell, const CellPoses& poses, std::span<const DrawRule> rules) {
  if (same(cell, rules)) return false;
  version_ = {&cell, cell.revision, {rules.begin(), rules.end()}};
  bodies_.clear();
  nodes_.clear();
  X_NG_.clear();
  boxes_.clear();
  fixed_.setEmpty();
  first_moving_ = 0;
  const std::vector<DrawMode> modes = draw_modes(cell, rules);
  for (std::size_t i = 0; i < cell.geometry.size(); ++i) {
    const CompiledGeometry& part = cell.geometry[i];
    const bool empty_mesh = part.geometry->shape == Shape::mesh && part.geometry->mesh == nullptr;
    if (!part.geometry->drawn || empty_mesh) continue;
    SceneBody body = body_of(part, modes[i]);
    const auto node = static_cast<std::size_t>(part.node);
    body.X_WG = poses.X_WN[node] * part.geometry->X_NG;
    boxes_.push_back(bounds_.of(*part.geometry));
    if (node < cell.fixed_count) {
      fixed_.extend(moved(body.X_WG, boxes_.back()));
      first_moving_ = bodies_.size() + 1;
    }
    bodies_.push_back(std::move(body));
    nodes_.push_back(part.node);
    X_NG_.push_back(part.geometry->X_NG);
  }
  bounds_.forget_unused();
  reach_ = fixed_;
  for (std::size_t i = first_moving_; i < bodies_.size(); ++i) reach_.extend(moved(bodies_[i].X_WG, boxes_[i]));
  find_floor();
  find_slabs();
  return true;
}

void Bodies::find_floor() {
  const Box& stands = fixed_.isEmpty() ? reach_ : fixed_;
  floor_z_ = 0.0;
  if (stands.isEmpty()) return;
  const double low = stands.min().z();
  const bool far_above = low > reach_.sizes().norm();
  if (low < 0.0 || far_above) floor_z_ = low;
}

void Bodies::find_slabs() {
  constexpr double kSameLevel = 0.002;  // m
  slabs_.clear();
  for (std::size_t i = 0; i < first_moving_; ++i) {
    if (!is_level_slab(bodies_[i])) continue;
    const Box box = moved(bodies_[i].X_WG, boxes_[i]);
    if (box.min().z() > floor_z_ + kSameLevel) continue;
    slabs_.push_back({box.max().z(), box.min().head<2>(), box.max().head<2>()});
    bodies_[i].casts_shadow = false;
  }
  leave_paint_without_shadow();
}

void Bodies::leave_paint_without_shadow() {
  constexpr double kThickness = 0.003;  // m
  for (std::size_t i = 0; i < first_moving_; ++i) {
    const Box box = moved(bodies_[i].X_WG, boxes_[i]);
    if (box.sizes().z() > kThickness) continue;
    for (const ShadowCatcher& slab : slabs_) {
      if (std::abs(box.min().z() - slab.z_m) < kThickness) bodies_[i].casts_shadow = false;
    }
  }
}

void Bodies::place(const CellPoses& poses, std::vector<SceneBody>& bodies) {
  for (std::size_t i = first_moving_; i < bodies_.size(); ++i) {
    SceneBody& body = bodies_[i];
    body.X_WG = poses.X_WN[static_cast<std::size_t>(nodes_[i])] * X_NG_[i];
    reach_.extend(moved(body.X_WG, boxes_[i]));
  }
  bodies.assign(bodies_.begin(), bodies_.end());
}

}  // namespace cellmirror::scene
