// Which elements there are: one for each tetrahedron at rest, and after cuts one for each of its parts that still
// contains a node (virtual nodes: Molino, Bao, Fedkiw 2004). A part has all four nodes of its tetrahedron; corners
// whose material belongs to another part are nodes of its own there. So elements keep their shape and their stable
// step, and parts come apart because they have nodes of their own. Every edge between two nodes is divided at most
// once, which bounds what cuts can make.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/tissue/body/rest_mesh.hpp"

namespace cellmirror::tissue {

inline constexpr std::size_t kMostParts = 4;  // of a tetrahedron

struct Element {
  std::uint32_t tetrahedron = 0;
  std::uint8_t corners = 0;              // bit k: the material at corner k is its own
  std::array<std::uint32_t, 4> nodes{};  // of the simulation: see Topology::rest_node

  [[nodiscard]] bool owns(std::size_t corner) const { return ((corners >> corner) & 1U) != 0; }
};

// What a cut changed: elements whose nodes or material are other ones now, new ones among them, which are the last
// ones of the body.
struct TopologyChange {
  std::vector<std::uint32_t> elements;
  std::vector<std::uint32_t> origins;  // by new element: the one that it was a part of
  std::vector<std::uint32_t> nodes;    // whose mass changed
  std::uint32_t first_new_node = 0;    // these and later ones are copies of their Topology::parent
  std::uint32_t divided_edges = 0;
  std::uint32_t new_elements = 0;
  double area_m2 = 0;  // of new surface, one side, at rest
};

class Topology {
 public:
  explicit Topology(const RestMesh& mesh);

  [[nodiscard]] std::span<const Element> elements() const { return elements_; }
  // Of a node of the simulation: its node at rest, and the node of the simulation from which a cut parted it.
  [[nodiscard]] std::span<const std::uint32_t> rest_node() const { return rest_node_; }
  [[nodiscard]] std::span<const std::uint32_t> parent() const { return parent_; }
  [[nodiscard]] bool divided(std::uint32_t edge) const { return divided_[edge] != 0; }
  // Some element that owns both ends of an edge; kNone where it is divided or not within the material.
  [[nodiscard]] std::uint32_t element_of_edge(std::uint32_t edge) const { return element_of_edge_[edge]; }
  // Element of a part of a tetrahedron; kNone beyond the last one.
  [[nodiscard]] std::uint32_t part(std::uint32_t tetrahedron, std::size_t k) const { return parts_[tetrahedron][k]; }

  // Where edge e is divided or crossed by the surface, in shares of the way from its first node; 0.5 where it is
  // neither.
  [[nodiscard]] double crossing(const RestMesh& mesh, std::uint32_t edge) const;
  // Weights of the corners of a tetrahedron for the common point of the parts of one of its faces, and of its inside.
  [[nodiscard]] std::array<double, 4> face_point(const RestMesh& mesh, std::uint32_t tetrahedron,
                                                 std::size_t face) const;
  [[nodiscard]] std::array<double, 4> inner_point(const RestMesh& mesh, std::uint32_t tetrahedron) const;

  // Divides edges at shares of the way from their first nodes. Edges that are divided, or not within the material, are
  // passed over.
  struct Division {
    std::uint32_t edge = 0;
    double share = 0.5;
  };
  void divide(const RestMesh& mesh, std::span<const Division> divisions, TopologyChange& change);

 private:
  struct EdgePoint {
    bool set = false;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();  // m, at rest
  };

  void part_tetrahedron(const RestMesh& mesh, std::uint32_t tetrahedron, TopologyChange& change);
  void freeze_points(const RestMesh& mesh, std::uint32_t tetrahedron);
  void renumber(const RestMesh& mesh, std::span<const std::uint32_t> rest_nodes, TopologyChange* change);
  void renumber_node(const RestMesh& mesh, std::uint32_t rest_node, TopologyChange* change);
  [[nodiscard]] bool crosses(const RestMesh& mesh, std::uint32_t edge) const;
  [[nodiscard]] Eigen::Vector3d edge_position(const RestMesh& mesh, std::uint32_t edge) const;
  [[nodiscard]] Eigen::Vector3d inner_position(const RestMesh& mesh, std::uint32_t tetrahedron) const;
  [[nodiscard]] Eigen::Vector3d mean_crossing(const RestMesh& mesh, std::span<const std::uint32_t> edges) const;

  std::vector<Element> elements_;
  std::vector<std::array<std::uint32_t, kMostParts>> parts_;  // by tetrahedron
  std::vector<std::uint32_t> rest_node_;
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> divided_;  // by edge
  std::vector<double> share_;          // by edge, where divided
  std::vector<std::uint32_t> element_of_edge_;
  std::vector<EdgePoint> face_points_;   // by face: set once it is needed, so that parts never change again
  std::vector<EdgePoint> inner_points_;  // by tetrahedron
};

}  // namespace cellmirror::tissue
