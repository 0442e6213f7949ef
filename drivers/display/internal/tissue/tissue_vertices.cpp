#include "drivers/display/internal/tissue/tissue_vertices.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::display {

namespace {

constexpr float kFarthestVertex = 1e5F;                      // m
constexpr std::array<float, 3> kFlesh{0.68F, 0.28F, 0.24F};  // of a surface without colours

std::int16_t packed(float value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0F, 1.0F) * 32767.0F));
}

std::array<std::int16_t, 3> packed_normal(const Eigen::Vector3f& normal) {
  if (!normal.allFinite()) return {0, 0, 32767};
  return {packed(normal.x()), packed(normal.y()), packed(normal.z())};
}

// The last step of SplitMix64 (public domain, S. Vigna).
std::uint64_t scrambled(std::uint64_t value) {
  value = (value ^ (value >> 30U)) * 0xbf58'476d'1ce4'e5b9ULL;
  value = (value ^ (value >> 27U)) * 0x94d0'49bb'1331'11ebULL;
  return value ^ (value >> 31U);
}

std::array<std::uint8_t, 4> bytes_of_rgb(const std::array<float, 3>& rgb) {
  std::array<std::uint8_t, 4> bytes{255, 255, 255, 255};
  for (std::size_t i = 0; i < 3; ++i) {
    const float value = std::isfinite(rgb[i]) ? std::clamp(rgb[i], 0.0F, 1.0F) : 1.0F;
    bytes[i] = static_cast<std::uint8_t>(std::lround(value * 255.0F));
  }
  return bytes;
}

}  // namespace

std::optional<TissueTriangles> divide_by_cut(const TissueTopology& topology) {
  const std::size_t count = topology.triangles.size();
  if (count == 0 || count > kMostTissueTriangles) return std::nullopt;
  const bool known = topology.cut_face.size() == count;
  TissueTriangles divided;
  divided.corners.reserve(3 * count);
  std::uint32_t last = 0;
  for (const auto& [a, b, c] : topology.triangles) last = std::max({last, a, b, c});
  if (last >= 3 * kMostTissueTriangles) return std::nullopt;
  divided.used.resize(std::size_t{last} + 1);
  const auto append = [&](bool cut) {
    for (std::size_t i = 0; i < count; ++i) {
      if ((known && topology.cut_face[i] != 0) != cut) continue;
      for (const std::uint32_t vertex : topology.triangles[i]) {
        divided.corners.push_back(vertex);
        divided.used[vertex] = true;
      }
    }
  };
  append(false);
  divided.skin_corners = divided.corners.size();
  append(true);
  return divided;
}

bool is_closed(const TissueTriangles& triangles) {
  // Two multisets of edges are taken for equal if the sums of their members' hashes are: no sorting while it is cut.
  std::uint64_t difference = 0;
  for (std::size_t i = 0; i < triangles.corners.size(); ++i) {
    const std::uint64_t from = triangles.corners[i] + 1ULL;
    const std::uint64_t to = triangles.corners[i % 3 == 2 ? i - 2 : i + 1] + 1ULL;
    difference += scrambled(from << 32U | to) - scrambled(to << 32U | from);
  }
  return difference == 0;
}

std::vector<Corner> edges_of(const TissueTriangles& triangles) {
  std::vector<std::array<Corner, 2>> edges;
  edges.reserve(triangles.corners.size());
  for (std::size_t i = 0; i < triangles.corners.size(); ++i) {
    const Corner next = triangles.corners[i % 3 == 2 ? i - 2 : i + 1];
    const auto [low, high] = std::minmax(triangles.corners[i], next);
    edges.push_back({low, high});
  }
  std::ranges::sort(edges);
  const auto rest = std::ranges::unique(edges);
  edges.erase(rest.begin(), rest.end());
  std::vector<Corner> ends;
  ends.reserve(2 * edges.size());
  for (const std::array<Corner, 2>& edge : edges) ends.insert(ends.end(), edge.begin(), edge.end());
  return ends;
}

std::vector<Dress> coat_of(const TissueTopology& topology, std::size_t vertices) {
  std::vector<Dress> coat(vertices);
  const bool coloured = topology.rgb.size() == vertices;
  const bool placed = topology.texture.size() == vertices;
  for (std::size_t i = 0; i < vertices; ++i) {
    coat[i].colour = bytes_of_rgb(coloured ? topology.rgb[i] : kFlesh);
    if (placed && topology.texture[i].allFinite()) coat[i].place = topology.texture[i];
  }
  return coat;
}

std::optional<Eigen::AlignedBox3d> pack_vertices(const TissueSurface& surface, const TissueTriangles& triangles,
                                                 std::vector<TissueVertex>& vertices) {
  const std::size_t count = surface.vertices.size();
  if (count < triangles.used.size() || surface.normals.size() != count) return std::nullopt;
  const bool burnt = surface.burn.size() == count;
  Eigen::AlignedBox3f box;
  vertices.assign(count, {});
  for (std::size_t i = 0; i < triangles.used.size(); ++i) {
    if (!triangles.used[i]) continue;
    const Eigen::Vector3f& p = surface.vertices[i];
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kFarthestVertex) return std::nullopt;
    box.extend(p);
    const float burn = burnt && std::isfinite(surface.burn[i]) ? std::clamp(surface.burn[i], 0.0F, 2.0F) : 0.0F;
    vertices[i] = {{p.x(), p.y(), p.z()}, packed_normal(surface.normals[i]), packed(burn / 2)};
  }
  return box.cast<double>();
}

}  // namespace cellmirror::display
