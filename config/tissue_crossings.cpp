#include "config/tissue_crossings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "rt_core/geometry/mesh_tree.hpp"

namespace cellmirror {

using geometry::MeshTree;
using geometry::TriangleIndices;
using geometry::TriangleMesh;

namespace {

constexpr double kTouching = 1e-9;  // of the mesh's size
constexpr double kOnEdge = 1e-9;    // of barycentric coordinates

class CrossingSearch {
 public:
  explicit CrossingSearch(const std::shared_ptr<const TriangleMesh>& mesh) : mesh_(*mesh), tree_(mesh) {
    const auto& root = tree_.nodes().front();
    touching_ = kTouching * (root.upper - root.lower).norm();
  }

  SelfCrossings run() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs{{0, 0}};
    while (!pairs.empty() && found_.pairs < kMostCrossings) {
      if (++compared_ > kMostComparisons) {
        found_.complete = false;
        break;
      }
      const auto [a, b] = pairs.back();
      pairs.pop_back();
      const MeshTree::Node& left = tree_.nodes()[a];
      const MeshTree::Node& right = tree_.nodes()[b];
      if (a != b && !overlap(left, right)) continue;
      if (left.leaf() && right.leaf()) {
        compare(left, right);
      } else if (a == b) {
        pairs.insert(pairs.end(), {{a + 1, a + 1}, {left.right, left.right}, {a + 1, left.right}});
      } else if (right.leaf() || (!left.leaf() && size(left) > size(right))) {
        pairs.insert(pairs.end(), {{a + 1, b}, {left.right, b}});
      } else {
        pairs.insert(pairs.end(), {{a, b + 1}, {a, right.right}});
      }
    }
    return found_;
  }

 private:
  static double size(const MeshTree::Node& node) { return (node.upper - node.lower).squaredNorm(); }
  static bool overlap(const MeshTree::Node& a, const MeshTree::Node& b) {
    return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
  }

  void compare(const MeshTree::Node& left, const MeshTree::Node& right) {
    const bool same = &left == &right;
    for (std::uint32_t i = 0; i < left.count; ++i) {
      for (std::uint32_t k = same ? i + 1 : 0; k < right.count; ++k) {
        ++compared_;
        const TriangleIndices& a = mesh_.triangles[tree_.original(left.right + i)];
        const TriangleIndices& b = mesh_.triangles[tree_.original(right.right + k)];
        auto at = crossing(a, b);
        if (!at) at = crossing(b, a);
        if (!at) continue;
        if (found_.pairs++ == 0) found_.place = *at;
      }
    }
  }

  // Where an edge of `a` that has no corner of `b` passes through `b`.
  [[nodiscard]] std::optional<Eigen::Vector3d> crossing(const TriangleIndices& a, const TriangleIndices& b) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = a[k];
      const std::uint32_t to = a[(k + 1) % 3];
      if (std::ranges::find(b, from) != b.end() || std::ranges::find(b, to) != b.end()) continue;
      if (const auto at = passes(mesh_.vertices[from], mesh_.vertices[to], b)) return at;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<Eigen::Vector3d> passes(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                                      const TriangleIndices& triangle) const {
    const Eigen::Vector3d& o = mesh_.vertices[triangle[0]];
    const Eigen::Vector3d u = mesh_.vertices[triangle[1]] - o;
    const Eigen::Vector3d v = mesh_.vertices[triangle[2]] - o;
    const Eigen::Vector3d normal = u.cross(v);
    const double twice_area = normal.norm();
    if (twice_area <= 0) return std::nullopt;
    const double before = normal.dot(from - o) / twice_area;
    const double behind = normal.dot(to - o) / twice_area;
    if (std::min(before, behind) > -touching_ || std::max(before, behind) < touching_) return std::nullopt;
    const Eigen::Vector3d p = from + before / (before - behind) * (to - from);
    const double along_u = normal.dot((p - o).cross(v)) / (twice_area * twice_area);
    const double along_v = normal.dot(u.cross(p - o)) / (twice_area * twice_area);
    const bool inside = along_u > -kOnEdge && along_v > -kOnEdge && along_u + along_v < 1 + kOnEdge;
    return inside ? std::optional(p) : std::nullopt;
  }

  const TriangleMesh& mesh_;
  MeshTree tree_;
  double touching_ = 0;
  std::size_t compared_ = 0;
  SelfCrossings found_;
};

}  // namespace

SelfCrossings find_self_crossings(const std::shared_ptr<const TriangleMesh>& mesh) {
  return CrossingSearch(mesh).run();
}

}  // namespace cellmirror
