#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "rt_core/geometry/mesh_repair/mesh_repair_steps.hpp"

namespace cellmirror::geometry {

namespace {

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

Result<void> check(const Vertices& vertices, const Triangles& triangles) {
  if (triangles.empty()) return fail("there are no triangles");
  if (triangles.size() > kMostTriangles) {
    return fail(fmt::format("there are {} triangles, more than {}", triangles.size(), kMostTriangles),
                "reduce the mesh");
  }
  if (vertices.size() > 3 * kMostTriangles)
    return fail(fmt::format("there are {} vertices, more than {}", vertices.size(), 3 * kMostTriangles));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3d& p = vertices[i];
    if (!p.allFinite()) return fail(fmt::format("a coordinate of vertex {} is not a number", i + 1), "export it again");
    if (p.cwiseAbs().maxCoeff() > kLargestCoordinate) {
      return fail(fmt::format("vertex {} is {:g} m away from the origin", i + 1, p.cwiseAbs().maxCoeff()),
                  "check the unit and the scale");
    }
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto largest = *std::ranges::max_element(triangles[i]);
    if (largest >= vertices.size()) {
      return fail(fmt::format("triangle {} refers to vertex {}, but there are {}", i + 1, largest + std::uint64_t{1},
                              vertices.size()));
    }
  }
  return {};
}

}  // namespace

std::vector<std::string> MeshFindings::repairs() const {
  std::vector<std::string> out;
  if (degenerate_triangles > 0)
    out.push_back(counted(degenerate_triangles, "triangle has no area", "triangles have no area"));
  if (lost_lines > 0) {
    out.push_back(fmt::format("{}, up to {:.3g} m long, and cannot be tested",
                              counted(lost_lines, "of these is an isolated line", "of these are isolated lines"),
                              longest_lost_m));
  }
  if (duplicate_triangles > 0)
    out.push_back(counted(duplicate_triangles, "triangle appears twice", "triangles appear twice"));
  if (flipped_triangles > 0) {
    out.push_back(counted(flipped_triangles, "triangle was oriented against its neighbours",
                          "triangles were oriented against their neighbours"));
  }
  if (inside_out_shells > 0)
    out.push_back(counted(inside_out_shells, "shell was inside out", "shells were inside out"));
  return out;
}

std::string MeshFindings::why_open() const {
  std::string why;
  const auto add = [&](const std::string& reason) { why += (why.empty() ? "" : ", ") + reason; };
  if (open_edges > 0)
    add(counted(open_edges, "edge belongs to one triangle only", "edges belong to one triangle only"));
  if (crowded_edges > 0)
    add(counted(crowded_edges, "edge belongs to too many triangles", "edges belong to too many triangles"));
  if (not_orientable) add("a shell has only one side");
  if (flat_shell) add("a shell has no volume");
  if (too_nested) add("too many shells face inwards");
  return why;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  // About a vertex, since far from the origin the terms would cancel.
  const Eigen::Vector3d o = mesh.vertices.front();
  double six_volumes = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    six_volumes += (mesh.vertices[a] - o).dot((mesh.vertices[b] - o).cross(mesh.vertices[c] - o));
  }
  return six_volumes / 6.0;
}

void remove_unused(Vertices& vertices, Triangles& triangles) {
  constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> to(vertices.size(), kNone);
  Vertices used;
  for (TriangleIndices& triangle : triangles) {
    for (std::uint32_t& vertex : triangle) {
      if (to[vertex] == kNone) {
        to[vertex] = static_cast<std::uint32_t>(used.size());
        used.push_back(vertices[vertex]);
      }
      vertex = to[vertex];
    }
  }
  used.shrink_to_fit();
  vertices = std::move(used);
}

Result<TriangleMesh> make_mesh(std::string name, std::vector<Eigen::Vector3d> vertices,
                               std::vector<TriangleIndices> triangles, MeshFindings& findings,
                               std::vector<std::uint32_t>* origins) {
  findings = MeshFindings();
  if (auto checked = check(vertices, triangles); !checked) return std::unexpected(checked.error());
  remove_unused(vertices, triangles);
  findings.welded_vertices = weld(vertices, triangles);
  Origins from(triangles.size());
  std::iota(from.begin(), from.end(), 0U);
  remove_degenerate(vertices, triangles, from, findings);
  remove_duplicates(triangles, from, findings);
  if (triangles.empty()) return fail("no triangle has an area");
  remove_unused(vertices, triangles);
  TriangleMesh mesh;
  mesh.closed = orient(vertices, triangles, findings);
  mesh.name = std::move(name);
  mesh.vertices = std::move(vertices);
  triangles.shrink_to_fit();
  mesh.triangles = std::move(triangles);
  if (origins != nullptr) *origins = std::move(from);
  return mesh;
}

}  // namespace cellmirror::geometry
