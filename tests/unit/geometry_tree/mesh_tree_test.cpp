#include "rt_core/geometry/mesh_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "shapes.hpp"

namespace cellmirror::geometry {
namespace {

using test::share;

// Counts the triangles below a node and checks every promise of the header on the way.
std::uint32_t check_below(const MeshTree& tree, std::uint32_t index, int level, int& deepest) {
  const MeshTree::Node& node = tree.nodes()[index];
  deepest = std::max(deepest, level);
  if (node.leaf()) {
    EXPECT_LE(node.count, MeshTree::kTrianglesInLeaf);
    for (std::uint32_t i = node.right; i < node.right + node.count; ++i) {
      for (const Eigen::Vector3d& p : tree.triangles()[i]) {
        EXPECT_TRUE((p.array() >= node.lower.array()).all() && (p.array() <= node.upper.array()).all());
      }
    }
    return node.count;
  }
  std::uint32_t count = 0;
  for (const std::uint32_t child : {index + 1, node.right}) {
    EXPECT_GT(child, index);
    EXPECT_TRUE((tree.nodes()[child].lower.array() >= node.lower.array()).all());
    EXPECT_TRUE((tree.nodes()[child].upper.array() <= node.upper.array()).all());
    count += check_below(tree, child, level + 1, deepest);
  }
  return count;
}

void expect_sound(const MeshTree& sut) {
  int deepest = 0;
  EXPECT_EQ(check_below(sut, 0, 1, deepest), sut.mesh().triangles.size());
  EXPECT_EQ(deepest, sut.depth());
  EXPECT_LE(sut.depth(), MeshTree::kMaxDepth);
  std::set<std::uint32_t> seen;
  for (std::uint32_t i = 0; i < sut.triangles().size(); ++i) {
    seen.insert(sut.original(i));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(sut.triangles()[i][k], sut.mesh().vertices[sut.mesh().triangles[sut.original(i)][k]]);
    }
  }
  EXPECT_EQ(seen.size(), sut.mesh().triangles.size());
}

TEST(MeshTree, HoldsEveryTriangleOnceInBoxesThatContainIt) {
  expect_sound(MeshTree(share(test::icosphere(0.3, 4))));
  expect_sound(MeshTree(share(test::soup(1000, 0.2, 1))));
  expect_sound(MeshTree(share(test::box_mesh({1, 2, 3}))));
}

TEST(MeshTree, OfASingleTriangleIsOneLeaf) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const MeshTree sut(share(mesh));
  expect_sound(sut);
  EXPECT_EQ(sut.nodes().size(), 1U);
  EXPECT_EQ(sut.depth(), 1);
}

TEST(MeshTree, StaysFlatWhereAllTrianglesHaveOneCentre) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const double s = 1 + i;
    mesh.vertices.insert(mesh.vertices.end(), {{-s, -s, 0}, {s, -s, 0}, {0, s, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const MeshTree sut(share(mesh));
  expect_sound(sut);
  EXPECT_LE(sut.depth(), 14);
}

TEST(MeshTree, StaysBoundedWhereEverySplitTakesOneTriangleOff) {
  TriangleMesh mesh;
  double x = 1e-300;
  for (std::uint32_t i = 0; i < 3000; ++i, x *= 1.55) {
    mesh.vertices.insert(mesh.vertices.end(), {{x, 0, 0}, {x, x, 0}, {x, 0, x}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    if (x > 1e200) x = 1e-300;
  }
  expect_sound(MeshTree(share(mesh)));
}

TEST(MeshTree, KnowsTheShellsOfAMesh) {
  EXPECT_EQ(MeshTree(share(test::icosphere(1, 2))).shells().size(), 1U);
  const MeshTree sut(share(test::joined(test::box_mesh({1, 1, 1}), test::box_mesh({1, 1, 1}, {5, 0, 0}))));
  ASSERT_EQ(sut.shells().size(), 2U);
  EXPECT_EQ(sut.shells()[0].extremes[0].x(), -0.5);
  EXPECT_EQ(sut.shells()[0].extremes[1].x(), 0.5);
  EXPECT_EQ(sut.shells()[1].extremes[0].x(), 4.5);
  EXPECT_EQ(sut.shells()[1].extremes[1].x(), 5.5);
}

}  // namespace
}  // namespace cellmirror::geometry
