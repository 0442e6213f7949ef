#include "rt_core/tissue/body/embedded_surface.hpp"

#include <algorithm>

namespace cellmirror::tissue {

std::uint32_t EmbeddedSurface::point(const RestMesh& mesh, const Element& element, const PieceCorner& corner) {
  Key key{static_cast<std::uint32_t>(corner.on), corner.id, kNone, kNone, kNone, kNone};
  for (std::size_t k = 0; k < 4; ++k) {
    if (corner.weight[k] != 0) key[2 + k] = element.nodes[k];
  }
  std::sort(key.begin() + 2, key.end());
  const auto [at, fresh] = numbers_.try_emplace(key, 0);
  if (fresh) {
    if (free_points_.empty()) {
      at->second = static_cast<std::uint32_t>(points_.size());
      points_.emplace_back();
      rest_.emplace_back();
      uses_.push_back(0);
      keys_.emplace_back();
    } else {
      at->second = free_points_.back();
      free_points_.pop_back();
    }
    points_[at->second] = {.node = element.nodes, .weight = corner.weight, .tetrahedron = element.tetrahedron};
    rest_[at->second] = rest_position(mesh, element, corner);
    keys_[at->second] = key;
  }
  ++uses_[at->second];
  return at->second;
}

void EmbeddedSurface::release(std::uint32_t point) {
  if (--uses_[point] > 0) return;
  numbers_.erase(keys_[point]);
  points_[point] = {};
  free_points_.push_back(point);
}

void EmbeddedSurface::remove_triangle(std::uint32_t triangle) {
  for (const std::uint32_t p : triangles_[triangle]) release(p);
  const std::uint32_t last = static_cast<std::uint32_t>(triangles_.size()) - 1;
  if (triangle != last) {
    triangles_[triangle] = triangles_[last];
    cut_[triangle] = cut_[last];
    owner_[triangle] = owner_[last];
    std::ranges::replace(of_element_[owner_[last]], last, triangle);
  }
  triangles_.pop_back();
  cut_.pop_back();
  owner_.pop_back();
}

void EmbeddedSurface::update(const RestMesh& mesh, const Topology& topology, std::span<const std::uint32_t> elements) {
  of_element_.resize(topology.elements().size());
  for (const std::uint32_t element : elements) {
    std::vector<std::uint32_t>& mine = of_element_[element];
    while (!mine.empty()) {
      const std::uint32_t triangle = mine.back();
      mine.pop_back();
      remove_triangle(triangle);
    }
  }
  for (const std::uint32_t element : elements) {
    pieces_.clear();
    surface_of(mesh, topology, element, pieces_);
    for (const PieceTriangle& piece : pieces_) {
      const Element& e = topology.elements()[element];
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t k = 0; k < 3; ++k) triangle[k] = point(mesh, e, piece.corners[k]);
      of_element_[element].push_back(static_cast<std::uint32_t>(triangles_.size()));
      triangles_.push_back(triangle);
      cut_.push_back(piece.cut ? 1 : 0);
      owner_.push_back(element);
    }
  }
}

}  // namespace cellmirror::tissue
