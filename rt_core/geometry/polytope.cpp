#include "rt_core/geometry/polytope.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostToLookAt = 256;  // triangles: every corner is compared with every face
constexpr double kFlat = 1e-9;              // sines and parts of the size that count as zero
constexpr int kPrismSides = 64;

double size_of(const TriangleMesh& mesh) {
  Vector3d lower = mesh.vertices[mesh.triangles[0][0]];
  Vector3d upper = lower;
  for (const TriangleIndices& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      lower = lower.cwiseMin(mesh.vertices[v]);
      upper = upper.cwiseMax(mesh.vertices[v]);
    }
  }
  return (upper - lower).norm();
}

std::vector<Polytope::Face> faces_of(const TriangleMesh& mesh) {
  std::vector<Polytope::Face> faces;
  for (const TriangleIndices& t : mesh.triangles) {
    const Vector3d& p = mesh.vertices[t[0]];
    const Vector3d n = (mesh.vertices[t[1]] - p).cross(mesh.vertices[t[2]] - p).normalized();
    faces.push_back({n, n.dot(p)});
  }
  return faces;
}

bool behind_all_faces(const TriangleMesh& mesh, const std::vector<Polytope::Face>& faces, double tolerance) {
  for (const Polytope::Face& face : faces) {
    for (const Vector3d& p : mesh.vertices) {
      if (!(face.normal.dot(p) <= face.offset + tolerance)) return false;
    }
  }
  return true;
}

void add_edge(Polytope& polytope, const Vector3d& from, const Vector3d& to, const Vector3d& one,
              const Vector3d& other) {
  Polytope::Edge edge;
  edge.point = from;
  edge.direction = (to - from).normalized();
  edge.from_one = other - other.dot(one) * one;
  edge.from_other = one - one.dot(other) * other;
  polytope.edges.push_back(edge);
}

struct HalfEdge {
  std::array<std::uint32_t, 2> ends;  // the lower index first
  std::uint32_t triangle = 0;
};

// An edge between triangles of one plane is none of the polyhedron.
void add_edges(const TriangleMesh& mesh, const std::vector<Polytope::Face>& faces, Polytope& polytope) {
  std::vector<HalfEdge> halves;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[i][k];
      const std::uint32_t b = mesh.triangles[i][(k + 1) % 3];
      halves.push_back({{std::min(a, b), std::max(a, b)}, i});
    }
  }
  std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) { return a.ends < b.ends; });
  for (std::size_t i = 0; i + 1 < halves.size(); ++i) {
    if (halves[i].ends != halves[i + 1].ends) continue;
    const Vector3d& one = faces[halves[i].triangle].normal;
    const Vector3d& other = faces[halves[i + 1].triangle].normal;
    if (one.cross(other).norm() < kFlat) continue;
    add_edge(polytope, mesh.vertices[halves[i].ends[0]], mesh.vertices[halves[i].ends[1]], one, other);
  }
}

void keep_different(std::vector<Polytope::Face>& faces, double tolerance) {
  std::vector<Polytope::Face> kept;
  for (const Polytope::Face& face : faces) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Polytope::Face& other) {
      return (face.normal - other.normal).norm() < kFlat && std::abs(face.offset - other.offset) < tolerance;
    });
    if (!known) kept.push_back(face);
  }
  faces = std::move(kept);
}

void add_box(const Vector3d& half, Polytope& out) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double s : {-1.0, 1.0}) {
      const Vector3d normal = s * Vector3d::Unit(axis);
      out.faces.push_back({normal, half[axis]});
      for (const double t : {-1.0, 1.0}) {
        Vector3d corner = half;
        corner[u] *= s;
        corner[v] *= t;
        add_edge(out, -half[axis] * Vector3d::Unit(axis) + corner - corner[axis] * Vector3d::Unit(axis), corner,
                 s * Vector3d::Unit(u), t * Vector3d::Unit(v));
        if (axis != 0) continue;
        out.corners.push_back(corner);
        corner[axis] = -corner[axis];
        out.corners.push_back(corner);
      }
    }
  }
}

void add_prism(double radius, double half_length, Polytope& out) {
  const double step = 2 * std::numbers::pi / kPrismSides;
  const auto around = [&](double angle) { return Vector3d(std::cos(angle), std::sin(angle), 0); };
  const Vector3d up(0, 0, half_length);
  for (const double s : {-1.0, 1.0}) out.faces.push_back({s * Vector3d::UnitZ(), half_length});
  for (int i = 0; i < kPrismSides; ++i) {
    const Vector3d normal = around(i * step);
    const Vector3d next_normal = around((i + 1) * step);
    const double corner_radius = radius / std::cos(step / 2);
    const Vector3d corner = corner_radius * around((i + 0.5) * step);
    const Vector3d last_corner = corner_radius * around((i - 0.5) * step);
    out.faces.push_back({normal, radius});
    add_edge(out, corner - up, corner + up, normal, next_normal);
    for (const double s : {-1.0, 1.0}) {
      out.corners.push_back(corner + s * up);
      add_edge(out, last_corner + s * up, corner + s * up, normal, s * Vector3d::UnitZ());
    }
  }
}

double reach(const Polytope& polytope, const Vector3d& n) {
  double best = -std::numeric_limits<double>::infinity();
  for (const Vector3d& p : polytope.corners) best = std::max(best, n.dot(p));
  return best;
}

bool supports(const Polytope::Edge& edge, const Vector3d& n) {
  return edge.from_one.dot(n) >= -kFlat && edge.from_other.dot(n) >= -kFlat;
}

void across_edges(const Polytope& a, const Polytope& b, PolytopeOverlap& best) {
  for (const Polytope::Edge& ea : a.edges) {
    for (const Polytope::Edge& eb : b.edges) {
      const Vector3d cross = ea.direction.cross(eb.direction);
      const double length = cross.norm();
      if (length < kFlat) continue;
      for (const double sign : {1.0, -1.0}) {
        const Vector3d n = (sign / length) * cross;
        if (!supports(ea, n) || !supports(eb, -n)) continue;
        const double depth = n.dot(ea.point - eb.point);
        if (depth < best.depth) best = {depth, n};
      }
    }
  }
}

}  // namespace

std::optional<Polytope> polytope_of(const TriangleMesh& mesh) {
  if (!mesh.closed || mesh.triangles.size() > kMostPolytopeTriangles) return std::nullopt;
  if (!mesh.convex && mesh.triangles.size() > kMostToLookAt) return std::nullopt;
  const double tolerance = kFlat * size_of(mesh);
  std::vector<Polytope::Face> faces = faces_of(mesh);
  if (!mesh.convex && !behind_all_faces(mesh, faces, tolerance)) return std::nullopt;
  Polytope out;
  out.corners = mesh.vertices;
  add_edges(mesh, faces, out);
  keep_different(faces, tolerance);
  out.faces = std::move(faces);
  return out;
}

void polytope_of(const ConvexCore& core, Polytope& out) {
  out.corners.clear();
  out.faces.clear();
  out.edges.clear();
  switch (core.kind) {
    case CoreKind::point:
      out.corners.emplace_back(Vector3d::Zero());
      break;
    case CoreKind::segment:
      out.corners.emplace_back(-core.half);
      out.corners.emplace_back(core.half);
      out.edges.push_back({core.half, Vector3d::UnitZ(), Vector3d::Zero(), Vector3d::Zero()});
      break;
    case CoreKind::box:
      add_box(core.half, out);
      break;
    case CoreKind::cylinder:
      add_prism(core.half.x(), core.half.z(), out);
      break;
    case CoreKind::triangle:
      out.corners.assign(core.corners.begin(), core.corners.end());
      break;
  }
}

void move_polytope(const Polytope& from, const Pose& X, Polytope& out) {
  out.corners.clear();
  out.faces.clear();
  out.edges.clear();
  const Eigen::Matrix3d& R = X.linear();
  for (const Vector3d& p : from.corners) out.corners.emplace_back(X * p);
  for (const Polytope::Face& face : from.faces) {
    const Vector3d normal = R * face.normal;
    out.faces.push_back({normal, face.offset + normal.dot(X.translation())});
  }
  for (const Polytope::Edge& edge : from.edges) {
    out.edges.push_back({X * edge.point, R * edge.direction, R * edge.from_one, R * edge.from_other});
  }
}

PolytopeOverlap least_overlap(const Polytope& a, const Polytope& b) noexcept {
  PolytopeOverlap best;
  best.depth = std::numeric_limits<double>::infinity();
  for (const Polytope::Face& face : a.faces) {
    const double depth = face.offset + reach(b, -face.normal);
    if (depth < best.depth) best = {depth, face.normal};
  }
  for (const Polytope::Face& face : b.faces) {
    const double depth = face.offset + reach(a, -face.normal);
    if (depth < best.depth) best = {depth, -face.normal};
  }
  across_edges(a, b, best);
  return best;
}

}  // namespace cellmirror::geometry
