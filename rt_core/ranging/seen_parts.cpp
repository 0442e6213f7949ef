#include "rt_core/ranging/seen_parts.hpp"

#include <utility>

#include "rt_core/geometry/proximity.hpp"

namespace cellmirror::ranging {

namespace {

// What moves with a node without a joint between them, named by its topmost node, and the node's pose in that.
struct RigidPlace {
  std::int32_t top = 0;
  Pose X_TN = Pose::Identity();
};

RigidPlace rigid_place(const CompiledCell& cell, std::int32_t node) {
  RigidPlace out{node, Pose::Identity()};
  for (;;) {
    const auto at = static_cast<std::size_t>(out.top);
    if (cell.joint_of[at] >= 0 || cell.parent[at] < 0) return out;
    out.X_TN = cell.X_PF[at] * out.X_TN;
    out.top = cell.parent[at];
  }
}

}  // namespace

void SeenParts::add(const CompiledGeometry& from, geometry::SolidLibrary& solids) {
  const Geometry& geometry = *from.geometry;
  const auto add_solid = [&](std::shared_ptr<const geometry::Solid> solid) {
    parts_.push_back({std::move(solid), from.node, geometry.X_NG});
  };
  if (geometry.shape != Shape::mesh) return add_solid(solids.primitive(geometry.shape, geometry.size));
  if (geometry.mesh && !geometry.mesh->triangles.empty()) return add_solid(solids.mesh(geometry.mesh));
  for (const auto& piece : geometry.pieces) {
    if (piece && !piece->triangles.empty()) add_solid(solids.mesh(piece));
  }
  if (geometry.pieces.empty()) unknown_shape_ = true;
}

void SeenParts::adopt(const CompiledCell& cell, geometry::SolidLibrary& solids) {
  const std::vector<SeenPart> before = std::move(parts_);  // keeps the solids alive that stay
  parts_.clear();
  unknown_shape_ = false;
  for (const CompiledGeometry& geometry : cell.geometry) {
    if (geometry.geometry && geometry.geometry->collides) add(geometry, solids);
  }
  X_WG_.assign(parts_.size(), Pose::Identity());
  centre_.assign(parts_.size(), Eigen::Vector3d::Zero());
  unknown_place_ = false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const auto node = static_cast<std::size_t>(parts_[i].node);
    if (node < cell.fixed_count) place(i, cell.X_WN_fixed[node]);
  }
  unknown_fixed_place_ = unknown_place_;
}

void SeenParts::place(const CompiledCell& cell, const CellPoses& poses) {
  unknown_place_ = unknown_fixed_place_;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const auto node = static_cast<std::size_t>(parts_[i].node);
    if (node >= cell.fixed_count) place(i, poses.X_WN[node]);
  }
}

void SeenParts::place(std::size_t i, const Pose& X_WN) {
  const SeenPart& part = parts_[i];
  X_WG_[i] = X_WN * part.X_NG;
  centre_[i] = X_WG_[i] * part.solid->centre;
  if (!X_WG_[i].matrix().allFinite()) unknown_place_ = true;
}

std::vector<std::uint8_t> housing_of(const CompiledCell& cell, std::int32_t sensor_node, const SeenParts& parts) {
  constexpr double kTouching = 1e-3;  // m
  const geometry::Solid apex = geometry::make_primitive(Shape::sphere, Eigen::Vector3d(kTouching, 0.0, 0.0));
  const RigidPlace sensor = rigid_place(cell, sensor_node);
  std::vector<std::uint8_t> out(parts.size(), 0);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const SeenPart& part = parts.part(i);
    const RigidPlace place = rigid_place(cell, part.node);
    if (place.top != sensor.top) continue;
    const Pose X_TG = place.X_TN * part.X_NG;
    const Eigen::Vector3d between = X_TG * part.solid->centre - sensor.X_TN.translation();
    if (between.norm() > part.solid->radius + 2.0 * kTouching) continue;
    geometry::ProximityHint hint;
    out[i] = geometry::touch(apex, sensor.X_TN, *part.solid, X_TG, hint) ? 1 : 0;
  }
  return out;
}

}  // namespace cellmirror::ranging
