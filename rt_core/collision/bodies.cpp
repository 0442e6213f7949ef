#include "rt_core/collision/bodies.hpp"

#include <fmt/core.h>

#include <map>
#include <utility>

#include "rt_core/cell/short_names.hpp"

namespace cellmirror::collision {

namespace {

bool usable(const std::shared_ptr<const geometry::TriangleMesh>& mesh) { return mesh && !mesh->triangles.empty(); }

// The shapes that represent `geometry`; empty if there is none to test.
std::vector<BodyPart> parts_of(const Geometry& geometry, geometry::SolidLibrary& solids) {
  std::vector<BodyPart> parts;
  if (geometry.shape != Shape::mesh) {
    parts.push_back({solids.primitive(geometry.shape, geometry.size), geometry.X_NG});
    return parts;
  }
  if (geometry.collide_as != CollideAs::exact) {
    for (const auto& piece : geometry.pieces) {
      if (usable(piece)) parts.push_back({solids.mesh(piece), geometry.X_NG});
    }
  }
  if (parts.empty() && usable(geometry.mesh)) parts.push_back({solids.mesh(geometry.mesh), geometry.X_NG});
  return parts;
}

std::string name_of(const Geometry& geometry) {
  if (!geometry.name.empty()) return geometry.name;
  return geometry.mesh_file.empty() ? "a mesh" : geometry.mesh_file;
}

}  // namespace

CollectedBodies collect_bodies(const CompiledCell& cell, geometry::SolidLibrary& solids) {
  CollectedBodies found;
  std::map<std::int32_t, Body> by_node;
  for (const CompiledGeometry& item : cell.geometry) {
    if (!item.geometry->collides) continue;
    const auto parts = parts_of(*item.geometry, solids);
    if (parts.empty()) {
      found.doubts.push_back(fmt::format("{}: {} cannot be tested for collision, because its triangles are missing",
                                         body_name(cell, item.node), name_of(*item.geometry)));
      continue;
    }
    Body& body = by_node[item.node];
    body.node = item.node;
    for (const BodyPart& part : parts) {
      if (part.solid->tree) found.triangles += part.solid->tree->triangles().size();
      body.parts.push_back(part);
    }
  }
  for (auto& [node, body] : by_node) found.bodies.push_back(std::move(body));
  return found;
}

}  // namespace cellmirror::collision
