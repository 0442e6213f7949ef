#include "rt_core/tissue/body/topology.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <numeric>

namespace cellmirror::tissue {
namespace {

// Corners of `owned` that hang together by edges that `whole` names, as masks, in the order of their lowest corners.
template <class Whole>
std::array<std::uint8_t, kMostParts> connected_corners(std::uint8_t owned, Whole&& whole) {
  std::array<std::uint8_t, kMostParts> parts{};
  std::size_t count = 0;
  for (std::uint8_t rest = owned; rest != 0;) {
    std::uint8_t part = static_cast<std::uint8_t>(rest & -rest);
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t e = 0; e < kEdgeCorners.size(); ++e) {
        const unsigned a = 1U << kEdgeCorners[e][0];
        const unsigned b = 1U << kEdgeCorners[e][1];
        const bool one_of_two = ((part & a) != 0) != ((part & b) != 0);
        if (one_of_two && (rest & a) != 0 && (rest & b) != 0 && whole(e)) {
          part = static_cast<std::uint8_t>(part | a | b);
          grown = true;
        }
      }
    }
    parts[count++] = part;
    rest = static_cast<std::uint8_t>(rest & ~part);
  }
  return parts;
}

std::size_t corner_of(const RestTetrahedron& tetrahedron, std::uint32_t rest_node) {
  return static_cast<std::size_t>(std::ranges::find(tetrahedron.nodes, rest_node) - tetrahedron.nodes.begin());
}

// Barycentric coordinates of p in a tetrahedron.
std::array<double, 4> weights_of(const RestMesh& mesh, const RestTetrahedron& tetrahedron, const Eigen::Vector3d& p) {
  Eigen::Matrix3d edges;
  const Eigen::Vector3d& origin = mesh.nodes[tetrahedron.nodes[0]];
  for (int k = 0; k < 3; ++k) edges.col(k) = mesh.nodes[tetrahedron.nodes[static_cast<std::size_t>(k) + 1]] - origin;
  const Eigen::Vector3d w = edges.inverse() * (p - origin);
  return {1.0 - w.sum(), w.x(), w.y(), w.z()};
}

// Elements around a node at rest and which of them share it.
class Classes {
 public:
  explicit Classes(std::size_t count) : leader_(count) { std::iota(leader_.begin(), leader_.end(), 0U); }
  std::uint32_t leader(std::uint32_t i) {
    while (leader_[i] != i) i = leader_[i] = leader_[leader_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = leader(a);
    b = leader(b);
    if (a != b) leader_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> leader_;
};

// Whether two elements whose tetrahedra have this face in common are one material there: some corner of it is owned by
// both.
bool joined(const RestMesh& mesh, const Element& a, const Element& b, std::size_t face_of_a) {
  const RestTetrahedron& at = mesh.tetrahedra[a.tetrahedron];
  const RestTetrahedron& bt = mesh.tetrahedra[b.tetrahedron];
  return std::ranges::any_of(kFaceCorners[face_of_a], [&](std::uint8_t corner) {
    return a.owns(corner) && b.owns(corner_of(bt, at.nodes[corner]));
  });
}

}  // namespace

Topology::Topology(const RestMesh& mesh)
    : parts_(mesh.tetrahedra.size(), {kNone, kNone, kNone, kNone}),
      divided_(mesh.edges.size(), 0),
      share_(mesh.edges.size(), 0.5),
      element_of_edge_(mesh.edges.size(), kNone),
      face_points_(mesh.faces.size()),
      inner_points_(mesh.tetrahedra.size()) {
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    std::uint8_t owned = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (mesh.inside[mesh.tetrahedra[t].nodes[k]] != 0) owned = static_cast<std::uint8_t>(owned | (1U << k));
    }
    if (owned == 0) continue;
    parts_[t][0] = static_cast<std::uint32_t>(elements_.size());
    elements_.push_back({.tetrahedron = t, .corners = owned, .nodes = {kNone, kNone, kNone, kNone}});
  }
  std::vector<std::uint32_t> all(mesh.nodes.size());
  std::iota(all.begin(), all.end(), 0U);
  renumber(mesh, all, nullptr);
}

bool Topology::crosses(const RestMesh& mesh, std::uint32_t edge) const {
  const auto& [a, b] = mesh.edges[edge].nodes;
  return (mesh.inside[a] != 0) != (mesh.inside[b] != 0);
}

double Topology::crossing(const RestMesh& mesh, std::uint32_t edge) const {
  if (divided_[edge] != 0) return share_[edge];
  return crosses(mesh, edge) ? mesh.edges[edge].crossing : 0.5;
}

Eigen::Vector3d Topology::edge_position(const RestMesh& mesh, std::uint32_t edge) const {
  const auto& [a, b] = mesh.edges[edge].nodes;
  const double share = crossing(mesh, edge);
  return (1.0 - share) * mesh.nodes[a] + share * mesh.nodes[b];
}

// Of the edges that the surface crosses, or where there are none of those that are divided, or of all.
Eigen::Vector3d Topology::mean_crossing(const RestMesh& mesh, std::span<const std::uint32_t> edges) const {
  const auto mean_of = [&](auto&& counts, Eigen::Vector3d& mean) {
    int count = 0;
    mean.setZero();
    for (const std::uint32_t edge : edges) {
      if (!counts(edge)) continue;
      mean += edge_position(mesh, edge);
      ++count;
    }
    if (count > 0) mean /= count;
    return count > 0;
  };
  Eigen::Vector3d mean;
  if (mean_of([&](std::uint32_t e) { return crosses(mesh, e); }, mean)) return mean;
  if (mean_of([&](std::uint32_t e) { return divided_[e] != 0; }, mean)) return mean;
  mean_of([](std::uint32_t) { return true; }, mean);
  return mean;
}

std::array<double, 4> Topology::face_point(const RestMesh& mesh, std::uint32_t tetrahedron, std::size_t face) const {
  const RestTetrahedron& t = mesh.tetrahedra[tetrahedron];
  const EdgePoint& frozen = face_points_[t.faces[face]];
  const auto& [a, b, c] = kFaceCorners[face];
  const std::array<std::uint32_t, 3> edges{t.edges[kEdgeBetween[a][b]], t.edges[kEdgeBetween[b][c]],
                                           t.edges[kEdgeBetween[c][a]]};
  std::array<double, 4> weights = weights_of(mesh, t, frozen.set ? frozen.at : mean_crossing(mesh, edges));
  weights[face] = 0;  // but for rounding, by which the neighbour would not know the point again
  return weights;
}

// With two corners on either side of the surface: the middle of one diagonal of the quadrangle in which the surface
// crosses, so that two triangles are the same surface as four around this point.
Eigen::Vector3d Topology::inner_position(const RestMesh& mesh, std::uint32_t tetrahedron) const {
  const RestTetrahedron& t = mesh.tetrahedra[tetrahedron];
  std::array<std::size_t, 4> order{0, 1, 2, 3};  // those inside first
  std::ranges::stable_partition(order, [&](std::size_t k) { return mesh.inside[t.nodes[k]] != 0; });
  const auto inside = std::ranges::count_if(t.nodes, [&](std::uint32_t n) { return mesh.inside[n] != 0; });
  if (inside != 2) return mean_crossing(mesh, t.edges);
  return 0.5 * (edge_position(mesh, t.edges[kEdgeBetween[order[0]][order[2]]]) +
                edge_position(mesh, t.edges[kEdgeBetween[order[1]][order[3]]]));
}

std::array<double, 4> Topology::inner_point(const RestMesh& mesh, std::uint32_t tetrahedron) const {
  const RestTetrahedron& t = mesh.tetrahedra[tetrahedron];
  const EdgePoint& frozen = inner_points_[tetrahedron];
  return weights_of(mesh, t, frozen.set ? frozen.at : inner_position(mesh, tetrahedron));
}

void Topology::freeze_points(const RestMesh& mesh, std::uint32_t tetrahedron) {
  const RestTetrahedron& t = mesh.tetrahedra[tetrahedron];
  for (std::size_t f = 0; f < 4; ++f) {
    EdgePoint& point = face_points_[t.faces[f]];
    if (point.set) continue;
    const auto& [a, b, c] = kFaceCorners[f];
    const std::array<std::uint32_t, 3> edges{t.edges[kEdgeBetween[a][b]], t.edges[kEdgeBetween[b][c]],
                                             t.edges[kEdgeBetween[c][a]]};
    const auto parted =
        std::ranges::count_if(edges, [&](std::uint32_t e) { return divided_[e] != 0 || crosses(mesh, e); });
    if (parted < 2) continue;  // no part of the tetrahedron ends in this face yet
    point = {.set = true, .at = mean_crossing(mesh, edges)};
  }
  EdgePoint& inner = inner_points_[tetrahedron];
  if (!inner.set) inner = {.set = true, .at = inner_position(mesh, tetrahedron)};
}

void Topology::part_tetrahedron(const RestMesh& mesh, std::uint32_t tetrahedron, TopologyChange& change) {
  const RestTetrahedron& t = mesh.tetrahedra[tetrahedron];
  const std::array<std::uint32_t, kMostParts> before = parts_[tetrahedron];
  std::size_t next = static_cast<std::size_t>(std::ranges::find(before, kNone) - before.begin());
  for (const std::uint32_t element : before) {
    if (element == kNone) break;
    const std::array<std::uint8_t, kMostParts> parts =
        connected_corners(elements_[element].corners, [&](std::size_t e) { return divided_[t.edges[e]] == 0; });
    if (parts[1] == 0) continue;
    freeze_points(mesh, tetrahedron);
    elements_[element].corners = parts[0];
    for (std::size_t k = 1; k < kMostParts && parts[k] != 0; ++k) {
      Element copy = elements_[element];
      copy.corners = parts[k];
      parts_[tetrahedron][next++] = static_cast<std::uint32_t>(elements_.size());
      elements_.push_back(copy);
      change.origins.push_back(element);
      ++change.new_elements;
    }
  }
}

void Topology::divide(const RestMesh& mesh, std::span<const Division> divisions, TopologyChange& change) {
  change = {};
  change.first_new_node = static_cast<std::uint32_t>(rest_node_.size());
  std::vector<std::uint32_t> tetrahedra;
  for (const Division& division : divisions) {
    if (divided_[division.edge] != 0 || element_of_edge_[division.edge] == kNone) continue;
    divided_[division.edge] = 1;
    // Not at a node: a part of an element without volume has no place.
    share_[division.edge] = std::clamp(division.share, 0.1, 0.9);
    element_of_edge_[division.edge] = kNone;
    ++change.divided_edges;
    const std::span<const std::uint32_t> around = mesh.tetrahedra_of_edge.of(division.edge);
    tetrahedra.insert(tetrahedra.end(), around.begin(), around.end());
  }
  std::ranges::sort(tetrahedra);
  tetrahedra.erase(std::ranges::unique(tetrahedra).begin(), tetrahedra.end());
  std::vector<std::uint32_t> rest_nodes;
  for (const std::uint32_t t : tetrahedra) {
    const std::uint32_t before = change.new_elements;
    part_tetrahedron(mesh, t, change);
    if (change.new_elements == before) continue;
    rest_nodes.insert(rest_nodes.end(), mesh.tetrahedra[t].nodes.begin(), mesh.tetrahedra[t].nodes.end());
  }
  std::ranges::sort(rest_nodes);
  rest_nodes.erase(std::ranges::unique(rest_nodes).begin(), rest_nodes.end());
  renumber(mesh, rest_nodes, &change);
}

void Topology::renumber(const RestMesh& mesh, std::span<const std::uint32_t> rest_nodes, TopologyChange* change) {
  std::vector<std::uint32_t> touched;
  for (const std::uint32_t node : rest_nodes) {
    renumber_node(mesh, node, change);
    for (const std::uint32_t t : mesh.tetrahedra_of_node.of(node)) {
      for (const std::uint32_t element : parts_[t]) {
        if (element != kNone) touched.push_back(element);
      }
    }
  }
  std::ranges::sort(touched);
  touched.erase(std::ranges::unique(touched).begin(), touched.end());
  for (const std::uint32_t element : touched) {
    const Element& e = elements_[element];
    const RestTetrahedron& t = mesh.tetrahedra[e.tetrahedron];
    for (std::size_t k = 0; k < 6; ++k) {
      if (divided_[t.edges[k]] == 0 && e.owns(kEdgeCorners[k][0]) && e.owns(kEdgeCorners[k][1])) {
        element_of_edge_[t.edges[k]] = element;
      }
    }
  }
  if (change == nullptr) return;
  change->elements = std::move(touched);
  std::ranges::sort(change->nodes);
  change->nodes.erase(std::ranges::unique(change->nodes).begin(), change->nodes.end());
}

void Topology::renumber_node(const RestMesh& mesh, std::uint32_t rest_node, TopologyChange* change) {
  std::vector<std::uint32_t> around;
  for (const std::uint32_t t : mesh.tetrahedra_of_node.of(rest_node)) {
    for (const std::uint32_t element : parts_[t]) {
      if (element != kNone) around.push_back(element);
    }
  }
  std::ranges::sort(around);
  Classes classes(around.size());
  for (std::uint32_t i = 0; i < around.size(); ++i) {
    const Element& element = elements_[around[i]];
    const RestTetrahedron& t = mesh.tetrahedra[element.tetrahedron];
    const std::size_t opposite = corner_of(t, rest_node);
    for (std::size_t face = 0; face < 4; ++face) {
      const auto& sides = mesh.faces[t.faces[face]].tetrahedra;
      const std::uint32_t beyond = sides[0] == element.tetrahedron ? sides[1] : sides[0];
      if (face == opposite || beyond == kNone) continue;
      for (const std::uint32_t other : parts_[beyond]) {
        if (other == kNone || !joined(mesh, element, elements_[other], face)) continue;
        classes.join(i, static_cast<std::uint32_t>(std::ranges::lower_bound(around, other) - around.begin()));
      }
    }
  }
  // A class keeps the node that its first element had, unless an earlier class has it already.
  std::vector<std::uint32_t> node_of_class(around.size(), kNone);
  std::vector<std::uint32_t> taken;
  for (std::uint32_t i = 0; i < around.size(); ++i) {
    Element& element = elements_[around[i]];
    std::uint32_t& slot = element.nodes[corner_of(mesh.tetrahedra[element.tetrahedron], rest_node)];
    std::uint32_t& node = node_of_class[classes.leader(i)];
    if (node == kNone) {
      if (slot != kNone && std::ranges::find(taken, slot) == taken.end()) {
        node = slot;
      } else {
        node = static_cast<std::uint32_t>(rest_node_.size());
        rest_node_.push_back(rest_node);
        parent_.push_back(slot == kNone ? node : slot);
      }
      taken.push_back(node);
    }
    slot = node;
    if (change != nullptr) change->nodes.push_back(node);
  }
}

}  // namespace cellmirror::tissue
