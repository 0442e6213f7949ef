#include "config/msh/tetra_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "config/msh/msh_file.hpp"
#include "tests/unit/msh/msh_text.hpp"

namespace cellmirror::msh {
namespace {

TEST(TetraSurface, IsWhatBelongsToOneTetrahedronAndFacesOutwards) {
  Diagnostics diagnostics;
  const auto mesh = parse_msh(msh2(), "a.msh", 1, diagnostics);
  ASSERT_TRUE(mesh) << diagnostics.text();
  const auto sut = surface_of(*mesh);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->vertices.size(), 5U);
  EXPECT_EQ(sut->triangles.size(), 6U);
  double volume = 0;
  for (const auto& [a, b, c] : sut->triangles) {
    volume += sut->vertices[a].dot(sut->vertices[b].cross(sut->vertices[c])) / 6.0;
    // Each edge is run through in both directions.
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      const auto back = std::ranges::count_if(sut->triangles, [&](const auto& t) {
        return (t[0] == to && t[1] == from) || (t[1] == to && t[2] == from) || (t[2] == to && t[0] == from);
      });
      EXPECT_EQ(back, 1);
    }
  }
  EXPECT_NEAR(volume, 0.5, 1e-15);
}

TEST(TetraSurface, LeavesOutInnerNodes) {
  // A tetrahedron divided into four about a node in its middle.
  tissue::TetraMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.2, 0.2}};
  mesh.tetrahedra = {{4, 1, 2, 3}, {0, 4, 2, 3}, {0, 1, 4, 3}, {0, 1, 2, 4}};
  const auto sut = surface_of(mesh);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->vertices.size(), 4U);
  EXPECT_EQ(sut->triangles.size(), 4U);
}

}  // namespace
}  // namespace cellmirror::msh
