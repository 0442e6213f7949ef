#include "rt_core/tissue/body/body_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "rt_core/tissue/body/lattice.hpp"
#include "rt_core/tissue/body/rest_mesh.hpp"

namespace cellmirror::tissue {
namespace {

struct Figure {
  std::string_view name;
  double value = 0;
  double least = 0;
  double most = 0;
};

Result<void> check_material(const std::string& place, const Material& m) {
  const std::array<Figure, 7> figures{{
      {.name = "youngs_modulus_pa", .value = m.youngs_modulus_pa, .least = 1, .most = 1e9},
      {.name = "poissons_ratio", .value = m.poissons_ratio, .least = 0, .most = 0.49},
      {.name = "density_kg_m3", .value = m.density_kg_m3, .least = 1, .most = 1e5},
      {.name = "damping_s", .value = m.damping_s, .least = 0, .most = 1},
      {.name = "drag_1_s", .value = m.drag_1_s, .least = 0, .most = 1e4},
      {.name = "yield_strain", .value = m.yield_strain, .least = 0, .most = 100},
      {.name = "tear_strain", .value = m.tear_strain, .least = 0, .most = 100},
  }};
  for (const Figure& f : figures) {
    if (f.value >= f.least && f.value <= f.most) continue;  // not with NaN
    return fail(fmt::format("{}: {} is {:g}", place, f.name, f.value),
                fmt::format("set it from {:g} to {:g}", f.least, f.most));
  }
  return {};
}

bool far_away(const Eigen::Vector3d& p) { return !(p.cwiseAbs().maxCoeff() <= kLargestCoordinate_m) || !p.allFinite(); }

Result<void> check_points(const std::string& place, std::string_view what, const std::vector<Eigen::Vector3d>& points) {
  const auto bad = std::ranges::find_if(points, far_away);
  if (bad == points.end()) return {};
  return fail(fmt::format("{}: {} {} is not finite or farther than {:g} m from the origin", place, what,
                          bad - points.begin() + 1, kLargestCoordinate_m),
              "check the unit of the file, and write it again");
}

Result<void> check_surface(const ObjectDescription& d) {
  if (auto points = check_points(d.name, "vertex", d.surface.vertices); !points) return points;
  for (std::size_t t = 0; t < d.surface.triangles.size(); ++t) {
    for (const std::uint32_t vertex : d.surface.triangles[t]) {
      if (vertex >= d.surface.vertices.size()) {
        return fail(fmt::format("{}: triangle {} of the surface refers to vertex {}, but there are {}", d.name, t + 1,
                                std::uint64_t{vertex} + 1, d.surface.vertices.size()),
                    "write the mesh again");
      }
    }
  }
  if (!d.surface.texture.empty() &&
      (d.surface.texture.size() != d.surface.vertices.size() || d.surface.triangles.empty())) {
    return fail(fmt::format("{}: {} texture coordinates for {} vertices", d.name, d.surface.texture.size(),
                            d.surface.vertices.size()),
                "give each vertex of the surface one, or none");
  }
  return {};
}

Result<void> check_faces(const ObjectDescription& d) {
  std::map<std::array<std::uint32_t, 3>, int> faces;
  for (std::size_t t = 0; t < d.volume.tetrahedra.size(); ++t) {
    for (const std::array<std::uint8_t, 3>& corners : kFaceCorners) {
      std::array<std::uint32_t, 3> key{};
      for (std::size_t k = 0; k < 3; ++k) key[k] = d.volume.tetrahedra[t][corners[k]];
      std::ranges::sort(key);
      if (++faces[key] <= 2) continue;
      return fail(fmt::format("{}: tetrahedron {} shares a face with two others", d.name, t + 1),
                  "remove tetrahedra that overlap or are in the file twice");
    }
  }
  return {};
}

Result<void> check_tetrahedra(const ObjectDescription& d) {
  const std::vector<Eigen::Vector3d>& nodes = d.volume.nodes;
  if (d.volume.tetrahedra.size() > kMostElements) {
    return fail(
        fmt::format("{}: {} tetrahedra; at most {} are possible", d.name, d.volume.tetrahedra.size(), kMostElements),
        "make a coarser mesh");
  }
  for (std::size_t t = 0; t < d.volume.tetrahedra.size(); ++t) {
    const std::array<std::uint32_t, 4>& n = d.volume.tetrahedra[t];
    for (const std::uint32_t node : n) {
      if (node >= nodes.size() || far_away(nodes[node])) {
        return fail(fmt::format("{}: tetrahedron {} has a node that is missing, not finite or farther than {:g} m from "
                                "the origin",
                                d.name, t + 1, kLargestCoordinate_m),
                    "check the unit of the file, and write the mesh again");
      }
    }
    double longest = 0;
    for (const auto& [a, b] : kEdgeCorners) longest = std::max(longest, (nodes[n[a]] - nodes[n[b]]).norm());
    const double volume = std::abs(tetrahedron_volume(nodes[n[0]], nodes[n[1]], nodes[n[2]], nodes[n[3]]));
    constexpr double kRegular = 0.11785113;  // volume of a regular one, in cubes of its edge
    const double quality = volume / (kRegular * longest * longest * longest);
    if (!(longest >= 1e-6)) {
      return fail(fmt::format("{}: tetrahedron {} is flat: its longest edge is {:g} m", d.name, t + 1, longest),
                  "check the unit of the file, and write the mesh again");
    }
    if (!(quality >= kLeastQuality)) {
      const Eigen::Vector3d at = 250.0 * (nodes[n[0]] + nodes[n[1]] + nodes[n[2]] + nodes[n[3]]);
      return fail(
          fmt::format("{}: tetrahedron {} at ({:.1f}, {:.1f}, {:.1f}) mm is flat: its quality is {:.2g} (a regular "
                      "one has 1), at least {:g} is needed",
                      d.name, t + 1, at.x(), at.y(), at.z(), quality, kLeastQuality),
          "let the mesher remove slivers (Gmsh: Mesh.Optimize, Mesh.OptimizeNetgen)");
    }
  }
  return check_faces(d);
}

}  // namespace

Result<void> check_description(const ObjectDescription& d) {
  if (!d.X_WO.matrix().allFinite() || far_away(d.X_WO.translation())) {
    return fail(
        fmt::format("{}: its place is not finite or farther than {:g} m from the origin", d.name, kLargestCoordinate_m),
        "set another place");
  }
  if (auto material = check_material(d.name, d.material); !material) return material;
  for (const Region& region : d.regions) {
    const std::string place = fmt::format("{}: region {}", d.name, region.name);
    if (auto material = check_material(place, region.material); !material) return material;
    if (auto points = check_points(place, "point", {region.a, region.b}); !points) return points;
    if (!(region.radius_m > 0 && region.radius_m <= kLargestCoordinate_m)) {
      return fail(fmt::format("{}: its radius is {:g} m", place, region.radius_m), "set a radius above 0");
    }
  }
  if (auto surface = check_surface(d); !surface) return surface;
  if (!d.volume.tetrahedra.empty()) return check_tetrahedra(d);
  if (!(d.element_size_m >= 1e-5 && d.element_size_m <= kLargestCoordinate_m)) {
    return fail(fmt::format("{}: element_size_m is {:g}", d.name, d.element_size_m), "set it from 1e-5 to 1000");
  }
  return {};
}

}  // namespace cellmirror::tissue
