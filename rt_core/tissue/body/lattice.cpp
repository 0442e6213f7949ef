#include "rt_core/tissue/body/lattice.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "rt_core/geometry/inside.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"
#include "rt_core/geometry/mesh_tree.hpp"

namespace cellmirror::tissue {
namespace {

// Keeps the pieces of elements on both sides of a crossing from becoming slivers.
constexpr double kNearestCrossing = 0.02;
constexpr int kBisections = 14;

// Corners of cubes have even coordinates, their centres odd ones, in halves of the size.
struct Grid {
  Eigen::Vector3d origin;  // m
  double half = 0;         // m
  Eigen::Vector3i count;   // of cubes

  [[nodiscard]] Eigen::Vector3i corners() const { return count + Eigen::Vector3i::Ones(); }
  [[nodiscard]] std::size_t corner_count() const {
    const Eigen::Vector3i n = corners();
    return static_cast<std::size_t>(n.x()) * static_cast<std::size_t>(n.y()) * static_cast<std::size_t>(n.z());
  }
  [[nodiscard]] std::size_t cube_count() const {
    return static_cast<std::size_t>(count.x()) * static_cast<std::size_t>(count.y()) *
           static_cast<std::size_t>(count.z());
  }
  [[nodiscard]] std::uint32_t corner(const Eigen::Vector3i& at) const {
    const Eigen::Vector3i n = corners();
    return static_cast<std::uint32_t>((at.z() * n.y() + at.y()) * n.x() + at.x());
  }
  [[nodiscard]] std::uint32_t centre(const Eigen::Vector3i& at) const {
    return static_cast<std::uint32_t>(corner_count()) +
           static_cast<std::uint32_t>((at.z() * count.y() + at.y()) * count.x() + at.x());
  }
};

Result<Grid> make_grid(const std::string& name, const SurfaceMesh& surface, double size) {
  Eigen::Vector3d low = surface.vertices.front();
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& v : surface.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const Eigen::Vector3d extent = high - low;
  const Eigen::Vector3d cubes = (extent / size).array().ceil() + 2.0;
  if (2.0 * cubes.prod() > static_cast<double>(kMostLatticeNodes)) {
    const double fits = size * std::cbrt(2.0 * cubes.prod() / static_cast<double>(kMostLatticeNodes)) * 1.1;
    return fail(fmt::format("{}: a lattice of {:g} m has too many nodes for a surface of {:.3g} x {:.3g} x {:.3g} m",
                            name, size, extent.x(), extent.y(), extent.z()),
                fmt::format("set element_size_m to {:.2g} or more", fits));
  }
  Grid grid;
  grid.half = size / 2;
  grid.count = cubes.cast<int>();
  grid.origin = 0.5 * (low + high) - 0.5 * size * grid.count.cast<double>();
  return grid;
}

std::vector<Eigen::Vector3d> grid_nodes(const Grid& grid) {
  std::vector<Eigen::Vector3d> nodes;
  nodes.reserve(grid.corner_count() + grid.cube_count());
  const auto append = [&](const Eigen::Vector3i& n, const Eigen::Vector3d& shift) {
    for (int z = 0; z < n.z(); ++z) {
      for (int y = 0; y < n.y(); ++y) {
        for (int x = 0; x < n.x(); ++x) {
          nodes.push_back(grid.origin + 2.0 * grid.half * (Eigen::Vector3d(x, y, z) + shift));
        }
      }
    }
  };
  append(grid.corners(), Eigen::Vector3d::Zero());
  append(grid.count, Eigen::Vector3d::Constant(0.5));
  return nodes;
}

// Between the centres of two cubes with a common square: four tetrahedra around the line that joins them, each with an
// edge of the square.
std::vector<std::array<std::uint32_t, 4>> grid_tetrahedra(const Grid& grid, std::span<const std::uint8_t> inside) {
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  const auto square = [&](const Eigen::Vector3i& cube, int axis) {
    Eigen::Vector3i next = cube;
    ++next[axis];
    if (next[axis] >= grid.count[axis]) return;
    Eigen::Vector3i u = Eigen::Vector3i::Zero();
    Eigen::Vector3i v = Eigen::Vector3i::Zero();
    u[(axis + 1) % 3] = 1;
    v[(axis + 2) % 3] = 1;
    const std::array<std::uint32_t, 4> ring{grid.corner(next), grid.corner(next + u), grid.corner(next + u + v),
                                            grid.corner(next + v)};
    for (std::size_t k = 0; k < 4; ++k) {
      const std::array<std::uint32_t, 4> t{grid.centre(cube), ring[k], ring[(k + 1) % 4], grid.centre(next)};
      if (std::ranges::any_of(t, [&](std::uint32_t node) { return inside[node] != 0; })) tetrahedra.push_back(t);
    }
  };
  for (int z = 0; z < grid.count.z(); ++z) {
    for (int y = 0; y < grid.count.y(); ++y) {
      for (int x = 0; x < grid.count.x(); ++x) {
        for (int axis = 0; axis < 3; ++axis) square(Eigen::Vector3i(x, y, z), axis);
      }
    }
  }
  return tetrahedra;
}

void drop_unused_nodes(std::vector<Eigen::Vector3d>& nodes, std::vector<std::uint8_t>& inside,
                       std::vector<std::array<std::uint32_t, 4>>& tetrahedra) {
  std::vector<std::uint32_t> renumbered(nodes.size(), kNone);
  std::vector<Eigen::Vector3d> kept;
  std::vector<std::uint8_t> kept_inside;
  for (std::array<std::uint32_t, 4>& t : tetrahedra) {
    for (std::uint32_t& node : t) {
      if (renumbered[node] == kNone) {
        renumbered[node] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(nodes[node]);
        kept_inside.push_back(inside[node]);
      }
      node = renumbered[node];
    }
  }
  nodes = std::move(kept);
  inside = std::move(kept_inside);
}

// The surface's place on each edge with one end inside, by bisection.
void find_crossings(RestMesh& mesh, const geometry::MeshTree& tree) {
  for (RestEdge& edge : mesh.edges) {
    const bool first = mesh.inside[edge.nodes[0]] != 0;
    if (first == (mesh.inside[edge.nodes[1]] != 0)) continue;
    const Eigen::Vector3d& a = mesh.nodes[edge.nodes[0]];
    const Eigen::Vector3d& b = mesh.nodes[edge.nodes[1]];
    double low = 0;
    double high = 1;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (geometry::contains(tree, a + middle * (b - a)) == first ? low : high) = middle;
    }
    edge.crossing = std::clamp(0.5 * (low + high), kNearestCrossing, 1.0 - kNearestCrossing);
  }
}

}  // namespace

Result<RestMesh> fill_with_lattice(const std::string& name, const SurfaceMesh& surface, double size) {
  if (surface.triangles.empty()) return fail(name + ": the surface has no triangles", "name a closed surface mesh");
  geometry::MeshFindings findings;
  Result<geometry::TriangleMesh> checked = geometry::make_mesh(name, surface.vertices, surface.triangles, findings);
  if (!checked) {
    return fail(fmt::format("{}: {}", name, checked.error().what),
                checked.error().remedy.empty() ? "export a closed surface again, in metres" : checked.error().remedy);
  }
  if (!checked->closed) {
    return fail(fmt::format("{}: the surface is not closed: {}", name, findings.why_open()),
                "close it; an organ's volume lies inside of its surface");
  }
  const Result<Grid> grid = make_grid(name, surface, size);
  if (!grid) return std::unexpected(grid.error());
  const geometry::MeshTree tree(std::make_shared<const geometry::TriangleMesh>(*std::move(checked)));

  std::vector<Eigen::Vector3d> nodes = grid_nodes(*grid);
  std::vector<std::uint8_t> inside(nodes.size());
  std::ranges::transform(nodes, inside.begin(),
                         [&](const Eigen::Vector3d& p) -> std::uint8_t { return geometry::contains(tree, p) ? 1 : 0; });
  std::vector<std::array<std::uint32_t, 4>> tetrahedra = grid_tetrahedra(*grid, inside);
  if (tetrahedra.empty()) {
    return fail(fmt::format("{}: no node of a lattice of {:g} m lies inside of the surface", name, size),
                "set a smaller element_size_m: at most half of the thickness");
  }
  if (tetrahedra.size() > kMostElements) {
    return fail(
        fmt::format("{}: {} elements of {:g} m; at most {} are possible", name, tetrahedra.size(), size, kMostElements),
        fmt::format("set element_size_m to {:.2g} or more",
                    size * std::cbrt(static_cast<double>(tetrahedra.size()) / kMostElements) * 1.1));
  }
  drop_unused_nodes(nodes, inside, tetrahedra);
  RestMesh mesh = make_rest_mesh(std::move(nodes), tetrahedra, std::move(inside));
  find_crossings(mesh, tree);
  return mesh;
}

}  // namespace cellmirror::tissue
