#include "rt_core/tissue/body/dissection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <utility>

namespace cellmirror::tissue {
namespace {

using On = PieceCorner::On;

// Makes the corners of one element's polygons.
class Corners {
 public:
  Corners(const RestMesh& mesh, const Topology& topology, std::uint32_t element)
      : mesh_(mesh),
        topology_(topology),
        number_(element),
        element_(topology.elements()[element]),
        tetrahedron_(mesh.tetrahedra[element_.tetrahedron]) {}

  [[nodiscard]] const Element& element() const { return element_; }
  [[nodiscard]] const RestTetrahedron& tetrahedron() const { return tetrahedron_; }
  [[nodiscard]] bool outside(std::size_t corner) const { return mesh_.inside[tetrahedron_.nodes[corner]] == 0; }
  [[nodiscard]] bool at_boundary(std::size_t face) const {
    return mesh_.faces[tetrahedron_.faces[face]].tetrahedra[1] == kNone;
  }

  [[nodiscard]] PieceCorner node(std::size_t corner) const {
    PieceCorner c{.on = On::node, .id = tetrahedron_.nodes[corner], .weight = {}};
    c.weight[corner] = 1;
    return c;
  }
  [[nodiscard]] PieceCorner edge(std::size_t i, std::size_t j) const {
    const std::uint32_t id = tetrahedron_.edges[kEdgeBetween[i][j]];
    const double share = topology_.crossing(mesh_, id);
    const bool forwards = mesh_.edges[id].nodes[0] == tetrahedron_.nodes[i];
    PieceCorner c{.on = On::edge, .id = id, .weight = {}};
    c.weight[j] = static_cast<float>(forwards ? share : 1.0 - share);
    c.weight[i] = 1.0F - c.weight[j];
    return c;
  }
  [[nodiscard]] PieceCorner face(std::size_t number) const {
    return {.on = On::face,
            .id = tetrahedron_.faces[number],
            .weight = single(topology_.face_point(mesh_, element_.tetrahedron, number))};
  }
  [[nodiscard]] PieceCorner inside() const {
    return {.on = On::inside, .id = number_, .weight = single(topology_.inner_point(mesh_, element_.tetrahedron))};
  }

 private:
  static std::array<float, 4> single(const std::array<double, 4>& w) {
    return {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2]), static_cast<float>(w[3])};
  }

  const RestMesh& mesh_;
  const Topology& topology_;
  std::uint32_t number_;
  const Element& element_;
  const RestTetrahedron& tetrahedron_;
};

// Between corner i, which is the element's own, and corner j, which is not: from the point on their edge over those on
// the two faces beside it to the one inside of the tetrahedron. Both sides use the same diagonal.
template <class Emit>
void emit_between(const Corners& at, std::size_t i, std::size_t j, Emit&& emit) {
  // Faces k and l hold the edge i j, k and l being the two other corners, so chosen that i, j, k, l turn as 0, 1, 2, 3.
  std::size_t k = 0;
  while (k == i || k == j) ++k;
  std::size_t l = 6 - i - j - k;
  const std::size_t inversions = static_cast<std::size_t>(i > j) + static_cast<std::size_t>(i > k) +
                                 static_cast<std::size_t>(i > l) + static_cast<std::size_t>(j > k) +
                                 static_cast<std::size_t>(j > l) + static_cast<std::size_t>(k > l);
  if (inversions % 2 != 0) std::swap(k, l);
  const PieceCorner edge = at.edge(i, j);
  const PieceCorner inside = at.inside();
  const bool cut = !at.outside(j);
  emit(PieceTriangle{.corners = {edge, at.face(l), inside}, .cut = cut});
  emit(PieceTriangle{.corners = {edge, inside, at.face(k)}, .cut = cut});
}

// The element's part of a face of its tetrahedron.
template <class Emit>
void emit_face(const Corners& at, std::size_t face, Emit&& emit) {
  const Element& element = at.element();
  const std::array<std::uint8_t, 3>& corners = kFaceCorners[face];
  unsigned owned = 0;
  for (const std::uint8_t corner : corners) owned += element.owns(corner) ? 1U : 0U;
  const auto triangle = [&](const PieceCorner& a, const PieceCorner& b, const PieceCorner& c) {
    emit(PieceTriangle{.corners = {a, b, c}, .cut = false});
  };
  if (owned == 3) triangle(at.node(corners[0]), at.node(corners[1]), at.node(corners[2]));
  if (owned == 0 || owned == 3) return;
  for (std::size_t n = 0; n < 3; ++n) {
    const std::size_t a = corners[n];
    const std::size_t b = corners[(n + 1) % 3];
    const std::size_t c = corners[(n + 2) % 3];
    if (owned == 1 && element.owns(a)) {
      triangle(at.node(a), at.edge(a, b), at.face(face));
      triangle(at.node(a), at.face(face), at.edge(a, c));
    }
    if (owned == 2 && !element.owns(c)) {
      triangle(at.node(a), at.node(b), at.edge(b, c));
      triangle(at.node(a), at.edge(b, c), at.face(face));
      triangle(at.node(a), at.face(face), at.edge(a, c));
    }
  }
}

template <class Emit>
void emit_ends(const Corners& at, Emit&& emit) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      if (at.element().owns(i) && i != j && !at.element().owns(j)) emit_between(at, i, j, emit);
    }
  }
}

// The organ's surface through a tetrahedron that no cut has parted: a triangle, or two. The same surface as emit_ends()
// makes of more triangles.
void append_uncut(const RestMesh& mesh, const Corners& at, std::vector<PieceTriangle>& triangles) {
  std::array<std::size_t, 4> order{0, 1, 2, 3};  // the element's own first
  std::ranges::stable_partition(order, [&](std::size_t k) { return at.element().owns(k); });
  const auto& [a, b, c, d] = order;
  const std::array<std::uint32_t, 4>& nodes = at.tetrahedron().nodes;
  const Eigen::Vector3d outwards = mesh.nodes[nodes[d]] - mesh.nodes[nodes[a]];
  const auto append = [&](PieceCorner p, PieceCorner q, PieceCorner r) {
    const Eigen::Vector3d origin = rest_position(mesh, at.element(), p);
    const Eigen::Vector3d normal =
        (rest_position(mesh, at.element(), q) - origin).cross(rest_position(mesh, at.element(), r) - origin);
    if (normal.dot(outwards) < 0) std::swap(q, r);
    triangles.push_back({.corners = {p, q, r}, .cut = false});
  };
  switch (std::popcount(at.element().corners)) {
    case 1:
      append(at.edge(a, b), at.edge(a, c), at.edge(a, d));
      break;
    case 2:
      append(at.edge(a, c), at.edge(a, d), at.edge(b, d));
      append(at.edge(a, c), at.edge(b, d), at.edge(b, c));
      break;
    case 3:
      append(at.edge(a, d), at.edge(b, d), at.edge(c, d));
      break;
    default:
      break;
  }
}

}  // namespace

void surface_of(const RestMesh& mesh, const Topology& topology, std::uint32_t element,
                std::vector<PieceTriangle>& triangles) {
  const Corners at(mesh, topology, element);
  const auto append = [&](const PieceTriangle& triangle) { triangles.push_back(triangle); };
  bool uncut = true;
  for (std::size_t k = 0; k < 4; ++k) uncut = uncut && (at.element().owns(k) || at.outside(k));
  if (uncut) {
    append_uncut(mesh, at, triangles);
  } else {
    emit_ends(at, append);
  }
  for (std::size_t face = 0; face < 4; ++face) {
    if (at.at_boundary(face)) emit_face(at, face, append);
  }
}

double material_volume(const RestMesh& mesh, const Topology& topology, std::uint32_t element) {
  const Corners at(mesh, topology, element);
  if (at.element().corners == 0b1111) return at.tetrahedron().volume;
  const Eigen::Vector3d& origin = mesh.nodes[at.tetrahedron().nodes[0]];
  double volume = 0;
  const auto add = [&](const PieceTriangle& triangle) {
    volume += tetrahedron_volume(origin, rest_position(mesh, at.element(), triangle.corners[0]),
                                 rest_position(mesh, at.element(), triangle.corners[1]),
                                 rest_position(mesh, at.element(), triangle.corners[2]));
  };
  emit_ends(at, add);
  for (std::size_t face = 0; face < 4; ++face) emit_face(at, face, add);
  return volume;
}

Eigen::Vector3d rest_position(const RestMesh& mesh, const Element& element, const PieceCorner& corner) {
  const RestTetrahedron& tetrahedron = mesh.tetrahedra[element.tetrahedron];
  const Eigen::Vector3d& origin = mesh.nodes[tetrahedron.nodes[0]];
  Eigen::Vector3d p = origin;
  for (std::size_t k = 1; k < 4; ++k) {
    p += static_cast<double>(corner.weight[k]) * (mesh.nodes[tetrahedron.nodes[k]] - origin);
  }
  return p;
}

}  // namespace cellmirror::tissue
