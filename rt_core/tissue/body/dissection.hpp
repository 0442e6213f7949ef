// The material of one element as polygons: where it ends at the organ's surface or at a cut, and its volume. Polygons
// of neighbours fit together exactly, so that every part has a closed surface and cuts keep the volume.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rt_core/tissue/body/rest_mesh.hpp"
#include "rt_core/tissue/body/topology.hpp"

namespace cellmirror::tissue {

// A corner of a polygon, named by what it lies on, so that neighbours recognize it.
struct PieceCorner {
  enum class On : std::uint8_t { node, edge, face, inside };
  On on = On::node;
  std::uint32_t id = 0;           // of the node, edge, face at rest, or of the element
  std::array<float, 4> weight{};  // of the element's corners
};

struct PieceTriangle {
  std::array<PieceCorner, 3> corners;  // counter-clockwise from outside
  bool cut = false;                    // made by a cut; else part of the organ's surface
};

// Appends the triangles of the element's surface.
void surface_of(const RestMesh& mesh, const Topology& topology, std::uint32_t element,
                std::vector<PieceTriangle>& triangles);
// Volume of the element's material, m3.
[[nodiscard]] double material_volume(const RestMesh& mesh, const Topology& topology, std::uint32_t element);

// Where a corner lies at rest, m.
[[nodiscard]] Eigen::Vector3d rest_position(const RestMesh& mesh, const Element& element, const PieceCorner& corner);

}  // namespace cellmirror::tissue
