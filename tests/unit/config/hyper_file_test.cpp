// Hyper files; what is refused stands in tests/golden/config/bad/tissue_hyper.
#include "config/hyper_file.hpp"

#include <gtest/gtest.h>

#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

const char* const kLigament =
    "format = 1\ndescription = \"two\"\n"
    "[[connection]]\nname = \"ligament\"\nobject_a = \"liver.mpo\"\nobject_b = \"gallbladder.mpo\"\n"
    "point_a_m = [0.01, 0.02, 0.03]\npoint_b_m = [0, 0, 0.1]\nradius_m = 0.015\nstiffness_n_m = 80\n"
    "tear_force_n = 4\n"
    "[[connection]]\nobject_a = \"gallbladder.mpo\"\npoint_a_m = [1, 0, 0]\npoint_b_m = [2, 0, 0]\n";

TEST(HyperFile, TakesEveryKeyAndConnectsWithTheWorldWithoutSecondObject) {
  Diagnostics diagnostics;
  const auto sut = parse_hyper(kLigament, "a.hyper", nullptr, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(sut->file, "a.hyper");
  ASSERT_EQ(sut->connections.size(), 2U);
  const tissue::Connection& first = sut->connections[0];
  EXPECT_EQ(first.name, "ligament");
  EXPECT_EQ(first.object_a, "liver.mpo");
  EXPECT_EQ(first.object_b, "gallbladder.mpo");
  EXPECT_EQ(first.point_a, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(first.point_b, Eigen::Vector3d(0, 0, 0.1));
  EXPECT_EQ(first.radius_m, 0.015);
  EXPECT_EQ(first.stiffness_n_m, 80);
  EXPECT_EQ(first.tear_force_n, 4);
  const tissue::Connection& second = sut->connections[1];
  EXPECT_TRUE(second.name.empty());
  EXPECT_TRUE(second.object_b.empty());
  EXPECT_EQ(second.radius_m, 0);
  EXPECT_EQ(second.stiffness_n_m, tissue::Connection().stiffness_n_m);
  EXPECT_EQ(second.tear_force_n, 0);
}

TEST(HyperFile, MayHaveNoConnections) {
  Diagnostics diagnostics;
  const auto sut = parse_hyper("format = 1\n", "a.hyper", nullptr, diagnostics);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_TRUE(sut->connections.empty());
}

TEST(HyperFile, IsRefusedWithTooManyConnections) {
  std::string many = "format = 1\n";
  for (std::size_t i = 0; i <= kMostConnections; ++i)
    many += "[[connection]]\nobject_a = \"a.mpo\"\npoint_a_m = [0, 0, 0]\npoint_b_m = [0, 0, 0]\n";
  Diagnostics diagnostics;
  EXPECT_FALSE(parse_hyper(many, "a.hyper", nullptr, diagnostics));
  EXPECT_NE(diagnostics.text().find("there are 257 tables connection, more than 256"), std::string::npos)
      << diagnostics.text();
}

TEST(HyperFile, IsFoundInEnvlibAndComparedWithTheObjectsOfTheCell) {
  const TemporaryHome home;
  home.write("envlib/bonds.hyper", kLigament);
  const KismetHome folder = KismetHome::open(home.root()).value();
  std::vector<std::string> objects = {"liver.mpo", "gallbladder.mpo"};
  const auto sut = load_hyper(folder, "bonds", objects);
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->connections.size(), 2U);
  objects[1] = "gallblader.mpo";
  const auto refused = load_hyper(folder, "bonds.hyper", objects);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("bonds.hyper:6:12: error: connection ligament: there is no object "
                                        "gallbladder.mpo; did you mean gallblader.mpo? (and 1 more)"),
            std::string::npos)
      << refused.error().text();
  EXPECT_FALSE(load_hyper(folder, "../bonds.hyper", objects));
  EXPECT_FALSE(load_hyper(folder, "none.hyper", objects));
}

}  // namespace
}  // namespace cellmirror
