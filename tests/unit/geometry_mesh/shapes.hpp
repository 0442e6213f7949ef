// Meshes as files give them: corners and triangles, before any repair.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror::geometry {

struct Soup {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<TriangleIndices> triangles;

  void add(const Soup& other) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& [a, b, c] : other.triangles) triangles.push_back({a + first, b + first, c + first});
  }
  [[nodiscard]] Soup scaled(double factor) const {
    Soup out = *this;
    for (Eigen::Vector3d& p : out.vertices) p *= factor;
    return out;
  }
  [[nodiscard]] Soup moved(const Eigen::Vector3d& by) const {
    Soup out = *this;
    for (Eigen::Vector3d& p : out.vertices) p += by;
    return out;
  }
  [[nodiscard]] Soup inside_out() const {
    Soup out = *this;
    for (TriangleIndices& t : out.triangles) std::swap(t[1], t[2]);
    return out;
  }
  // Three vertices of its own for each triangle, as in STL.
  [[nodiscard]] Soup unshared() const {
    Soup out;
    for (const TriangleIndices& t : triangles) {
      const auto first = static_cast<std::uint32_t>(out.vertices.size());
      for (const std::uint32_t corner : t) out.vertices.push_back(vertices[corner]);
      out.triangles.push_back({first, first + 1, first + 2});
    }
    return out;
  }
};

// Edges of 1 m, centred, facing outwards.
inline Soup cube() {
  Soup out;
  for (int i = 0; i < 8; ++i)
    out.vertices.emplace_back((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5, (i & 4) != 0 ? 0.5 : -0.5);
  out.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return out;
}

// A ring about z with 2 * around * across triangles, facing outwards.
inline Soup torus(double radius, double tube, std::uint32_t around, std::uint32_t across) {
  Soup out;
  for (std::uint32_t i = 0; i < around; ++i) {
    const double u = 2.0 * std::numbers::pi * i / around;
    for (std::uint32_t k = 0; k < across; ++k) {
      const double v = 2.0 * std::numbers::pi * k / across;
      const double r = radius + tube * std::cos(v);
      out.vertices.emplace_back(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
      const std::uint32_t i2 = (i + 1) % around;
      const std::uint32_t k2 = (k + 1) % across;
      const std::uint32_t a = i * across + k;
      const std::uint32_t b = i2 * across + k;
      const std::uint32_t c = i2 * across + k2;
      const std::uint32_t d = i * across + k2;
      out.triangles.push_back({a, b, c});
      out.triangles.push_back({a, c, d});
    }
  }
  return out;
}

}  // namespace cellmirror::geometry
