#include "rt_core/tissue/contact/rigid_distance.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/geometry/inside.hpp"
#include "rt_core/geometry/proximity_mesh.hpp"

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

// Away from a core (a point, a segment or a box) that has a skin.
RigidDistance from_core(const Vector3d& p, const Vector3d& on_core, double skin) {
  RigidDistance out;
  const Vector3d away = p - on_core;
  const double length = away.norm();
  out.normal = length > 1e-12 ? Vector3d(away / length) : Vector3d::UnitX();
  out.nearest = on_core + skin * out.normal;
  out.distance = length - skin;
  out.known = true;
  return out;
}

RigidDistance from_box(const Vector3d& p, const Vector3d& half, double skin) {
  const Vector3d inside = p.cwiseMax(-half).cwiseMin(half);
  if ((p - inside).squaredNorm() > 0) return from_core(p, inside, skin);
  Eigen::Index axis = 0;
  const double depth = (half - p.cwiseAbs()).minCoeff(&axis);
  RigidDistance out;
  out.normal.setZero();
  out.normal[axis] = p[axis] < 0 ? -1.0 : 1.0;
  out.distance = -depth - skin;
  out.nearest = p - out.distance * out.normal;
  out.known = true;
  return out;
}

RigidDistance from_cylinder(const Vector3d& p, double radius, double half_length) {
  const double rho = std::hypot(p.x(), p.y());
  const Vector3d out_of_axis = rho > 1e-12 ? Vector3d(p.x() / rho, p.y() / rho, 0) : Vector3d::UnitX();
  const double radial = rho - radius;
  const double axial = std::abs(p.z()) - half_length;
  const Vector3d up(0, 0, p.z() < 0 ? -1.0 : 1.0);
  if (radial > 0 && axial > 0) return from_core(p, radius * out_of_axis + half_length * up, 0);
  RigidDistance out;
  out.normal = radial > axial ? out_of_axis : up;
  out.distance = std::max(radial, axial);
  out.nearest = p - out.distance * out.normal;
  out.known = true;
  return out;
}

RigidDistance from_mesh(const geometry::MeshTree& tree, const Vector3d& p, double up_to,
                        geometry::ProximityHint& hint) {
  RigidDistance out;
  geometry::ConvexCore point;
  Pose X_MP = Pose::Identity();
  X_MP.translation() = p;
  const geometry::Separation found = geometry::mesh_primitive_separation(tree, point, X_MP, up_to, 0.0, hint);
  if (found.beyond || !(found.points.distance < up_to)) return out;
  const bool inside = tree.mesh().closed && geometry::contains(tree, p);
  out.nearest = found.points.p_a;
  out.distance = inside ? -found.points.distance : found.points.distance;
  const Vector3d away = p - out.nearest;
  if (away.norm() > 1e-7) {
    out.normal = (inside ? -away : away).normalized();
  } else {
    const geometry::Triangle& t = tree.triangles()[std::min<std::size_t>(hint.feature_a, tree.triangles().size() - 1)];
    out.normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  }
  out.known = out.normal.allFinite();
  return out;
}

}  // namespace

RigidDistance rigid_distance(const geometry::Solid& solid, const Vector3d& p, double up_to,
                             geometry::ProximityHint& hint) {
  if (!p.allFinite()) return {};
  if (solid.shape == Shape::mesh) return solid.tree ? from_mesh(*solid.tree, p, up_to, hint) : RigidDistance{};
  RigidDistance out;
  const geometry::ConvexCore& core = solid.core;
  switch (core.kind) {
    case geometry::CoreKind::point:
      out = from_core(p, Vector3d::Zero(), core.skin);
      break;
    case geometry::CoreKind::segment:
      out = from_core(p, Vector3d(0, 0, std::clamp(p.z(), -core.half.z(), core.half.z())), core.skin);
      break;
    case geometry::CoreKind::box:
      out = from_box(p, core.half, core.skin);
      break;
    case geometry::CoreKind::cylinder:
      out = from_cylinder(p, core.half.x() + core.skin, core.half.z() + core.skin);
      break;
    case geometry::CoreKind::triangle:
      return {};
  }
  out.known = out.distance < up_to;
  return out;
}

}  // namespace cellmirror::tissue
