#include "rt_core/contact_model/mesh_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace cellmirror::contact_model {

namespace {

using Eigen::Vector3d;

// How near to an edge a point is taken to be on it, in parts of the triangle's height.
constexpr double kOnEdge = 1e-7;
// How far a neighbour may rise towards a direction and still count as not rising: above what rounding does to a
// direction over 0.02 mm.
constexpr double kRise = 1e-5;
// Normals nearer than this are those of one plane.
constexpr double kSamePlane = 1e-6;

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

MeshSurface::MeshSurface(const geometry::MeshTree& tree) : tree_(tree) {
  const geometry::TriangleMesh& mesh = tree.mesh();
  facets_.resize(tree.triangles().size());
  for (std::uint32_t i = 0; i < facets_.size(); ++i) {
    const geometry::Triangle& t = tree.triangles()[i];
    facets_[i].normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    facets_[i].corners = mesh.triangles[tree.original(i)];
  }
  collect_rings();
  join_edges();
  blend_normals();
}

void MeshSurface::collect_rings() {
  const std::size_t vertices = tree_.mesh().vertices.size();
  ring_begin_.assign(vertices + 1, 0);
  for (const Facet& facet : facets_) {
    for (const std::uint32_t v : facet.corners) ++ring_begin_[v + 1];
  }
  for (std::size_t v = 0; v < vertices; ++v) ring_begin_[v + 1] += ring_begin_[v];
  ring_.resize(ring_begin_[vertices]);
  std::vector<std::uint32_t> filled(ring_begin_.begin(), ring_begin_.end() - 1);
  for (std::uint32_t i = 0; i < facets_.size(); ++i) {
    for (const std::uint32_t v : facets_[i].corners) ring_[filled[v]++] = i;
  }
}

void MeshSurface::join_edges() {
  struct Edge {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t facet;
    std::uint8_t index;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * facets_.size());
  for (std::uint32_t i = 0; i < facets_.size(); ++i) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = facets_[i].corners[k];
      const std::uint32_t b = facets_[i].corners[(k + 1U) % 3U];
      edges.push_back({std::min(a, b), std::max(a, b), i, k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
  });
  sharp_corner_.assign(tree_.mesh().vertices.size(), 0);
  for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
    while (end < edges.size() && edges[end].low == edges[first].low && edges[end].high == edges[first].high) ++end;
    const Edge& one = edges[first];
    const Edge& other = edges[end - 1];
    const bool pair = end - first == 2;
    const bool smooth = pair && angle_between(facets_[one.facet].normal, facets_[other.facet].normal) < kSmoothAngle;
    if (pair) {
      facets_[one.facet].across[one.index] = other.facet;
      facets_[other.facet].across[other.index] = one.facet;
    }
    for (std::size_t k = first; k < end && !smooth; ++k) {
      facets_[edges[k].facet].sharp_edges |= static_cast<std::uint8_t>(1U << edges[k].index);
      sharp_corner_[edges[k].low] = sharp_corner_[edges[k].high] = 1;
    }
  }
}

void MeshSurface::blend_normals() {
  const std::vector<Vector3d>& vertices = tree_.mesh().vertices;
  for (Facet& facet : facets_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = facet.corners[k];
      Vector3d sum = Vector3d::Zero();
      bool plane = true;
      for (std::uint32_t r = ring_begin_[v]; r < ring_begin_[v + 1]; ++r) {
        const Facet& around = facets_[ring_[r]];
        if (angle_between(around.normal, facet.normal) > kSmoothAngle) continue;
        const auto at = static_cast<std::size_t>(std::find(around.corners.begin(), around.corners.end(), v) -
                                                 around.corners.begin());
        const Vector3d to_next = vertices[around.corners[(at + 1) % 3]] - vertices[v];
        const Vector3d to_last = vertices[around.corners[(at + 2) % 3]] - vertices[v];
        sum += angle_between(to_next, to_last) * around.normal;
        plane = plane && (around.normal - facet.normal).norm() < kSamePlane;
      }
      facet.corner_normals[k] = plane ? facet.normal : Vector3d(sum.normalized());
    }
  }
}

Feature MeshSurface::feature(std::uint32_t triangle, const Vector3d& p) const {
  const geometry::Triangle& t = tree_.triangles()[triangle];
  const Vector3d cross = (t[1] - t[0]).cross(t[2] - t[0]);
  const double square = cross.squaredNorm();
  Feature out;
  out.triangle = triangle;
  std::array<bool, 3> opposite{};  // the point is on the edge opposite a corner
  int on_edges = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    out.weights[row] = (t[(k + 2) % 3] - t[(k + 1) % 3]).cross(p - t[(k + 1) % 3]).dot(cross) / square;
    opposite[k] = out.weights[row] < kOnEdge;
    if (!opposite[k]) continue;
    out.weights[row] = 0;
    ++on_edges;
  }
  out.weights /= std::max(out.weights.sum(), 1e-300);
  for (std::size_t k = 0; k < 3; ++k) {
    if (on_edges == 1 && opposite[k]) out.index = static_cast<std::uint8_t>((k + 1) % 3);
    if (on_edges == 2 && !opposite[k]) out.index = static_cast<std::uint8_t>(k);
  }
  out.kind = on_edges == 0 ? FeatureKind::face : (on_edges == 1 ? FeatureKind::edge : FeatureKind::corner);
  return out;
}

bool MeshSurface::nearest_around(const Feature& feature, const Vector3d& p, const Vector3d& d) const {
  const std::vector<Vector3d>& vertices = tree_.mesh().vertices;
  const Facet& facet = facets_[feature.triangle];
  if (feature.kind == FeatureKind::face) return true;
  if (feature.kind == FeatureKind::edge) {
    const std::uint32_t across = facet.across[feature.index];
    if (across == kNone) return true;
    const Vector3d& from = vertices[facet.corners[feature.index]];
    const Vector3d along = (vertices[facet.corners[(feature.index + 1U) % 3U]] - from).normalized();
    for (const std::uint32_t v : facets_[across].corners) {
      const Vector3d into = vertices[v] - p;
      const Vector3d rise = into - into.dot(along) * along;
      const double length = rise.norm();
      if (length > kOnEdge * into.norm() && rise.dot(d) > kRise * length) return false;
    }
    return true;
  }
  // Facets are plane: where none of the edges rises, nothing between them does.
  const std::uint32_t v = facet.corners[feature.index];
  for (std::uint32_t r = ring_begin_[v]; r < ring_begin_[v + 1]; ++r) {
    for (const std::uint32_t w : facets_[ring_[r]].corners) {
      const Vector3d along = vertices[w] - vertices[v];
      if (w != v && along.dot(d) > kRise * along.norm()) return false;
    }
  }
  return true;
}

bool MeshSurface::smooth_normal(const Feature& feature, Vector3d& normal) const {
  const Facet& facet = facets_[feature.triangle];
  if (feature.kind == FeatureKind::edge && ((facet.sharp_edges >> feature.index) & 1U) != 0) return false;
  if (feature.kind == FeatureKind::corner && sharp_corner_[facet.corners[feature.index]] != 0) return false;
  const auto& n = facet.corner_normals;
  if (n[0] == facet.normal && n[1] == facet.normal && n[2] == facet.normal) {
    normal = facet.normal;
    return true;
  }
  const Vector3d sum = feature.weights[0] * n[0] + feature.weights[1] * n[1] + feature.weights[2] * n[2];
  const double length = sum.norm();
  if (!(length > 0.1)) return false;
  normal = sum / length;
  return true;
}

}  // namespace cellmirror::contact_model
