// Tetrahedra at rest with everything about them that no deformation and no cut changes: edges, faces, neighbours, which
// nodes lie in the material, and where the surface crosses edges. Immutable once made.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// The edges and faces of a tetrahedron by its corners. Face k lies opposite of corner k; seen from outside its corners
// turn counter-clockwise.
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> kEdgeCorners{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kFaceCorners{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
// Number of the edge between two corners; the diagonal is unused.
inline constexpr std::array<std::array<std::uint8_t, 4>, 4> kEdgeBetween{
    {{0, 0, 1, 2}, {0, 0, 3, 4}, {1, 3, 0, 5}, {2, 4, 5, 0}}};

struct RestTetrahedron {
  std::array<std::uint32_t, 4> nodes{};  // positive volume
  std::array<std::uint32_t, 6> edges{};
  std::array<std::uint32_t, 4> faces{};
  double volume = 0;  // m3
};

struct RestEdge {
  std::array<std::uint32_t, 2> nodes{};  // the smaller number first
  double crossing = 0.5;  // where the surface crosses it: share of the way from nodes[0]; edges with one end inside
};

struct RestFace {
  std::array<std::uint32_t, 2> tetrahedra{kNone, kNone};
};

// Lists of numbers by index, one after the other.
struct IndexLists {
  std::vector<std::uint32_t> start;  // one more than lists
  std::vector<std::uint32_t> items;

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t i) const {
    return {items.data() + start[i], items.data() + start[i + 1]};
  }
};

struct RestMesh {
  std::vector<Eigen::Vector3d> nodes;  // m
  std::vector<std::uint8_t> inside;    // by node
  std::vector<RestTetrahedron> tetrahedra;
  std::vector<RestEdge> edges;
  std::vector<RestFace> faces;
  IndexLists tetrahedra_of_node;
  IndexLists tetrahedra_of_edge;
};

// Derives edges, faces and lists. All nodes count as inside where `inside` is empty. Tetrahedra have positive volume.
[[nodiscard]] RestMesh make_rest_mesh(std::vector<Eigen::Vector3d> nodes,
                                      const std::vector<std::array<std::uint32_t, 4>>& tetrahedra,
                                      std::vector<std::uint8_t> inside);

[[nodiscard]] double tetrahedron_volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                        const Eigen::Vector3d& d);

}  // namespace cellmirror::tissue
