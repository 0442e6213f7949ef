// The surface of a body: triangles between points that are embedded in its elements. Triangles of elements that a cut
// changed are replaced; all others stay.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "rt_core/tissue/body/body.hpp"
#include "rt_core/tissue/body/dissection.hpp"
#include "rt_core/tissue/body/rest_mesh.hpp"
#include "rt_core/tissue/body/topology.hpp"

namespace cellmirror::tissue {

class EmbeddedSurface {
 public:
  // Replaces the triangles of these elements, which may be new ones.
  void update(const RestMesh& mesh, const Topology& topology, std::span<const std::uint32_t> elements);

  [[nodiscard]] std::span<const EmbeddedPoint> points() const { return points_; }
  // At rest, m; of points that are not in use: where they were.
  [[nodiscard]] std::span<const Eigen::Vector3d> rest_positions() const { return rest_; }
  [[nodiscard]] std::span<const std::array<std::uint32_t, 3>> triangles() const { return triangles_; }
  [[nodiscard]] std::span<const std::uint8_t> cut_faces() const { return cut_; }

 private:
  // What a point lies on, and the nodes of the simulation that carry it.
  using Key = std::array<std::uint32_t, 6>;

  [[nodiscard]] std::uint32_t point(const RestMesh& mesh, const Element& element, const PieceCorner& corner);
  void release(std::uint32_t point);
  void remove_triangle(std::uint32_t triangle);

  std::vector<EmbeddedPoint> points_;
  std::vector<Eigen::Vector3d> rest_;
  std::vector<std::uint32_t> uses_;  // by point
  std::vector<Key> keys_;            // by point
  std::map<Key, std::uint32_t> numbers_;
  std::vector<std::uint32_t> free_points_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint8_t> cut_;
  std::vector<std::uint32_t> owner_;                    // by triangle: element
  std::vector<std::vector<std::uint32_t>> of_element_;  // triangles
  std::vector<PieceTriangle> pieces_;                   // kept for its memory
};

}  // namespace cellmirror::tissue
