#include "rt_core/geometry/wide_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rt_core/geometry/mesh_tree.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kNoNode = ~0U;

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

class Builder {
 public:
  Builder(const MeshTree& tree, const Vector3d& origin)
      : nodes_(tree.nodes()), triangles_(tree.triangles()), origin_(origin), counts_(tree.nodes().size()) {
    // Children stand behind their parents, so counting from the end meets them first.
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

  void set_place(WideNode& node, std::size_t place, const Part& part) const {
    Vector3d lower = triangles_[part.first][0];
    Vector3d upper = lower;
    Vector3d normal = Vector3d::Zero();
    double area = 0;
    for (std::uint32_t i = part.first; i < part.first + part.count; ++i) {
      const Triangle& t = triangles_[i];
      for (const Vector3d& p : t) {
        lower = lower.cwiseMin(p);
        upper = upper.cwiseMax(p);
      }
      const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
      normal += n;
      area += n.norm();
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const double low = lower[axis] - origin_[axis];
      const double high = upper[axis] - origin_[axis];
      const auto centre = static_cast<float>(0.5 * low + 0.5 * high);
      node.centre[k][place] = centre;
      node.half[k][place] = round_up(std::max(high - centre, centre - low));
    }
    if (normal.norm() > 0.5 * area) set_slab(node, place, part, normal.normalized());
  }

  void set_slab(WideNode& node, std::size_t place, const Part& part, const Vector3d& unit) const {
    // A little shorter than 1 also after rounding, so that widths along it are never overstated.
    const Eigen::Vector3f n = ((1 - 1e-6) * unit).cast<float>();
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::uint32_t i = part.first; i < part.first + part.count; ++i) {
      for (const Vector3d& p : triangles_[i]) {
        const double height = n.cast<double>().dot(p - origin_);
        low = std::min(low, height);
        high = std::max(high, height);
      }
    }
    const auto middle = static_cast<float>(0.5 * low + 0.5 * high);
    for (int axis = 0; axis < 3; ++axis) node.normal[static_cast<std::size_t>(axis)][place] = n[axis];
    node.middle[place] = middle;
    node.thick[place] = round_up(std::max(high - middle, middle - low));
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
