#include "rt_core/tissue/body/rest_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

namespace cellmirror::tissue {
namespace {

// Numbers by key in the order in which the keys appear, so that results do not depend on a hash.
template <class Key>
class Numbering {
 public:
  std::uint32_t of(const Key& key) {
    return numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
  }

 private:
  std::map<Key, std::uint32_t> numbers_;
};

void derive_edges_and_faces(RestMesh& mesh) {
  Numbering<std::array<std::uint32_t, 2>> edges;
  Numbering<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    RestTetrahedron& tetrahedron = mesh.tetrahedra[t];
    for (std::size_t e = 0; e < kEdgeCorners.size(); ++e) {
      std::array<std::uint32_t, 2> key{tetrahedron.nodes[kEdgeCorners[e][0]], tetrahedron.nodes[kEdgeCorners[e][1]]};
      std::ranges::sort(key);
      tetrahedron.edges[e] = edges.of(key);
      if (tetrahedron.edges[e] == mesh.edges.size()) mesh.edges.push_back({.nodes = key});
    }
    for (std::size_t f = 0; f < kFaceCorners.size(); ++f) {
      std::array<std::uint32_t, 3> key{};
      for (std::size_t k = 0; k < 3; ++k) key[k] = tetrahedron.nodes[kFaceCorners[f][k]];
      std::ranges::sort(key);
      tetrahedron.faces[f] = faces.of(key);
      if (tetrahedron.faces[f] == mesh.faces.size()) mesh.faces.emplace_back();
      std::array<std::uint32_t, 2>& sides = mesh.faces[tetrahedron.faces[f]].tetrahedra;
      (sides[0] == kNone ? sides[0] : sides[1]) = t;
    }
  }
}

template <class Members>
IndexLists invert(std::size_t lists, std::span<const RestTetrahedron> tetrahedra, Members&& members) {
  IndexLists result;
  result.start.assign(lists + 1, 0);
  for (const RestTetrahedron& tetrahedron : tetrahedra) {
    for (const std::uint32_t i : members(tetrahedron)) ++result.start[i + 1];
  }
  for (std::size_t i = 0; i < lists; ++i) result.start[i + 1] += result.start[i];
  result.items.resize(result.start.back());
  std::vector<std::uint32_t> next(result.start.begin(), result.start.end() - 1);
  for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) {
    for (const std::uint32_t i : members(tetrahedra[t])) result.items[next[i]++] = t;
  }
  return result;
}

}  // namespace

double tetrahedron_volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                          const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a) / 6.0;
}

RestMesh make_rest_mesh(std::vector<Eigen::Vector3d> nodes, const std::vector<std::array<std::uint32_t, 4>>& tetrahedra,
                        std::vector<std::uint8_t> inside) {
  RestMesh mesh;
  mesh.nodes = std::move(nodes);
  mesh.inside = std::move(inside);
  if (mesh.inside.empty()) mesh.inside.assign(mesh.nodes.size(), 1);
  mesh.tetrahedra.reserve(tetrahedra.size());
  for (const std::array<std::uint32_t, 4>& t : tetrahedra) {
    mesh.tetrahedra.push_back(
        {.nodes = t,
         .edges = {},
         .faces = {},
         .volume = tetrahedron_volume(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]])});
  }
  derive_edges_and_faces(mesh);
  mesh.tetrahedra_of_node =
      invert(mesh.nodes.size(), mesh.tetrahedra, [](const RestTetrahedron& t) -> auto& { return t.nodes; });
  mesh.tetrahedra_of_edge =
      invert(mesh.edges.size(), mesh.tetrahedra, [](const RestTetrahedron& t) -> auto& { return t.edges; });
  return mesh;
}

}  // namespace cellmirror::tissue
