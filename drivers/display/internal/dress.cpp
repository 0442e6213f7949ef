#include "drivers/display/internal/dress.hpp"

#include <algorithm>
#include <limits>

namespace cellmirror::display {

bool sound(const MeshAppearance& look, std::size_t triangles) {
  if (look.materials.size() != triangles || look.places.size() != 3 * triangles) return false;
  if (!look.colours.empty() && look.colours.size() != 3 * triangles) return false;
  const auto known = [&](std::uint16_t material) { return material < look.palette.size(); };
  const auto finite = [](const Eigen::Vector2f& place) { return place.allFinite(); };
  return std::ranges::all_of(look.materials, known) && std::ranges::all_of(look.places, finite);
}

std::vector<Dress> dress(Surface& surface, const MeshAppearance& look) {
  constexpr auto kNone = std::numeric_limits<Corner>::max();
  constexpr int kMostCompared = 16;  // a vertex of a hostile file may have a million places
  std::vector<Dress> dresses(surface.vertices.size());
  std::vector<bool> worn(surface.vertices.size());
  std::vector<Corner> next(surface.vertices.size(), kNone);  // another vertex for the same place on the surface
  for (std::size_t i = 0; i < surface.corners.size(); ++i) {
    const Dress wanted{look.places[i], look.colours.empty() ? Dress().colour : look.colours[i]};
    Corner vertex = surface.corners[i];
    const Corner first = vertex;
    for (int compared = 0; worn[vertex] && !(dresses[vertex] == wanted); ++compared) {
      if (next[vertex] != kNone && compared < kMostCompared) {
        vertex = next[vertex];
        continue;
      }
      const auto made = static_cast<Corner>(surface.vertices.size());
      surface.vertices.push_back(Vertex(surface.vertices[first]));
      dresses.emplace_back();
      worn.push_back(false);
      next.push_back(next[first]);
      next[first] = made;
      vertex = made;
    }
    dresses[vertex] = wanted;
    worn[vertex] = true;
    surface.corners[i] = vertex;
  }
  return dresses;
}

MaterialOrder order_by_material(const MeshAppearance& look) {
  MaterialOrder order;
  order.ends.assign(look.palette.size(), 0);
  for (const std::uint16_t material : look.materials) ++order.ends[material];
  std::uint32_t sum = 0;
  for (std::uint32_t& end : order.ends) {
    const std::uint32_t count = end;
    end = sum;  // where it begins, for now
    sum += count;
  }
  order.triangles.resize(look.materials.size());
  for (std::uint32_t i = 0; i < look.materials.size(); ++i) order.triangles[order.ends[look.materials[i]]++] = i;
  return order;
}

}  // namespace cellmirror::display
