#include "rt_core/geometry/tree_build.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>

#include "rt_core/base/contract.hpp"

namespace cellmirror::geometry {

namespace {

constexpr int kBins = 16;

struct Box {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d upper = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  void add(const Eigen::Vector3d& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  void add(const Box& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  [[nodiscard]] double half_area() const {
    const Eigen::Vector3d e = upper - lower;
    return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
  }
};

// A triangle's box and the middle of it; kept in the order of the tree while it is being built.
struct Item {
  Box box;
  Eigen::Vector3d middle;
  std::uint32_t triangle = 0;
};

struct Range {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  int level = 1;
  std::uint32_t parent = 0;  // whose right child it is; the root and left children: their own index
  [[nodiscard]] std::uint32_t count() const { return end - begin; }
};

struct Cut {
  int axis = -1;  // -1: none
  int bin = 0;    // the first of the right side
  double cost = std::numeric_limits<double>::infinity();
};

// Written so that what is no number ends up in a bin as well.
int bin_of(double middle, double lower, double bins_per_metre) {
  const double bin = (middle - lower) * bins_per_metre;
  if (!(bin > 0)) return 0;
  return bin < kBins ? static_cast<int>(bin) : kBins - 1;
}

double scale_of(const Box& middles, int axis) {
  const double extent = middles.upper[axis] - middles.lower[axis];
  const double scale = kBins / extent;
  return extent > 0 && scale < std::numeric_limits<double>::max() ? scale : 0;
}

struct Bins {
  std::array<Box, kBins> box;
  std::array<std::uint32_t, kBins> count{};
};

void best_of_axis(const Bins& bins, int axis, Cut& best) {
  std::array<double, kBins> right_cost{};
  Box box;
  std::uint32_t count = 0;
  for (int b = kBins - 1; b > 0; --b) {
    const auto i = static_cast<std::size_t>(b);
    if (bins.count[i] > 0) box.add(bins.box[i]);
    count += bins.count[i];
    right_cost[i] = count > 0 ? box.half_area() * count : -1;
  }
  box = Box{};
  count = 0;
  for (int b = 1; b < kBins; ++b) {
    const auto i = static_cast<std::size_t>(b);
    if (bins.count[i - 1] > 0) box.add(bins.box[i - 1]);
    count += bins.count[i - 1];
    if (count == 0 || right_cost[i] < 0) continue;
    const double cost = box.half_area() * count + right_cost[i];
    if (cost < best.cost) best = {axis, b, cost};
  }
}

Cut best_cut(std::span<const Item> items, const Box& middles) {
  std::array<Bins, 3> bins;
  const Eigen::Vector3d scale{scale_of(middles, 0), scale_of(middles, 1), scale_of(middles, 2)};
  for (const Item& item : items) {
    for (int axis = 0; axis < 3; ++axis) {
      if (scale[axis] == 0) continue;
      const auto b = static_cast<std::size_t>(bin_of(item.middle[axis], middles.lower[axis], scale[axis]));
      Bins& of_axis = bins[static_cast<std::size_t>(axis)];
      of_axis.box[b].add(item.box);
      ++of_axis.count[b];
    }
  }
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    if (scale[axis] > 0) best_of_axis(bins[static_cast<std::size_t>(axis)], axis, best);
  }
  return best;
}

// Index of the first item of the right side; always strictly inside of the range.
std::uint32_t split(std::vector<Item>& items, const Range& range, const Box& middles) {
  const std::uint32_t half = range.begin + range.count() / 2;
  // Halving by number needs no more levels than the count has bits.
  if (MeshTree::kMaxDepth - range.level <= static_cast<int>(std::bit_width(range.count()))) return half;
  const std::span<Item> part(items.data() + range.begin, range.count());
  const Cut cut = best_cut(part, middles);
  if (cut.axis < 0) return half;
  const double lower = middles.lower[cut.axis];
  const double scale = scale_of(middles, cut.axis);
  const auto right = std::partition(part.begin(), part.end(), [&](const Item& item) {
    return bin_of(item.middle[cut.axis], lower, scale) < cut.bin;
  });
  return range.begin + static_cast<std::uint32_t>(right - part.begin());
}

std::vector<Item> items_of(const TriangleMesh& mesh) {
  std::vector<Item> items(mesh.triangles.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) items[i].box.add(mesh.vertices[v]);
    items[i].middle = 0.5 * items[i].box.lower + 0.5 * items[i].box.upper;
    items[i].triangle = i;
  }
  return items;
}

}  // namespace

BinaryTree build_binary_tree(const TriangleMesh& mesh) {
  CELLMIRROR_EXPECTS(!mesh.triangles.empty() && mesh.triangles.size() <= MeshTree::kMaxTriangles);
  std::vector<Item> items = items_of(mesh);
  BinaryTree tree;
  tree.nodes.reserve(items.size());
  std::vector<Range> waiting = {{0, static_cast<std::uint32_t>(items.size()), 1, 0}};
  while (!waiting.empty()) {
    const Range range = waiting.back();
    waiting.pop_back();
    const auto index = static_cast<std::uint32_t>(tree.nodes.size());
    if (range.parent != index) tree.nodes[range.parent].right = index;
    tree.depth = std::max(tree.depth, range.level);
    Box box;
    Box middles;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      box.add(items[i].box);
      middles.add(items[i].middle);
    }
    MeshTree::Node& node = tree.nodes.emplace_back(MeshTree::Node{box.lower, box.upper, range.begin, range.count()});
    if (range.count() <= MeshTree::kTrianglesInLeaf) continue;
    node.count = 0;
    const std::uint32_t middle = split(items, range, middles);
    waiting.push_back({middle, range.end, range.level + 1, index});
    waiting.push_back({range.begin, middle, range.level + 1, index + 1});
  }
  tree.order.resize(items.size());
  std::transform(items.begin(), items.end(), tree.order.begin(), [](const Item& item) { return item.triangle; });
  return tree;
}

}  // namespace cellmirror::geometry
