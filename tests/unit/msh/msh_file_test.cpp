// What is read of .msh files in each format.
#include "config/msh/msh_file.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>

#include "config/msh/tetra_surface.hpp"
#include "tests/unit/msh/msh_text.hpp"

namespace cellmirror::msh {
namespace {

double volume(const tissue::TetraMesh& mesh, std::size_t i) {
  const auto& [a, b, c, d] = mesh.tetrahedra.at(i);
  const Eigen::Vector3d& o = mesh.nodes.at(a);
  return (mesh.nodes.at(b) - o).dot((mesh.nodes.at(c) - o).cross(mesh.nodes.at(d) - o)) / 6.0;
}

struct MshFormats : testing::TestWithParam<std::string> {};

TEST_P(MshFormats, givesTheTetrahedraWithScale) {
  Diagnostics diagnostics;
  const auto sut = parse_msh(GetParam(), "a.msh", 0.5, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
  ASSERT_EQ(sut->nodes.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(sut->nodes[i], 0.5 * Eigen::Vector3d(kNodes.at(i)[0], kNodes.at(i)[1], kNodes.at(i)[2])) << i;
  }
  ASSERT_EQ(sut->tetrahedra.size(), 2U);
  EXPECT_EQ(sut->tetrahedra[0], (std::array<std::uint32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(sut->tetrahedra[1], (std::array<std::uint32_t, 4>{1, 2, 3, 4}));
  EXPECT_NEAR(volume(*sut, 0), 1.0 / 48.0, 1e-15);
  EXPECT_NEAR(volume(*sut, 1), 1.0 / 24.0, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Files, MshFormats,
                         testing::Values(msh1(), msh2(), msh4(), msh2_binary(), msh2_binary(true), msh4_binary(),
                                         msh4_binary(true), "$Comments\nof mine\n$EndComments\n" + msh2(),
                                         with(msh2(), "2.2", "2")));

TEST(MshFile, TurnsInvertedTetrahedraAndSaysSo) {
  Diagnostics diagnostics;
  const auto sut = parse_msh(with(msh2(), "3 4 2 9 1 1 2 3 4", "3 4 2 9 1 1 3 2 4"), "a.msh", 1, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_GT(volume(*sut, 0), 0);
  EXPECT_EQ(diagnostics.text(), "a.msh: note: 1 tetrahedron was inverted; this was corrected while reading\n");
}

TEST(MshFile, TurnsAllWhereTheScaleMirrors) {
  Diagnostics diagnostics;
  const auto sut = parse_msh(msh1(), "a.msh", -1, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_GT(volume(*sut, 0), 0);
  EXPECT_GT(volume(*sut, 1), 0);
}

TEST(MshFile, LeavesOutNodesThatNoTetrahedronUsesAndOtherElements) {
  Diagnostics diagnostics;
  std::string text = with(msh2(), "$Nodes\n5\n", "$Nodes\n13\n");
  text = with(text, "5 1 1 1\n",
              "5 1 1 1\n90 5 0 0\n91 6 0 0\n92 6 1 0\n93 5 1 0\n94 5 0 1\n95 6 0 1\n96 6 1 1\n97 5 1 1\n");
  text = with(text, "$Elements\n4\n", "$Elements\n5\n9 5 2 0 1 90 91 92 93 94 95 96 97\n");
  const auto sut = parse_msh(text, "a.msh", 1, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(sut->nodes.size(), 5U);
  EXPECT_EQ(diagnostics.warnings(), 1U);
  EXPECT_NE(diagnostics.text().find("1 hexahedron, prism or pyramid is left out"), std::string::npos)
      << diagnostics.text();
}

TEST(MshFile, TakesSectionsAndIdsInAnyOrder) {
  Diagnostics diagnostics;
  const std::string nodes = "$Nodes\n5\n70 1 1 1\n-4 0 0 1\n3 0 1 0\n2 1 0 0\n1 0 0 0\n$EndNodes\n";
  const std::string elements = "$Elements\n2\n8 4 0 1 2 3 -4\n6 4 3 1 1 1 2 3 -4 70\n$EndElements\n";
  const auto sut =
      parse_msh("$MeshFormat\r\n2.2 0 8\r\n$EndMeshFormat\r\n" + elements + nodes, "a.msh", 1, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_NEAR(volume(*sut, 0), 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(volume(*sut, 1), 1.0 / 3.0, 1e-15);
}

TEST(MshFile, ReadsTheLiverOfSofa) {
  const char* named = std::getenv("CELLMIRROR_SHARED_DATA");
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  const std::filesystem::path data = named != nullptr    ? std::filesystem::path(named)
                                     : source != nullptr ? std::filesystem::path(source).parent_path() / "shared/data"
                                                         : std::filesystem::path();
  const std::filesystem::path file = data / "tetra/sofa_liver.msh";
  if (data.empty() || !std::filesystem::exists(file)) GTEST_SKIP() << "skipped: shared/data/tetra does not exist";
  Diagnostics diagnostics;
  const auto sut = read_msh(file, 0.03, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(sut->nodes.size(), 181U);
  EXPECT_EQ(sut->tetrahedra.size(), 596U);
  double sum = 0;
  for (std::size_t i = 0; i < sut->tetrahedra.size(); ++i) sum += volume(*sut, i);
  const auto surface = surface_of(*sut);
  ASSERT_TRUE(surface);
  double enclosed = 0;
  for (const auto& [a, b, c] : surface->triangles)
    enclosed += surface->vertices[a].dot(surface->vertices[b].cross(surface->vertices[c])) / 6.0;
  EXPECT_NEAR(enclosed, sum, 1e-9 * sum);
}

}  // namespace
}  // namespace cellmirror::msh
