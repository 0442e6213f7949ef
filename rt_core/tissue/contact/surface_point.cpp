#include "rt_core/tissue/contact/surface_point.hpp"

#include <algorithm>

namespace cellmirror::tissue {

using Eigen::Vector3d;

// Ericson, Real-Time Collision Detection, 3.4.
Vector3d barycentric(const Vector3d& p, const geometry::Triangle& t) {
  const Vector3d ab = t[1] - t[0];
  const Vector3d ac = t[2] - t[0];
  const Vector3d ap = p - t[0];
  const double d00 = ab.dot(ab);
  const double d01 = ab.dot(ac);
  const double d11 = ac.dot(ac);
  const double d20 = ap.dot(ab);
  const double d21 = ap.dot(ac);
  const double denominator = d00 * d11 - d01 * d01;
  if (!(denominator > 1e-30)) return {1, 0, 0};
  Vector3d share;
  share[1] = std::clamp((d11 * d20 - d01 * d21) / denominator, 0.0, 1.0);
  share[2] = std::clamp((d00 * d21 - d01 * d20) / denominator, 0.0, 1.0);
  share[0] = std::max(0.0, 1.0 - share[1] - share[2]);
  return share / share.sum();
}

SurfacePoint surface_point(const DeformableObject& object, std::uint32_t number, std::uint32_t triangle,
                           const Vector3d& share) {
  SurfacePoint point{
      .object = number, .corner = object.body->surface_triangles()[triangle], .embedded = {}, .share = share};
  for (std::size_t i = 0; i < 3; ++i) point.embedded[i] = object.body->surface_points()[point.corner[i]];
  return point;
}

bool attached(const DeformableObject& object, const SurfacePoint& point) {
  const auto points = object.body->surface_points();
  for (std::size_t i = 0; i < 3; ++i) {
    if (point.corner[i] >= points.size()) return false;
    const EmbeddedPoint& now = points[point.corner[i]];
    if (now.node != point.embedded[i].node || now.weight != point.embedded[i].weight) return false;
  }
  return true;
}

Vector3d position(const DeformableObject& object, const SurfacePoint& point) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = point.share[static_cast<int>(i)];
    if (share != 0) sum += share * object.body->position(point.embedded[i]);
  }
  return sum;
}

Vector3d velocity(const DeformableObject& object, const SurfacePoint& point) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = point.share[static_cast<int>(i)];
    if (share != 0) sum += share * object.body->velocity(point.embedded[i]);
  }
  return sum;
}

double burn(const DeformableObject& object, const SurfacePoint& point) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += point.share[static_cast<int>(i)] * object.body->burn(point.embedded[i]);
  return sum;
}

std::optional<SurfacePoint> nearest_surface_point(DeformableObject& object, std::uint32_t number, const Vector3d& p,
                                                  double reach) {
  std::vector<std::uint32_t> clusters;
  object.surface.near_segment(p, p, reach, clusters);
  double best = reach * reach;
  std::optional<SurfacePoint> found;
  for (const std::uint32_t cluster : clusters) {
    for (const std::uint32_t triangle : object.surface.triangles(object.surface.clusters()[cluster])) {
      const geometry::Triangle corners = object.surface.corners(*object.body, triangle);
      const Vector3d nearest = geometry::closest_on_triangle(p, corners);
      const double squared = (nearest - p).squaredNorm();
      if (!(squared < best)) continue;
      best = squared;
      found = surface_point(object, number, triangle, barycentric(nearest, corners));
    }
  }
  return found;
}

void attach_again(DeformableObject& object, SurfacePoint& point) {
  constexpr double kReach = 0.001;  // m
  if (attached(object, point)) return;
  if (const auto found = nearest_surface_point(object, point.object, position(object, point), kReach)) point = *found;
}

namespace {

// `share` of an embedded point's nodes. A node of an object that does not step now keeps its velocity.
void add_nodes(ConstraintSystem& system, const DeformableObject& object, std::uint32_t number,
               const EmbeddedPoint& point, double share) {
  const auto velocities = object.body->velocities();
  const auto inverse_masses = object.body->inverse_masses();
  for (std::size_t i = 0; i < 4; ++i) {
    if (point.weight[i] == 0) continue;
    const std::uint32_t node = point.node[i];
    system.add_term(system.node(number, node, velocities[node], object.steps_now ? inverse_masses[node] : 0.0),
                    share * static_cast<double>(point.weight[i]));
  }
}

}  // namespace

void add_terms(ConstraintSystem& system, const DeformableObject& object, const SurfacePoint& point, double sign) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = point.share[static_cast<int>(i)];
    if (share != 0) add_nodes(system, object, point.object, point.embedded[i], sign * share);
  }
}

void add_terms(ConstraintSystem& system, const DeformableObject& object, std::uint32_t number,
               const EmbeddedPoint& point, double sign) {
  add_nodes(system, object, number, point, sign);
}

}  // namespace cellmirror::tissue
