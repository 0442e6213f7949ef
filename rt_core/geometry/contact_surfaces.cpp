#include "rt_core/geometry/contact_surfaces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "rt_core/geometry/inside.hpp"
#include "rt_core/geometry/pair_walk.hpp"
#include "rt_core/geometry/proximity_mesh.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where an edge of one mesh goes through the other's surface.
struct Piercing {
  std::uint64_t edge = 0;  // triangle * 3 + corner
  double along = 0;        // m from that corner
  Vector3d p;
};

Triangle moved(const Triangle& t, const Pose& X) { return {X * t[0], X * t[1], X * t[2]}; }

// Working data of one contact; memory is kept between queries.
struct Work {
  EvenSample<ContactPoint> crossings{kMostContactSamples};
  EvenSample<Vector3d> of_a{kMostContactSamples};
  EvenSample<Vector3d> of_b{kMostContactSamples};
  std::vector<Piercing> edges_of_a;
  std::vector<Piercing> edges_of_b;

  void clear() {
    crossings.clear();
    of_a.clear();
    of_b.clear();
    edges_of_a.clear();
    edges_of_b.clear();
  }
};

Work& work() {
  thread_local Work memory;
  memory.clear();
  return memory;
}

void add_piercings(const Triangle& edges, std::uint32_t triangle, const Triangle& face, std::vector<Piercing>& out) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Vector3d& from = edges[k];
    const Vector3d& to = edges[(k + 1) % 3];
    const ClosestPoints points = segment_triangle({from, to}, face);
    if (points.distance < kTouchDistance) {
      out.push_back({std::uint64_t{triangle} * 3 + k, (points.p_a - from).norm(), points.p_a});
    }
  }
}

// The middles between neighbouring piercings of one edge: bars that cross have no corner in each other, but these.
void add_middles(std::vector<Piercing>& piercings, EvenSample<Vector3d>& out) {
  std::sort(piercings.begin(), piercings.end(), [](const Piercing& a, const Piercing& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.along < b.along;
  });
  for (std::size_t i = 0; i + 1 < piercings.size(); ++i) {
    if (piercings[i].edge != piercings[i + 1].edge) continue;
    if (piercings[i + 1].along - piercings[i].along < kTouchDistance) continue;
    out.offer(0.5 * (piercings[i].p + piercings[i + 1].p));
  }
}

void look_at_crossings(const MeshTree& a, const MeshTree& b, const Pose& X_AB, Work& w) {
  constexpr std::size_t kMostPierced = 1024;
  PairWalk walk(a.wide(), b.wide(), X_AB);
  walk.set_limit(kTouchDistance);
  std::uint32_t i = 0;
  std::uint32_t k = 0;
  for (std::size_t n = 0; n < kMostContactPairs && walk.next(i, k); ++n) {
    const Triangle& t = a.triangles()[i];
    const Triangle in_a = moved(b.triangles()[k], X_AB);
    const ClosestPoints points = triangle_triangle(t, in_a, kTouchDistance);
    if (!(points.distance < kTouchDistance)) continue;
    Segment common{points.p_a, points.p_a};
    if (!triangles_intersect(t, in_a, common)) common = {points.p_a, points.p_a};
    ContactPoint crossing;
    crossing.p_W = 0.5 * (common.from + common.to);
    crossing.normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    w.crossings.offer(crossing);
    if (w.edges_of_a.size() < kMostPierced) add_piercings(t, i, in_a, w.edges_of_a);
    if (w.edges_of_b.size() < kMostPierced) add_piercings(in_a, k, t, w.edges_of_b);
  }
  add_middles(w.edges_of_a, w.of_a);
  add_middles(w.edges_of_b, w.of_b);
}

// Corners of `tree` within a box about the origin of frame B, in the frame of the tree.
void add_corners_within(const MeshTree& tree, const Pose& X_BT, const Vector3d& centre, const Vector3d& half,
                        EvenSample<Vector3d>& out) {
  const Eigen::Matrix3d absolute = X_BT.linear().cwiseAbs();
  std::array<std::uint32_t, MeshTree::kMaxDepth + 1> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const MeshTree::Node& node = tree.nodes()[index];
    const Vector3d middle = X_BT * (0.5 * (node.lower + node.upper)) - centre;
    const Vector3d reach = absolute * (0.5 * (node.upper - node.lower)) + half;
    if ((middle.cwiseAbs().array() > reach.array()).any()) continue;
    if (!node.leaf()) {
      stack[size++] = node.right;
      stack[size++] = index + 1;
      continue;
    }
    for (std::uint32_t i = node.right; i < node.right + node.count; ++i) {
      for (const Vector3d& p : tree.triangles()[i]) {
        if (((X_BT * p - centre).cwiseAbs().array() <= half.array()).all()) out.offer(p);
      }
    }
  }
}

// The nearest point of a surface; false where the mesh has none (which cannot be).
bool nearest_of(const MeshTree& mesh, const Vector3d& p, ProximityHint& hint, ClosestPoints& out) {
  const ConvexCore point;
  Pose X = Pose::Identity();
  X.translation() = p;
  const Separation found = mesh_primitive_separation(mesh, point, X, kInfinity, 0.0, hint);
  out = found.points;
  return !found.beyond;
}

// Points of one body (in the mesh's frame) that lie in a closed mesh. `sign`: 1 where the mesh is the first body.
void add_depths(const MeshTree& mesh, const std::vector<Vector3d>& samples, const Pose& X_OutMesh, double sign,
                std::vector<ContactPoint>& points) {
  if (!mesh.mesh().closed) return;
  ProximityHint hint;
  ClosestPoints nearest;
  for (const Vector3d& p : samples) {
    if (!contains(mesh, p) || !nearest_of(mesh, p, hint, nearest)) continue;
    if (!(nearest.distance > 0)) continue;
    ContactPoint point;
    point.depth = nearest.distance;
    point.normal = X_OutMesh.linear() * (sign * (nearest.p_a - p) / nearest.distance);
    point.p_W = X_OutMesh * (0.5 * (p + nearest.p_a));
    points.push_back(point);
  }
}

}  // namespace

void mesh_mesh_contact(const MeshTree& a, const MeshTree& b, const Pose& X_AB, std::vector<ContactPoint>& points) {
  Work& w = work();
  look_at_crossings(a, b, X_AB, w);
  const MeshTree::Node& box_a = a.nodes()[0];
  const MeshTree::Node& box_b = b.nodes()[0];
  const Pose X_BA = X_AB.inverse(Eigen::Isometry);
  if (b.mesh().closed) {
    add_corners_within(a, X_BA, 0.5 * (box_b.lower + box_b.upper), 0.5 * (box_b.upper - box_b.lower), w.of_a);
    thread_local std::vector<Vector3d> in_b;
    in_b.clear();
    for (const Vector3d& p : w.of_a.kept()) in_b.emplace_back(X_BA * p);
    add_depths(b, in_b, X_AB, -1.0, points);
  }
  if (a.mesh().closed) {
    thread_local EvenSample<Vector3d> in_a(kMostContactSamples);
    in_a.clear();
    for (const Vector3d& p : w.of_b.kept()) in_a.offer(p);
    w.of_b.clear();
    add_corners_within(b, X_AB, 0.5 * (box_a.lower + box_a.upper), 0.5 * (box_a.upper - box_a.lower), w.of_b);
    for (const Vector3d& p : w.of_b.kept()) in_a.offer(X_AB * p);
    add_depths(a, in_a.kept(), Pose::Identity(), 1.0, points);
  }
  points.insert(points.end(), w.crossings.kept().begin(), w.crossings.kept().end());
}

}  // namespace cellmirror::geometry
