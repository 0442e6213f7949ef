#include "rt_core/geometry/wide_tree.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/geometry/mesh_tree.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kNoNode = ~0U;
constexpr std::uint32_t kManyTriangles = 256;

// Consecutive triangles: those of a node of the binary tree, or one alone.
struct Part {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t node = kNoNode;  // of the binary tree; a triangle alone has none
  double area = 0;               // of the box; says which part is worth taking apart
};

// A node of the binary tree that still has to become one of the wide tree, and the place that points to it.
struct Waiting {
  Part part;
  std::size_t node = 0;
  std::size_t place = 0;
};

// The least float that is not below.
float round_up(double value) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) >= value ? rounded
                                               : std::nextafter(rounded, std::numeric_limits<float>::infinity());
}

// At right angles: `normal` as nearly as possible the last, `along` the first. The identity if they are degenerate.
Eigen::Matrix3d axes_along(const Vector3d& along, const Vector3d& normal) {
  Eigen::Matrix3d axes;
  axes.col(2) = normal.normalized();
  axes.col(1) = axes.col(2).cross(along).normalized();
  axes.col(0) = axes.col(1).cross(axes.col(2)).normalized();
  const bool sound = axes.allFinite() && (axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm() < 1e-9;
  return sound ? axes : Eigen::Matrix3d::Identity();
}

struct OrientedBox {
  Eigen::Matrix3d axes;  // columns
  Vector3d centre;
  Vector3d half;
  [[nodiscard]] double half_area() const { return half.x() * half.y() + half.y() * half.z() + half.z() * half.x(); }
};

double dot(const Vector3d& a, const Vector3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

OrientedBox box_along(const Eigen::Matrix3d& axes, std::span<const Triangle> triangles) {
  const std::array<Vector3d, 3> columns{axes.col(0), axes.col(1), axes.col(2)};
  Vector3d lower = axes.transpose() * triangles[0][0];
  Vector3d upper = lower;
  for (const Triangle& t : triangles) {
    for (const Vector3d& p : t) {
      for (int k = 0; k < 3; ++k) {
        const double along = dot(columns[static_cast<std::size_t>(k)], p);
        lower[k] = std::min(lower[k], along);
        upper[k] = std::max(upper[k], along);
      }
    }
  }
  return {axes, axes * (0.5 * lower + 0.5 * upper), 0.5 * (upper - lower)};
}

// Along a triangle's longest edge and its normal: no other box of it is smaller.
Eigen::Matrix3d axes_of_triangle(const Triangle& t) {
  Vector3d longest = t[1] - t[0];
  for (const Vector3d& edge : {Vector3d(t[2] - t[1]), Vector3d(t[0] - t[2])}) {
    if (edge.squaredNorm() > longest.squaredNorm()) longest = edge;
  }
  return axes_along(longest, (t[1] - t[0]).cross(t[2] - t[0]));
}

// How a surface extends and which way it faces, weighted by area. A large one is sampled.
class Spread {
 public:
  explicit Spread(std::span<const Triangle> triangles) {
    constexpr std::size_t kEnough = 128;
    const std::size_t step = 1 + triangles.size() / kEnough;
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Vector3d mean = Vector3d::Zero();
    double area = 0;
    const Vector3d about = triangles[0][0];
    for (std::size_t i = 0; i < triangles.size(); i += step) {
      const Triangle& t = triangles[i];
      const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
      const double weight = n.norm();
      const Vector3d middle = (t[0] + t[1] + t[2]) / 3 - about;
      area += weight;
      normal_ += n;
      mean += weight * middle;
      squares += 9 * weight / 12 * middle * middle.transpose();
      for (const Vector3d& p : t) squares += weight / 12 * (p - about) * (p - about).transpose();
    }
    if (!(area > 0)) return;
    mean /= area;
    covariance_ = squares / area - mean * mean.transpose();
  }

  [[nodiscard]] Eigen::Matrix3d principal_axes() const {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance_);
    return axes_along(solver.eigenvectors().col(2), solver.eigenvectors().col(0));
  }
  // The mean normal, and the longest extent at right angles to it.
  [[nodiscard]] Eigen::Matrix3d axes_along_normal() const {
    const Vector3d n = normal_.normalized();
    const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - n * n.transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(flat * covariance_ * flat);
    return axes_along(solver.eigenvectors().col(2), n);
  }

 private:
  Vector3d normal_ = Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

class Builder {
 public:
  Builder(const MeshTree& tree, const Vector3d& origin)
      : nodes_(tree.nodes()), triangles_(tree.triangles()), origin_(origin), counts_(tree.nodes().size()) {
    // Children come after their parents, so iterating from the end visits them first.
    for (std::size_t i = nodes_.size(); i-- > 0;) {
      counts_[i] = nodes_[i].leaf() ? nodes_[i].count : counts_[i + 1] + counts_[nodes_[i].right];
    }
  }

  std::vector<WideNode> build() {
    std::vector<WideNode> out;
    out.reserve(triangles_.size() / 4 + 2);
    out.push_back(empty_node());
    const Part root = part_of(0, 0);
    set_place(out[0], 0, root);
    std::vector<Waiting> waiting;
    settle(root, 0, 0, out, waiting);
    while (!waiting.empty()) {
      const Waiting next = waiting.back();
      waiting.pop_back();
      const std::size_t index = out.size();
      out[next.node].child[next.place] = static_cast<std::uint32_t>(index);
      out.push_back(empty_node());
      std::array<Part, WideNode::kWidth> parts;
      const std::size_t count = take_apart(next.part, parts);
      for (std::size_t i = 0; i < count; ++i) {
        set_place(out[index], i, parts[i]);
        settle(parts[i], index, i, out, waiting);
      }
    }
    return out;
  }

 private:
  static WideNode empty_node() {
    WideNode node;
    node.child.fill(WideTree::kNone);
    for (WideNode::Lanes& lanes : node.centre) lanes.fill(1e30F);
    return node;
  }

  [[nodiscard]] Part part_of(std::uint32_t node, std::uint32_t first) const {
    const Vector3d e = nodes_[node].upper - nodes_[node].lower;
    return {first, counts_[node], counts_[node] > 1 ? node : kNoNode, e.x() * e.y() + e.y() * e.z() + e.z() * e.x()};
  }

  // Whether `more` places are enough to put a part's children in the place of the part.
  [[nodiscard]] bool fits(const Part& part, std::size_t more) const {
    if (part.node == kNoNode) return false;
    return (nodes_[part.node].leaf() ? part.count - 1 : 1U) <= more;
  }

  // Up to eight parts of a node: the largest is taken apart again and again.
  std::size_t take_apart(const Part& whole, std::array<Part, WideNode::kWidth>& parts) const {
    parts[0] = whole;
    std::size_t count = 1;
    while (count < WideNode::kWidth) {
      const std::size_t more = WideNode::kWidth - count;
      std::size_t largest = count;
      for (std::size_t i = 0; i < count; ++i) {
        if (fits(parts[i], more) && (largest == count || parts[i].area > parts[largest].area)) largest = i;
      }
      if (largest == count) break;
      const Part part = parts[largest];
      const MeshTree::Node& node = nodes_[part.node];
      if (node.leaf()) {
        parts[largest] = {part.first, 1, kNoNode, 0};
        for (std::uint32_t k = 1; k < part.count; ++k) parts[count++] = {part.first + k, 1, kNoNode, 0};
      } else {
        parts[largest] = part_of(part.node + 1, part.first);
        parts[count++] = part_of(node.right, part.first + parts[largest].count);
      }
    }
    return count;
  }

  void settle(const Part& part, std::size_t node, std::size_t place, std::vector<WideNode>& out,
              std::vector<Waiting>& waiting) const {
    if (part.node == kNoNode) {
      out[node].child[place] = WideTree::kTriangle | part.first;
    } else {
      waiting.push_back({part, node, place});
    }
  }

  [[nodiscard]] OrientedBox box_of(std::uint32_t node) const {
    const MeshTree::Node& box = nodes_[node];
    return {Eigen::Matrix3d::Identity(), 0.5 * box.lower + 0.5 * box.upper, 0.5 * (box.upper - box.lower)};
  }

  // The smallest box of a few orientations that are likely to fit.
  void set_place(WideNode& node, std::size_t place, const Part& part) const {
    const std::span<const Triangle> triangles = triangles_.subspan(part.first, part.count);
    OrientedBox best = part.node == kNoNode ? box_along(Eigen::Matrix3d::Identity(), triangles) : box_of(part.node);
    const auto consider = [&](const Eigen::Matrix3d& axes) {
      const OrientedBox box = box_along(axes, triangles);
      if (box.half_area() < best.half_area()) best = box;
    };
    if (part.count == 1) {
      consider(axes_of_triangle(triangles[0]));
    } else {
      const Spread spread(triangles);
      consider(spread.principal_axes());
      // Large surfaces have no direction that would be worth the time.
      if (part.count <= kManyTriangles) consider(spread.axes_along_normal());
    }
    const Vector3d centre = best.centre - origin_;
    const Eigen::Vector3f rounded = centre.cast<float>();
    const Eigen::Matrix3f axes = best.axes.cast<float>();
    const Vector3d lost = (rounded.cast<double>() - centre).cwiseAbs();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      node.centre[i][place] = rounded[row];
      node.half[i][place] = round_up(best.half[row] + lost.sum());
      for (std::size_t k = 0; k < 3; ++k) node.axes[k][i][place] = axes(row, static_cast<Eigen::Index>(k));
    }
  }

  std::span<const MeshTree::Node> nodes_;
  std::span<const Triangle> triangles_;
  Vector3d origin_;
  std::vector<std::uint32_t> counts_;  // triangles below each node of the binary tree
};

}  // namespace

WideTree::WideTree(const MeshTree& tree) {
  const MeshTree::Node& root = tree.nodes()[0];
  origin_ = 0.5 * root.lower + 0.5 * root.upper;
  reach_ = 0.5 * (root.upper - root.lower).norm();
  nodes_ = Builder(tree, origin_).build();
  nodes_.shrink_to_fit();
}

}  // namespace cellmirror::geometry
