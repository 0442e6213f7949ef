// Which way triangles face, and whether there is an inside.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "rt_core/geometry/mesh_repair/mesh_repair_steps.hpp"

namespace cellmirror::geometry {

std::vector<EdgeUse> edge_uses(const Triangles& triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[i][k];
      const std::uint32_t to = triangles[i][(k + 1) % 3];
      uses.push_back({edge_key(from, to), i, from < to});
    }
  }
  std::ranges::sort(uses, {}, [](const EdgeUse& use) { return std::pair(use.edge, use.triangle); });
  return uses;
}

double winding_number(const Vertices& vertices, const Triangles& triangles, std::span<const std::uint32_t> which,
                      const Eigen::Vector3d& p) {
  double half_angles = 0.0;
  for (const std::uint32_t i : which) {
    const Eigen::Vector3d a = vertices[triangles[i][0]] - p;
    const Eigen::Vector3d b = vertices[triangles[i][1]] - p;
    const Eigen::Vector3d c = vertices[triangles[i][2]] - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    half_angles += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles / (2.0 * std::numbers::pi);
}

std::span<const EdgeUse> uses_of(const std::vector<EdgeUse>& uses, std::uint64_t edge) {
  const auto range = std::ranges::equal_range(uses, edge, {}, &EdgeUse::edge);
  return {range.begin(), range.end()};
}

namespace {

constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();

struct Neighbour {
  std::uint32_t triangle = kNone;
  bool opposite = false;  // runs through the common edge in the opposite direction, as it should
  bool crowded = false;   // no neighbour, since the edge has more than two triangles
};

// Triangles connected by edges with exactly two of them; after join_shells() also by edges with more.
struct Shell {
  std::vector<std::uint32_t> triangles;
  bool closed = true;
  double volume = 0;  // m3, signed
  Eigen::AlignedBox3d box;
};

class Orienter {
 public:
  Orienter(const Vertices& vertices, Triangles& triangles, MeshFindings& findings)
      : vertices_(vertices),
        triangles_(triangles),
        findings_(findings),
        shell_of_(triangles.size(), kNone),
        seen_(triangles.size()),
        flip_(triangles.size()) {}

  bool run() {
    find_neighbours();
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (!seen_[i]) grow_shell(i);
    }
    join_shells();
    const bool closed = findings_.open_edges == 0 && findings_.crowded_edges == 0 && !findings_.not_orientable;
    for (Shell& shell : closed_shells_) measure(shell);
    turn_outwards();
    return closed && !findings_.flat_shell && !findings_.too_nested;
  }

 private:
  void find_neighbours() {
    neighbours_.resize(triangles_.size());
    std::vector<std::uint8_t> filled(triangles_.size());
    for_each_edge(edge_uses(triangles_), [&](std::span<const EdgeUse> uses) {
      if (uses.size() == 1) ++findings_.open_edges;
      if (uses.size() > 2) crowded_.emplace_back(uses.begin(), uses.end());
      for (const EdgeUse& use : uses) {
        const EdgeUse& other = &use == &uses.front() ? uses.back() : uses.front();
        Neighbour& neighbour = neighbours_[use.triangle][filled[use.triangle]++];
        if (uses.size() == 2) neighbour = {other.triangle, use.forward != other.forward, false};
        neighbour.crowded = uses.size() > 2;
      }
    });
  }

  // Collects a shell and makes it face one way: the way of most of its triangles.
  void grow_shell(std::uint32_t seed) {
    Shell shell;
    seen_[seed] = true;
    shell.triangles.push_back(seed);
    std::size_t flipped = 0;
    bool orientable = true;
    for (std::size_t at = 0; at < shell.triangles.size(); ++at) {
      const std::uint32_t i = shell.triangles[at];
      for (const Neighbour& neighbour : neighbours_[i]) {
        if (neighbour.triangle == kNone) {
          shell.closed = shell.closed && neighbour.crowded;
          continue;
        }
        const bool wanted = flip_[i] == neighbour.opposite;
        if (!seen_[neighbour.triangle]) {
          seen_[neighbour.triangle] = true;
          flip_[neighbour.triangle] = wanted;
          flipped += wanted ? 1 : 0;
          shell.triangles.push_back(neighbour.triangle);
        } else if (flip_[neighbour.triangle] != wanted) {
          orientable = false;
        }
      }
    }
    finish_shell(shell, flipped, orientable);
    ++findings_.shells;
    if (!shell.closed) return;
    for (const std::uint32_t i : shell.triangles) shell_of_[i] = static_cast<std::uint32_t>(closed_shells_.size());
    closed_shells_.push_back(std::move(shell));
  }

  [[nodiscard]] bool runs_forward(const EdgeUse& use) const {
    const TriangleIndices& t = triangles_[use.triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      if (edge_key(t[k], t[(k + 1) % 3]) == use.edge) return t[k] < t[(k + 1) % 3];
    }
    return use.forward;
  }

  // Shells that touch along an edge are closed together where the edge is run through as often in one direction as in
  // the other: there is an inside all the same.
  void join_shells() {
    std::vector<std::uint32_t> root(closed_shells_.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto root_of = [&](std::uint32_t shell) {
      while (root[shell] != shell) shell = root[shell] = root[root[shell]];
      return shell;
    };
    for (const std::vector<EdgeUse>& uses : crowded_) {
      std::ptrdiff_t balance = 0;
      bool closed = true;
      std::uint32_t first = kNone;
      for (const EdgeUse& use : uses) {
        balance += runs_forward(use) ? 1 : -1;
        const std::uint32_t shell = shell_of_[use.triangle];
        closed = closed && shell != kNone;
        if (shell == kNone) continue;
        if (first == kNone) first = root_of(shell);
        root[root_of(shell)] = first;
      }
      if (balance != 0) ++findings_.crowded_edges;
      if (first != kNone && (balance != 0 || !closed)) closed_shells_[first].closed = false;
    }
    for (std::uint32_t i = 0; i < root.size(); ++i) {
      Shell& shell = closed_shells_[i];
      Shell& whole = closed_shells_[root_of(i)];
      if (&shell == &whole) continue;
      whole.triangles.insert(whole.triangles.end(), shell.triangles.begin(), shell.triangles.end());
      whole.closed = whole.closed && shell.closed;
      shell.triangles.clear();
      --findings_.shells;
    }
    std::erase_if(closed_shells_, [](const Shell& shell) { return !shell.closed || shell.triangles.empty(); });
  }

  void finish_shell(Shell& shell, std::size_t flipped, bool orientable) {
    if (!orientable) {
      findings_.not_orientable = true;
      shell.closed = false;
      return;
    }
    const bool turn_all = 2 * flipped > shell.triangles.size();
    findings_.flipped_triangles += turn_all ? shell.triangles.size() - flipped : flipped;
    for (const std::uint32_t i : shell.triangles) {
      if (flip_[i] != turn_all) turn(i);
    }
  }

  void turn(std::uint32_t i) { std::swap(triangles_[i][1], triangles_[i][2]); }

  void measure(Shell& shell) {
    const Eigen::Vector3d o = vertices_[triangles_[shell.triangles.front()][0]];
    double area = 0.0;
    for (const std::uint32_t i : shell.triangles) {
      const auto& [a, b, c] = triangles_[i];
      for (const std::uint32_t vertex : triangles_[i]) shell.box.extend(vertices_[vertex]);
      const Eigen::Vector3d normal = (vertices_[b] - vertices_[a]).cross(vertices_[c] - vertices_[a]);
      shell.volume += (vertices_[a] - o).dot(normal) / 6.0;
      area += 0.5 * normal.norm();
    }
    constexpr double kFlat = 1e-12;
    if (std::abs(shell.volume) > kFlat * area * shell.box.diagonal().norm()) return;
    findings_.flat_shell = true;
    shell.closed = false;
  }

  // A closed shell that faces inwards is a cavity where it lies in another one, else it is inside out.
  void turn_outwards() {
    std::size_t budget = 10'000'000;  // triangles examined: some tenths of a second
    for (Shell& shell : closed_shells_) {
      if (!shell.closed || shell.volume > 0.0) continue;
      const auto inside = lies_inside(shell, budget);
      if (!inside) {
        findings_.too_nested = true;
        return;
      }
      if (*inside) continue;
      for (const std::uint32_t i : shell.triangles) turn(i);
      shell.volume = -shell.volume;
      ++findings_.inside_out_shells;
    }
  }

  // Whether an odd number of other closed shells contain the shell; nothing where the budget is spent.
  std::optional<bool> lies_inside(const Shell& shell, std::size_t& budget) const {
    const auto& [a, b, c] = triangles_[shell.triangles.front()];
    const Eigen::Vector3d p = (vertices_[a] + vertices_[b] + vertices_[c]) / 3.0;
    bool inside = false;
    for (const Shell& other : closed_shells_) {
      if (budget == 0) return std::nullopt;
      --budget;
      if (&other == &shell || !other.closed || !other.box.contains(p)) continue;
      if (budget < other.triangles.size()) return std::nullopt;
      budget -= other.triangles.size();
      if (std::abs(winding_number(vertices_, triangles_, other.triangles, p)) > 0.5) inside = !inside;
    }
    return inside;
  }

  const Vertices& vertices_;
  Triangles& triangles_;
  MeshFindings& findings_;
  std::vector<std::array<Neighbour, 3>> neighbours_;
  std::vector<std::vector<EdgeUse>> crowded_;
  std::vector<std::uint32_t> shell_of_;  // in closed_shells_, until they are joined
  std::vector<bool> seen_;
  std::vector<bool> flip_;
  std::vector<Shell> closed_shells_;
};

}  // namespace

bool orient(const Vertices& vertices, Triangles& triangles, MeshFindings& findings) {
  return Orienter(vertices, triangles, findings).run();
}

}  // namespace cellmirror::geometry
