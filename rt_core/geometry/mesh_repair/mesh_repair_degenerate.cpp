// Triangles without area. Dropping a flat triangle whose middle corner lies on its longest side would leave a seam
// open there: the neighbour across that side is split at the middle corner instead, which moves no surface.
#include <algorithm>
#include <limits>

#include "rt_core/geometry/mesh_repair/mesh_repair_steps.hpp"

namespace cellmirror::geometry {

namespace {

// The line that a flat triangle is: from a to b through the middle corner.
struct Flat {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t middle = 0;
};

bool has_equal_corners(const TriangleIndices& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

Flat line_of(const Vertices& vertices, const TriangleIndices& t) {
  std::size_t longest = 0;
  double length = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double edge = (vertices[t[(i + 1) % 3]] - vertices[t[i]]).squaredNorm();
    if (edge <= length) continue;
    length = edge;
    longest = i;
  }
  return {t[longest], t[(longest + 1) % 3], t[(longest + 2) % 3]};
}

class DegenerateRemover {
 public:
  DegenerateRemover(const Vertices& vertices, Triangles& triangles, Origins& origins)
      : vertices_(vertices), triangles_(triangles), origins_(origins) {
    double farthest = 0.0;
    for (const Eigen::Vector3d& p : vertices) farthest = std::max(farthest, p.cwiseAbs().maxCoeff());
    constexpr double kUnits = 8.0;  // of rounding in the coordinates
    smallest_height_ = kUnits * std::numeric_limits<double>::epsilon() * farthest;
  }

  void run(MeshFindings& findings) {
    findings.degenerate_triangles = static_cast<std::size_t>(std::ranges::count_if(
        triangles_, [&](const TriangleIndices& t) { return has_equal_corners(t) || is_flat(t); }));
    if (findings.degenerate_triangles == 0) return;
    drop_lines();
    // Each pass splits triangles that do not share a neighbour; a fan of n flat triangles needs up to n passes.
    constexpr int kMostPasses = 64;
    for (int pass = 0; pass < kMostPasses && split_neighbours(); ++pass) drop_lines();
    drop_flat();
    report_lost(findings);
  }

 private:
  [[nodiscard]] bool is_flat(const TriangleIndices& t) const {
    const Flat line = line_of(vertices_, t);
    const Eigen::Vector3d along = vertices_[line.b] - vertices_[line.a];
    const double length = along.norm();
    // Below this a normal is made of rounding errors.
    constexpr double kFlatness = 1e-12;
    const double height = along.cross(vertices_[line.middle] - vertices_[line.a]).norm() / length;
    return !(height > std::max(kFlatness * length, smallest_height_));
  }

  // Welded to a line or a point: their two remaining sides cancel, nothing opens.
  void drop_lines() {
    drop([](const TriangleIndices& t) { return has_equal_corners(t); });
  }

  template <class Is>
  void drop(Is is) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      if (is(triangles_[i])) {
        dropped_.push_back(line_of(vertices_, triangles_[i]));
        continue;
      }
      triangles_[kept] = triangles_[i];
      origins_[kept++] = origins_[i];
    }
    triangles_.resize(kept);
    origins_.resize(kept);
  }

  // Of the two triangles at an edge, the one that is not `triangle`; nothing where there are not two.
  static std::uint32_t other_of(std::span<const EdgeUse> uses, std::uint32_t triangle) {
    if (uses.size() != 2) return triangle;
    return uses[0].triangle == triangle ? uses[1].triangle : uses[0].triangle;
  }

  // False where there was nothing to split.
  bool split_neighbours() {
    std::vector<std::uint32_t> flat;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (is_flat(triangles_[i])) flat.push_back(i);
    }
    if (flat.empty()) return false;
    const std::vector<EdgeUse> uses = edge_uses(triangles_);
    std::vector<bool> touched(triangles_.size());
    bool any = false;
    for (const std::uint32_t i : flat) {
      if (touched[i]) continue;
      const Flat line = line_of(vertices_, triangles_[i]);
      const std::uint32_t neighbour = other_of(uses_of(uses, edge_key(line.a, line.b)), i);
      if (neighbour == i || touched[neighbour]) continue;
      const auto apex = std::ranges::find_if(
          triangles_[neighbour], [&](std::uint32_t corner) { return corner != line.a && corner != line.b; });
      // A second edge from the apex to the middle would have four triangles.
      if (*apex == line.middle || !uses_of(uses, edge_key(*apex, line.middle)).empty()) continue;
      touched[i] = true;
      touched[neighbour] = true;
      split(triangles_[neighbour], line, triangles_[i]);
      origins_[i] = origins_[neighbour];
      any = true;
    }
    return any;
  }

  // (p, q, x) becomes (p, middle, x) and, in place of the flat one, (middle, q, x).
  static void split(TriangleIndices& neighbour, const Flat& line, TriangleIndices& flat) {
    std::size_t p = 0;
    const auto on_line = [&](std::size_t i) {
      const std::uint32_t corner = neighbour[i % 3];
      return corner == line.a || corner == line.b;
    };
    while (!(on_line(p) && on_line(p + 1))) ++p;
    const std::uint32_t q = neighbour[(p + 1) % 3];
    const std::uint32_t x = neighbour[(p + 2) % 3];
    neighbour[(p + 1) % 3] = line.middle;
    flat = {line.middle, q, x};
  }

  void drop_flat() {
    drop([&](const TriangleIndices& t) { return is_flat(t); });
  }

  void report_lost(MeshFindings& findings) const {
    const std::vector<EdgeUse> uses = edge_uses(triangles_);
    std::vector<bool> used(vertices_.size());
    for (const TriangleIndices& t : triangles_) {
      for (const std::uint32_t vertex : t) used[vertex] = true;
    }
    const auto kept = [&](std::uint32_t a, std::uint32_t b) {
      return a == b ? used[a] : !uses_of(uses, edge_key(a, b)).empty();
    };
    for (const Flat& line : dropped_) {
      // A middle corner without a triangle is on the line, too.
      if (kept(line.a, line.b) || (kept(line.a, line.middle) && kept(line.middle, line.b))) continue;
      ++findings.lost_lines;
      findings.longest_lost_m = std::max(findings.longest_lost_m, (vertices_[line.b] - vertices_[line.a]).norm());
    }
  }

  const Vertices& vertices_;
  Triangles& triangles_;
  Origins& origins_;
  double smallest_height_ = 0;  // m
  std::vector<Flat> dropped_;
};

TriangleIndices sorted(TriangleIndices t) {
  std::ranges::sort(t);
  return t;
}

// Whether two triangles with the same corners run through them in the same sense.
bool same_sense(const TriangleIndices& a, const TriangleIndices& b) {
  std::size_t shift = 0;
  while (b[shift] != a[0]) ++shift;
  return b[(shift + 1) % 3] == a[1];
}

}  // namespace

void remove_degenerate(const Vertices& vertices, Triangles& triangles, Origins& origins, MeshFindings& findings) {
  DegenerateRemover(vertices, triangles, origins).run(findings);
}

void remove_duplicates(Triangles& triangles, Origins& origins, MeshFindings& findings) {
  struct Corners {
    TriangleIndices sorted{};
    std::uint32_t triangle = 0;
    bool operator<(const Corners& other) const {
      return sorted != other.sorted ? sorted < other.sorted : triangle < other.triangle;
    }
  };
  std::vector<Corners> all;
  all.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) all.push_back({sorted(triangles[i]), i});
  std::sort(all.begin(), all.end());
  std::vector<bool> drop(triangles.size());
  for (std::size_t i = 1, first = 0; i < all.size(); ++i) {
    if (all[i].sorted != all[first].sorted) {
      first = i;
      continue;
    }
    drop[all[i].triangle] = true;
    ++findings.duplicate_triangles;
    if (!same_sense(triangles[all[first].triangle], triangles[all[i].triangle])) ++findings.back_to_back;
  }
  if (findings.duplicate_triangles == 0) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (drop[i]) continue;
    triangles[kept] = triangles[i];
    origins[kept++] = origins[i];
  }
  triangles.resize(kept);
  origins.resize(kept);
}

}  // namespace cellmirror::geometry
