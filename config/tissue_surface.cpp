#include "config/tissue_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "config/tissue_crossings.hpp"
#include "config/tissue_setup.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror {

using geometry::TriangleMesh;

namespace {

constexpr double kLargestObject = 10.0;     // m
constexpr double kSmallestObject = 0.0001;  // m
constexpr double kLeastVolume = 1e-6;       // of the cube over the longest edge of its box

// The middle of an edge that does not belong to two triangles.
Eigen::Vector3d open_place(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      edges.emplace_back(std::minmax(from, to));
  }
  std::ranges::sort(edges);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if ((end - i) % 2 == 1) return 0.5 * (mesh.vertices[edges[i].first] + mesh.vertices[edges[i].second]);
    i = end;
  }
  return mesh.vertices[mesh.triangles.front()[0]];
}

std::string why_open(const TriangleMesh& mesh) {
  geometry::MeshFindings findings;
  static_cast<void>(geometry::make_mesh(mesh.name, mesh.vertices, mesh.triangles, findings));
  const std::string why = findings.why_open();
  return why.empty() ? "it has no inside" : why;
}

// The material with a picture that most triangles show; -1: none has one.
int main_material(const MeshAppearance& look) {
  std::map<std::uint16_t, std::size_t> users;
  for (const std::uint16_t material : look.materials) {
    if (material < look.palette.size() && look.palette[material].picture) ++users[material];
  }
  const auto most = std::ranges::max_element(users, {}, [](const auto& entry) { return entry.second; });
  return most == users.end() ? -1 : most->first;
}

}  // namespace

std::string place_text(const Eigen::Vector3d& p) {
  return fmt::format("[{:.4g}, {:.4g}, {:.4g}] m", p.x(), p.y(), p.z());
}

Result<void> check_object_size(const Eigen::AlignedBox3d& box) {
  const double longest = box.sizes().maxCoeff();
  if (longest >= kSmallestObject && longest <= kLargestObject) return {};
  return fail(fmt::format("it is {:.3g} m long, but 0.0001 to 10 m are possible", longest),
              "give the scale: meshes in mm have scale = [0.001, 0.001, 0.001], .msh files scale = 0.001");
}

Result<void> check_tissue_surface(const std::shared_ptr<const TriangleMesh>& mesh) {
  const auto refuse = [&](const std::string& what, std::string remedy) {
    return fail(fmt::format("the mesh {} is no surface of an object: {}", mesh->name, what), std::move(remedy));
  };
  if (mesh->triangles.size() > kMostSurfaceTriangles) {
    return refuse(fmt::format("it has {} triangles, more than {}", mesh->triangles.size(), kMostSurfaceTriangles),
                  "reduce it: details finer than the elements only take time");
  }
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : mesh->vertices) box.extend(p);
  const double longest = box.sizes().maxCoeff();
  if (const auto size = check_object_size(box); !size) return refuse(size.error().what, size.error().remedy);
  if (!mesh->closed) {
    return refuse(fmt::format("{}, near {}", why_open(*mesh), place_text(open_place(*mesh))),
                  "close it in the program that made it");
  }
  const double volume = geometry::signed_volume(*mesh);
  if (!(volume > kLeastVolume * longest * longest * longest))
    return refuse(fmt::format("its volume is {:.3g} m3", volume), "give it a thickness");
  const SelfCrossings crossings = find_self_crossings(mesh);
  if (crossings.pairs == 0 && crossings.complete) return {};
  if (crossings.pairs == 0)
    return refuse("too many of its triangles lie close together", "remesh it with triangles of similar size");
  return refuse(fmt::format("it crosses itself, {} of triangles, near {}", number_of(crossings.pairs, "pair"),
                            place_text(crossings.place)),
                "unite its parts or separate them in the program that made it");
}

TissueSurfaceMesh tissue_surface(const TriangleMesh& mesh, const MeshAppearance* look) {
  TissueSurfaceMesh out;
  const int material = look != nullptr && look->places.size() == 3 * mesh.triangles.size() ? main_material(*look) : -1;
  if (material < 0) {
    out.surface.vertices = mesh.vertices;
    out.surface.triangles = mesh.triangles;
    return out;
  }
  using Corner = std::tuple<std::uint32_t, float, float>;
  std::map<Corner, std::uint32_t> known;
  std::vector<std::uint32_t> first(mesh.vertices.size(), UINT32_MAX);
  out.surface.triangles = mesh.triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool shows = look->materials[t] == material;
    if (!shows && look->materials[t] < look->palette.size() && look->palette[look->materials[t]].picture)
      ++out.without_picture;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2f& at = look->places[3 * t + k];
      const std::uint32_t vertex = mesh.triangles[t][k];
      const auto next = static_cast<std::uint32_t>(out.surface.vertices.size());
      const auto [entry, is_new] = known.try_emplace(Corner(vertex, at.x(), at.y()), next);
      out.surface.triangles[t][k] = entry->second;
      if (!is_new) continue;
      if (first[vertex] == UINT32_MAX) first[vertex] = next;
      out.surface.vertices.push_back(mesh.vertices[vertex]);
      out.surface.texture.push_back(at);
      out.surface.same_as.push_back(first[vertex]);
    }
  }
  if (out.surface.vertices.size() == mesh.vertices.size()) out.surface.same_as.clear();
  auto one = std::make_shared<MeshAppearance>();
  one->palette.push_back(look->palette[static_cast<std::size_t>(material)]);
  out.look = std::move(one);
  return out;
}

}  // namespace cellmirror
