// Welding by hashing: equal positions first, then positions within the tolerance by a grid of cells.
#include <bit>
#include <cmath>
#include <limits>

#include "rt_core/geometry/mesh_repair/mesh_repair_steps.hpp"

namespace cellmirror::geometry {

namespace {

constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();

using Cell = std::array<std::int64_t, 3>;

std::uint64_t hash_of(const Cell& cell) {
  // The finalizer of splitmix64 over each part.
  std::uint64_t h = 0x9E37'79B9'7F4A'7C15ULL;
  for (const std::int64_t part : cell) {
    h ^= static_cast<std::uint64_t>(part);
    h = (h ^ (h >> 30U)) * 0xBF58'476D'1CE4'E5B9ULL;
    h = (h ^ (h >> 27U)) * 0x94D0'49BB'1331'11EBULL;
    h ^= h >> 31U;
  }
  return h;
}

// Chains of vertices by cell, without an allocation for each.
class CellTable {
 public:
  explicit CellTable(std::size_t vertices)
      : mask_(std::bit_ceil(2 * vertices + 1) - 1), first_(mask_ + 1, kNone), next_(vertices, kNone) {}

  void add(const Cell& cell, std::uint32_t vertex) {
    std::uint32_t& first = first_[hash_of(cell) & mask_];
    next_[vertex] = first;
    first = vertex;
  }
  // The first vertex that fits, of those in the cell and of those that share its place in the table.
  template <class Fits>
  [[nodiscard]] std::uint32_t find(const Cell& cell, Fits fits) const {
    for (std::uint32_t at = first_[hash_of(cell) & mask_]; at != kNone; at = next_[at]) {
      if (fits(at)) return at;
    }
    return kNone;
  }

 private:
  std::size_t mask_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> next_;
};

// Keeps the vertices with to[i] == i; `to` names earlier vertices only.
void compact(Vertices& vertices, Triangles& triangles, std::vector<std::uint32_t>& to) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (to[i] == i) {
      vertices[kept] = vertices[i];
      to[i] = kept++;
    } else {
      to[i] = to[to[i]];
    }
  }
  vertices.resize(kept);
  for (TriangleIndices& triangle : triangles) {
    for (std::uint32_t& vertex : triangle) vertex = to[vertex];
  }
}

void weld_equal(Vertices& vertices, Triangles& triangles) {
  CellTable table(vertices.size());
  std::vector<std::uint32_t> to(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    vertices[i].array() += 0.0;  // -0 becomes 0
    const Eigen::Vector3d& p = vertices[i];
    const Cell cell{std::bit_cast<std::int64_t>(p.x()), std::bit_cast<std::int64_t>(p.y()),
                    std::bit_cast<std::int64_t>(p.z())};
    const std::uint32_t same = table.find(cell, [&](std::uint32_t other) { return vertices[other] == p; });
    to[i] = same == kNone ? i : same;
    if (same == kNone) table.add(cell, i);
  }
  compact(vertices, triangles, to);
}

// Vertices that are kept lie farther apart than the tolerance, so a cell of four times that holds a bounded number.
void weld_near(Vertices& vertices, Triangles& triangles, const Eigen::Vector3d& lower, double tolerance) {
  const double edge = 4.0 * tolerance;
  CellTable table(vertices.size());
  std::vector<std::uint32_t> to(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3d p = vertices[i];
    const auto fits = [&](std::uint32_t other) { return (vertices[other] - p).norm() <= tolerance; };
    Cell low{};
    Cell high{};
    Cell own{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = p[static_cast<Eigen::Index>(k)] - lower[static_cast<Eigen::Index>(k)];
      low[k] = static_cast<std::int64_t>(std::floor((x - tolerance) / edge));
      high[k] = static_cast<std::int64_t>(std::floor((x + tolerance) / edge));
      own[k] = static_cast<std::int64_t>(std::floor(x / edge));
    }
    std::uint32_t same = kNone;
    for (std::int64_t x = low[0]; x <= high[0] && same == kNone; ++x) {
      for (std::int64_t y = low[1]; y <= high[1] && same == kNone; ++y) {
        for (std::int64_t z = low[2]; z <= high[2] && same == kNone; ++z) same = table.find({x, y, z}, fits);
      }
    }
    to[i] = same == kNone ? i : same;
    if (same == kNone) table.add(own, i);
  }
  compact(vertices, triangles, to);
}

}  // namespace

std::size_t weld(Vertices& vertices, Triangles& triangles) {
  const std::size_t before = vertices.size();
  weld_equal(vertices, triangles);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : vertices) box.extend(p);
  const double farthest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  // Far from the origin neighbouring double numbers may be farther apart than the tolerance.
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  const double tolerance = std::max(kWeldTolerance * box.diagonal().norm(), kRounding * farthest);
  if (tolerance > std::numeric_limits<double>::min()) weld_near(vertices, triangles, box.min(), tolerance);
  return before - vertices.size();
}

}  // namespace cellmirror::geometry
