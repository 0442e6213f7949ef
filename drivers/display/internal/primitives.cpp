#include "drivers/display/internal/primitives.hpp"

#include <cmath>
#include <numbers>
#include <span>

namespace cellmirror::display {

namespace {

using geometry::TriangleMesh;

constexpr std::uint32_t kAround = 48;
constexpr std::uint32_t kRingsOfHemisphere = 12;

struct Ring {
  double radius = 0;
  double z = 0;
};

// A solid of revolution about z: `rings` from the lowest to the highest; ends of radius 0 are points, others are closed
// with a disc where `capped`.
TriangleMesh revolve(std::span<const Ring> rings, bool capped) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> first;  // vertex of each ring
  for (const Ring& ring : rings) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    const std::uint32_t count = ring.radius > 0 ? kAround : 1;
    for (std::uint32_t i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      mesh.vertices.emplace_back(ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.z);
    }
  }
  const auto at = [&](std::size_t ring, std::uint32_t i) {
    return first[ring] + (rings[ring].radius > 0 ? i % kAround : 0);
  };
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      if (rings[r].radius > 0) mesh.triangles.push_back({at(r, i), at(r, i + 1), at(r + 1, i)});
      if (rings[r + 1].radius > 0) mesh.triangles.push_back({at(r, i + 1), at(r + 1, i + 1), at(r + 1, i)});
    }
  }
  const auto cap = [&](std::size_t ring, bool top) {
    if (!capped || !(rings[ring].radius > 0)) return;
    for (std::uint32_t i = 1; i + 1 < kAround; ++i) {
      if (top) mesh.triangles.push_back({at(ring, 0), at(ring, i), at(ring, i + 1)});
      if (!top) mesh.triangles.push_back({at(ring, 0), at(ring, i + 1), at(ring, i)});
    }
  };
  cap(0, false);
  cap(rings.size() - 1, true);
  return mesh;
}

}  // namespace

TriangleMesh unit_box() {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1U) != 0 ? 0.5 : -0.5, (i & 2U) != 0 ? 0.5 : -0.5, (i & 4U) != 0 ? 0.5 : -0.5);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh unit_cylinder() {
  constexpr std::array<Ring, 2> kRings = {Ring{1, -0.5}, Ring{1, 0.5}};
  return revolve(kRings, true);
}

TriangleMesh unit_cone() {
  constexpr std::array<Ring, 2> kRings = {Ring{1, 0}, Ring{0, 1}};
  return revolve(kRings, true);
}

TriangleMesh unit_funnel() {
  constexpr std::array<Ring, 2> kRings = {Ring{0, 0}, Ring{1, 1}};
  return revolve(kRings, false);
}

TriangleMesh capsule(double radius, double length) {
  std::vector<Ring> rings;
  for (std::uint32_t i = 0; i <= kRingsOfHemisphere; ++i) {
    const double angle = std::numbers::pi / 2 * i / kRingsOfHemisphere;
    rings.push_back({i == 0 ? 0 : radius * std::sin(angle), -length / 2 - radius * std::cos(angle)});
  }
  const std::size_t lower = rings.size();
  for (std::size_t i = lower; i-- > 0;) {
    if (i + 1 == lower && !(length > 0)) continue;  // a sphere has one equator
    rings.push_back({rings[i].radius, -rings[i].z});
  }
  return revolve(rings, false);
}

TriangleMesh unit_sphere() { return capsule(1, 0); }

}  // namespace cellmirror::display
