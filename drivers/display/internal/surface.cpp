#include "drivers/display/internal/surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace cellmirror::display {

namespace {

using geometry::TriangleIndices;
using geometry::TriangleMesh;

Eigen::Vector3f unit_or_up(const Eigen::Vector3d& direction) {
  const double length = direction.norm();
  if (!(length > 0)) return Eigen::Vector3f::UnitZ();
  return (direction / length).cast<float>();
}

// At the corner `c` of triangle `t`: faces count by their angle there, so that it does not matter into how many
// triangles a flat face has been cut.
double corner_angle(const TriangleMesh& mesh, const TriangleIndices& t, std::size_t c) {
  const Eigen::Vector3d& p = mesh.vertices[t[c]];
  const Eigen::Vector3d a = mesh.vertices[t[(c + 1) % 3]] - p;
  const Eigen::Vector3d b = mesh.vertices[t[(c + 2) % 3]] - p;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The corners at one vertex of the mesh, gathered into groups of faces that are smooth together; each group becomes a
// vertex of the surface.
class SmoothingGroups {
 public:
  explicit SmoothingGroups(Surface& surface) : surface_(surface) {}

  void begin() { sums_.clear(); }

  // The number of the surface's vertex that this corner gets.
  Corner add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, double angle) {
    static const double crease_cosine = std::cos(kCreaseAngle);
    std::size_t best = sums_.size();
    double best_cosine = crease_cosine;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const double cosine = sums_[i].normalized().dot(normal);
      if (cosine < best_cosine && !(sums_.size() == kMostGroups && best == sums_.size())) continue;
      best = i;
      best_cosine = cosine;
    }
    if (best == sums_.size()) {
      if (sums_.empty()) first_ = static_cast<Corner>(surface_.vertices.size());
      sums_.emplace_back(Eigen::Vector3d::Zero());
      surface_.vertices.push_back({position.cast<float>(), Eigen::Vector3f::UnitZ()});
    }
    sums_[best] += angle * normal;
    return first_ + static_cast<Corner>(best);
  }

  void end() {
    for (std::size_t i = 0; i < sums_.size(); ++i) surface_.vertices[first_ + i].normal = unit_or_up(sums_[i]);
  }

 private:
  static constexpr std::size_t kMostGroups = 32;  // a vertex of a hostile file may belong to a million faces
  Surface& surface_;
  std::vector<Eigen::Vector3d> sums_;
  Corner first_ = 0;
};

// The corners (3 * triangle + corner) at each vertex: those of vertex v are order[begin[v]] to order[begin[v + 1]].
struct CornersByVertex {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> order;
};

CornersByVertex corners_by_vertex(const TriangleMesh& mesh) {
  CornersByVertex table;
  table.begin.assign(mesh.vertices.size() + 1, 0);
  for (const TriangleIndices& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++table.begin[v + 1];
  }
  for (std::size_t v = 1; v < table.begin.size(); ++v) table.begin[v] += table.begin[v - 1];
  table.order.resize(3 * mesh.triangles.size());
  std::vector<std::uint32_t> next(table.begin.begin(), table.begin.end() - 1);
  for (std::size_t i = 0; i < table.order.size(); ++i) {
    table.order[next[mesh.triangles[i / 3][i % 3]]++] = static_cast<std::uint32_t>(i);
  }
  return table;
}

}  // namespace

std::vector<Eigen::Vector3f> face_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(mesh.triangles.size());
  for (const TriangleIndices& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[t[0]];
    normals.push_back(unit_or_up((mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a)));
  }
  return normals;
}

Surface smooth_surface(const TriangleMesh& mesh) {
  Surface surface;
  surface.corners.resize(3 * mesh.triangles.size());
  surface.vertices.reserve(mesh.vertices.size());
  const std::vector<Eigen::Vector3f> normals = face_normals(mesh);
  const CornersByVertex table = corners_by_vertex(mesh);
  SmoothingGroups groups(surface);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    groups.begin();
    for (std::uint32_t at = table.begin[v]; at < table.begin[v + 1]; ++at) {
      const std::uint32_t corner = table.order[at];
      const TriangleIndices& t = mesh.triangles[corner / 3];
      surface.corners[corner] =
          groups.add(mesh.vertices[v], normals[corner / 3].cast<double>(), corner_angle(mesh, t, corner % 3));
    }
    groups.end();
  }
  return surface;
}

Surface flat_surface(const TriangleMesh& mesh) {
  Surface surface;
  const std::vector<Eigen::Vector3f> normals = face_normals(mesh);
  surface.vertices.reserve(3 * mesh.triangles.size());
  surface.corners.reserve(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) {
      surface.corners.push_back(static_cast<Corner>(surface.vertices.size()));
      surface.vertices.push_back({mesh.vertices[v].cast<float>(), normals[i]});
    }
  }
  return surface;
}

std::vector<FeatureEdge> feature_edges(const TriangleMesh& mesh) {
  struct Use {
    std::uint32_t low, high, triangle;
  };
  std::vector<Use> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const TriangleIndices& t = mesh.triangles[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [low, high] = std::minmax(t[c], t[(c + 1) % 3]);
      uses.push_back({low, high, static_cast<std::uint32_t>(i)});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  const std::vector<Eigen::Vector3f> normals = face_normals(mesh);
  constexpr float kOnePlane = 0.99985F;  // cosine of a degree
  std::vector<FeatureEdge> edges;
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t end = first + 1;
    while (end < uses.size() && uses[end].low == uses[first].low && uses[end].high == uses[first].high) ++end;
    const Use& last = uses[end - 1];
    const bool flat = end - first == 2 && normals[uses[first].triangle].dot(normals[last.triangle]) > kOnePlane;
    if (!flat) edges.push_back({{last.low, last.high}, {uses[first].triangle, last.triangle}});
    first = end;
  }
  return edges;
}

BoundingSphere bounding_sphere(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  Eigen::Vector3d low = mesh.vertices.front();
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  BoundingSphere sphere{(low + high) / 2, 0};
  for (const Eigen::Vector3d& p : mesh.vertices)
    sphere.radius = std::max(sphere.radius, (p - sphere.centre).squaredNorm());
  sphere.radius = std::sqrt(sphere.radius);
  return sphere;
}

}  // namespace cellmirror::display
