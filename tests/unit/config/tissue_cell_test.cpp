// [[deformable]] and [tissue] of cell files; what else is refused stands in tests/golden/config/bad/tissue_cell.
#include <gtest/gtest.h>

#include <numbers>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

struct TissueCell : testing::Test {
  TissueCell() {
    home.write("envlib/tetra.msh",
               "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n$ELM\n1\n1 4 1 1 4 1 2 3 4\n$ENDELM\n");
    for (const char* name : {"liver", "gallbladder"})
      home.write(std::string("envlib/") + name + ".mpo", "format = 1\n[volume]\nmsh = \"tetra.msh\"\nscale = 0.1\n");
    home.write("envlib/bonds.hyper",
               "format = 1\n[[connection]]\nobject_a = \"liver.mpo\"\nobject_b = \"gallbladder.mpo\"\npoint_a_m = [0, "
               "0, 0]\npoint_b_m = [0, 0, 0]\n");
  }
  std::optional<LoadedCell> load(const std::string& text) {
    diagnostics = {};
    return load_cell(home.write("cell.toml",
                                "format = 1\nname = \"c\"\n[[node]]\nname = \"Table\"\nxyz_m = [1, 2, 3]\n"
                                "rpy_rad = [0, 0, 1.5707963267948966]\n" +
                                    text),
                     diagnostics);
  }
  TemporaryHome home;
  Diagnostics diagnostics;
};

TEST_F(TissueCell, HasNoObjectsByDefault) {
  const auto sut = load("");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_TRUE(sut->tissue.objects.empty());
  EXPECT_TRUE(sut->tissue.connections.empty());
  EXPECT_TRUE(sut->tissue.hyper_file.empty());
}

TEST_F(TissueCell, PlacesObjectsInTheWorldOrInAFrame) {
  const auto sut = load(
      "[[deformable]]\nobject = \"liver\"\nxyz_m = [0.1, 0.2, 0.3]\nrpy_rad = [0.1, 0.2, 0.3]\n"
      "[[deformable]]\nobject = \"gallbladder.mpo\"\npredecessor = \"Table\"\nxyz_m = [1, 0, 0]\n"
      "[tissue]\nhyper = \"bonds.hyper\"\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  ASSERT_EQ(sut->tissue.objects.size(), 2U);
  EXPECT_EQ(sut->tissue.objects[0].name, "liver.mpo");
  EXPECT_TRUE(sut->tissue.objects[0].X_WO.isApprox(
      pose_from_xyz_rpy(Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(0.1, 0.2, 0.3))));
  EXPECT_EQ(sut->tissue.objects[1].name, "gallbladder.mpo");
  EXPECT_TRUE(sut->tissue.objects[1].X_WO.translation().isApprox(Eigen::Vector3d(1, 3, 3)));
  EXPECT_EQ(sut->tissue.objects[1].volume.tetrahedra.size(), 1U);
  ASSERT_EQ(sut->tissue.connections.size(), 1U);
  EXPECT_EQ(sut->tissue.connections[0].object_b, "gallbladder.mpo");
  EXPECT_TRUE(sut->tissue.hyper_file.ends_with("envlib/bonds.hyper"));
}

TEST_F(TissueCell, IsRefusedWithAnUnknownFrame) {
  EXPECT_FALSE(load("[[deformable]]\nobject = \"liver.mpo\"\npredecessor = \"Tabel\"\n"));
  EXPECT_NE(diagnostics.text().find("cell.toml:9:15: error: "), std::string::npos) << diagnostics.text();
  EXPECT_NE(diagnostics.text().find("Table"), std::string::npos) << diagnostics.text();
}

TEST_F(TissueCell, IsRefusedWithConnectionsOfOtherObjects) {
  EXPECT_FALSE(load("[[deformable]]\nobject = \"liver.mpo\"\n[tissue]\nhyper = \"bonds\"\n"));
  EXPECT_NE(diagnostics.text().find("bonds.hyper:4:12: error: connection 1: there is no object gallbladder.mpo; the "
                                    "objects are liver.mpo"),
            std::string::npos)
      << diagnostics.text();
}

TEST_F(TissueCell, IsRefusedWithTooManyObjects) {
  std::string many;
  for (std::size_t i = 0; i <= kMostObjects; ++i) many += "[[deformable]]\nobject = \"liver.mpo\"\n";
  EXPECT_FALSE(load(many));
  EXPECT_NE(diagnostics.text().find("there are 17 tables deformable, more than 16"), std::string::npos)
      << diagnostics.text();
}

TEST_F(TissueCell, FilesOfObjectsAreCheckedAlone) {
  ASSERT_TRUE(load("")) << diagnostics.text();  // the cell folder is where a cell.toml is
  for (const char* name : {"envlib/liver.mpo", "envlib/bonds.hyper", "envlib/tetra.msh"}) {
    const auto path = home.root() / name;
    EXPECT_TRUE(is_checkable(path));
    Diagnostics found;
    check_file(path, found);
    EXPECT_TRUE(found.all().empty()) << found.text();
    Diagnostics damaged;
    check_file(home.write(name, "$"), damaged);
    EXPECT_FALSE(damaged.ok()) << name;
  }
}

}  // namespace
}  // namespace cellmirror
