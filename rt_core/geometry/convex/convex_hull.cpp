#include "rt_core/geometry/convex/convex_hull.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "rt_core/geometry/mesh_repair/mesh_repair_steps.hpp"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace cellmirror::geometry {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// One run of Qhull; its messages go nowhere.
class Qhull {
 public:
  Qhull() : silence_(std::fopen("/dev/null", "w")) { qh_zero(&qh_, silence_.get()); }
  ~Qhull() {
    qh_freeqhull(&qh_, qh_ALL);
    int long_blocks = 0;
    int total = 0;
    qh_memfreeshort(&qh_, &long_blocks, &total);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  // 0: done, else one of Qhull's exit codes.
  int run(std::vector<double>& coordinates) {
    if (!silence_) return qh_ERRinput;
    // Qt: merged facets become triangles. Pp: no remarks on precision.
    char command[] = "qhull Qt Pp";
    return qh_new_qhull(&qh_, 3, static_cast<int>(coordinates.size() / 3), coordinates.data(), False, command, nullptr,
                        silence_.get());
  }
  // Triangles by places of points, facing outwards.
  [[nodiscard]] std::vector<TriangleIndices> triangles() {
    std::vector<TriangleIndices> out;
    qhT* qh = &qh_;
    facetT* facet = nullptr;
    FORALLfacets {
      if (facet->vertices == nullptr || qh_setsize(qh, facet->vertices) != 3) continue;
      TriangleIndices corners{};
      std::size_t i = 0;
      vertexT* vertex = nullptr;
      vertexT** vertexp = nullptr;
      FOREACHvertex_(facet->vertices) corners[i++] = static_cast<std::uint32_t>(qh_pointid(qh, vertex->point));
      if (facet->toporient == qh_ORIENTclock) std::swap(corners[1], corners[2]);
      out.push_back(corners);
    }
    return out;
  }

 private:
  std::unique_ptr<std::FILE, CloseFile> silence_;
  qhT qh_{};
};

Error flat(std::string_view name) {
  return {fmt::format("{} is flat and has no convex hull", name), "use it as it is (exact), or a thin box"};
}

// How far the farthest point stands out of a convex mesh, m. Needles are left out: their normals are mostly rounding,
// and their neighbours bound the points as well.
double farthest_outside(const TriangleMesh& hull, std::span<const Eigen::Vector3d> points) {
  constexpr double kNeedle = 1e-6;  // height by length
  double farthest = 0.0;
  for (const auto& [a, b, c] : hull.triangles) {
    const Eigen::Vector3d& p = hull.vertices[a];
    const Eigen::Vector3d u = hull.vertices[b] - p;
    const Eigen::Vector3d v = hull.vertices[c] - p;
    const Eigen::Vector3d normal = u.cross(v);
    if (normal.norm() < kNeedle * std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()})) continue;
    double most = 0.0;
    for (const Eigen::Vector3d& q : points) most = std::max(most, normal.dot(q - p));
    farthest = std::max(farthest, most / normal.norm());
  }
  return farthest;
}

// Qhull's triangles as a mesh; not welded, since that could move a corner inwards.
TriangleMesh mesh_of(std::string name, std::span<const Eigen::Vector3d> points, Triangles triangles) {
  MeshFindings findings;
  TriangleMesh hull;
  hull.name = std::move(name);
  hull.vertices.assign(points.begin(), points.end());
  hull.triangles = std::move(triangles);
  remove_unused(hull.vertices, hull.triangles);
  Origins origins(hull.triangles.size());  // of no use here
  remove_degenerate(hull.vertices, hull.triangles, origins, findings);
  remove_duplicates(hull.triangles, origins, findings);
  if (hull.triangles.empty()) return hull;
  remove_unused(hull.vertices, hull.triangles);
  hull.closed = orient(hull.vertices, hull.triangles, findings) && findings.shells == 1;
  return hull;
}

}  // namespace

Result<TriangleMesh> convex_hull(std::string name, std::span<const Eigen::Vector3d> points) {
  if (points.size() < 4) return std::unexpected(flat(name));
  if (points.size() > 3 * kMostTriangles) return fail(fmt::format("{} has too many points", name));
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) {
    if (!p.allFinite()) return fail(fmt::format("a coordinate of {} is not a number", name));
    box.extend(p);
  }
  const double size = box.diagonal().norm();
  const Eigen::Vector3d centre = box.center();
  if (!(size > 0.0)) return std::unexpected(flat(name));
  // About the centre and of size 1, where Qhull's own tolerances are right for every mesh.
  std::vector<double> coordinates;
  coordinates.reserve(3 * points.size());
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d scaled = (p - centre) / size;
    coordinates.insert(coordinates.end(), {scaled.x(), scaled.y(), scaled.z()});
  }
  Qhull qhull;
  if (qhull.run(coordinates) != 0) return std::unexpected(flat(name));
  TriangleMesh hull = mesh_of(name, points, qhull.triangles());
  if (!hull.closed) return std::unexpected(flat(name));
  if (farthest_outside(hull, points) > kHullTolerance * size)
    return fail(fmt::format("the convex hull of {} is not reliable", name), "use it as it is (exact)");
  hull.convex = true;
  return hull;
}

}  // namespace cellmirror::geometry
