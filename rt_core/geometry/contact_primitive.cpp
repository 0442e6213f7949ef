// Contact of a mesh with a primitive.
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "rt_core/geometry/box_walk.hpp"
#include "rt_core/geometry/contact_surfaces.hpp"
#include "rt_core/geometry/inside.hpp"
#include "rt_core/geometry/proximity_mesh.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostSamples = 64;
constexpr std::size_t kMostTriangles = 512;

struct CoreSamples {
  std::array<Vector3d, kMostSamples> p;
  std::size_t count = 0;
  void add(const Vector3d& point) { p[count++] = point; }
};

// Points on the surface of a core; with a skin, of the line or point in its middle.
CoreSamples samples_of(const ConvexCore& core) {
  CoreSamples out;
  switch (core.kind) {
    case CoreKind::point:
      out.add(Vector3d::Zero());
      break;
    case CoreKind::segment:
      for (int i = -8; i <= 8; ++i) out.add(i / 8.0 * core.half);
      break;
    case CoreKind::box:
      for (int i = 0; i < 27; ++i) {
        const int row = i / 3 % 3;
        const int layer = i / 9;
        const Vector3d corner(i % 3 - 1, row - 1, layer - 1);
        if (i != 13) out.add(corner.cwiseProduct(core.half));
      }
      break;
    case CoreKind::cylinder:
      for (int i = 0; i < 20; ++i) {
        const double angle = 2 * std::numbers::pi * i / 20;
        for (const double level : {-1.0, 0.0, 1.0}) {
          out.add({core.half.x() * std::cos(angle), core.half.x() * std::sin(angle), level * core.half.z()});
        }
      }
      out.add({0, 0, core.half.z()});
      out.add({0, 0, -core.half.z()});
      break;
    case CoreKind::triangle:
      for (const Vector3d& corner : core.corners) out.add(corner);
      break;
  }
  return out;
}

// How deep the primitive's skin around a sample lies in a closed mesh, or a mesh's surface in that skin.
void add_sample(const MeshTree& mesh, const Vector3d& p, double skin, ProximityHint& hint,
                std::vector<ContactPoint>& points) {
  const bool inside = contains(mesh, p);
  if (!inside && !(skin > 0)) return;
  Pose X = Pose::Identity();
  X.translation() = p;
  const double up_to = inside ? std::numeric_limits<double>::infinity() : skin;
  const Separation nearest = mesh_primitive_separation(mesh, ConvexCore{}, X, up_to, 0.0, hint);
  if (nearest.beyond || !(nearest.points.distance > 0)) return;
  const Vector3d outwards = (inside ? 1.0 : -1.0) * (nearest.points.p_a - p) / nearest.points.distance;
  ContactPoint point;
  point.depth = inside ? skin + nearest.points.distance : skin - nearest.points.distance;
  point.normal = outwards;
  point.p_W = p + (0.5 * point.depth - skin) * outwards;
  points.push_back(point);
}

// How deep a point of the mesh lies in the primitive.
void add_point(const Vector3d& p, const ConvexCore& primitive, const Pose& X_MP, std::vector<ContactPoint>& points) {
  Pose X = Pose::Identity();
  X.translation() = p;
  const ConvexCore core;
  if (convex_distance(core, X, primitive, X_MP, kTouchDistance).points.distance >= kTouchDistance) return;
  const Penetration in = convex_penetration(core, X, primitive, X_MP);
  points.push_back({p, in.normal, in.depth});
}

// Corners, points of the edges and the point that is nearest to the primitive's middle.
void add_triangle(const Triangle& t, const Vector3d& middle, const ConvexCore& primitive, const Pose& X_MP,
                  std::vector<ContactPoint>& points) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d along = t[(i + 1) % 3] - t[i];
    for (const double part : {0.0, 0.25, 0.5, 0.75}) add_point(t[i] + part * along, primitive, X_MP, points);
    add_point(closest_on_segment(middle, {t[i], t[(i + 1) % 3]}), primitive, X_MP, points);
  }
  add_point(closest_on_triangle(middle, t), primitive, X_MP, points);
}

}  // namespace

void mesh_primitive_contact(const MeshTree& mesh, const ConvexCore& primitive, const Pose& X_MP,
                            std::vector<ContactPoint>& points) {
  ProximityHint hint;
  const CoreSamples samples = samples_of(primitive);
  for (std::size_t i = 0; i < samples.count; ++i) add_sample(mesh, X_MP * samples.p[i], primitive.skin, hint, points);
  BoxWalk walk(mesh.wide(), X_MP, primitive.half, primitive.skin);
  walk.set_limit(kTouchDistance);
  ConvexCore triangle;
  triangle.kind = CoreKind::triangle;
  std::uint32_t i = 0;
  for (std::size_t n = 0; n < kMostTriangles && walk.next(i); ++n) {
    triangle.corners = mesh.triangles()[i];
    const ConvexDistance apart = convex_distance(triangle, Pose::Identity(), primitive, X_MP, kTouchDistance);
    if (!(apart.points.distance < kTouchDistance)) continue;
    points.push_back({apart.points.p_a, Vector3d::Zero(), 0.0});
    add_triangle(triangle.corners, X_MP.translation(), primitive, X_MP, points);
  }
}

}  // namespace cellmirror::geometry
