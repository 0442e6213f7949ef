#include <gtest/gtest.h>

#include "config/file_finder.hpp"
#include "config/parse.hpp"
#include "tests/unit/config/temporary_home.hpp"
#include "tests/unit/volume_files/volume_text.hpp"

namespace cellmirror {
namespace {

class VolumeTableOfComponent : public testing::Test {
 protected:
  std::optional<Component> read(const std::string& keys) {
    diagnostics_ = {};
    return parse_component("format = 1\n[volume]\n" + keys, "part.mpc", HomeFiles(*KismetHome::open(home_.root())),
                           diagnostics_);
  }
  void write_volume(const std::string& name) const {
    home_.write("envlib/" + name, nrrd_head("spacings: 1 2 3\n") + "\n" + bytes_of(counting<std::int16_t>(24)));
  }
  TemporaryHome home_;
  Diagnostics diagnostics_;
};

TEST_F(VolumeTableOfComponent, HasTheMiddleAtTheOriginUnlessItSaysOtherwise) {
  write_volume("a.nrrd");
  const auto middle = read("source = \"a.nrrd\"\n");
  ASSERT_TRUE(middle && diagnostics_.ok()) << diagnostics_.text();
  ASSERT_TRUE(middle->volume && middle->volume->grid);
  EXPECT_TRUE(middle->volume->X_CV.isApprox(Pose::Identity()));
  EXPECT_EQ(middle->volume->settings, VolumeSettings());
  EXPECT_FALSE(middle->volume->grid->hounsfield);
  EXPECT_EQ(middle->volume->grid->name, "part");
  const auto corner = read("source = \"a.nrrd\"\norigin = \"corner\"\nxyz_m = [1, 0, 0]\nhounsfield = true\n");
  ASSERT_TRUE(corner && diagnostics_.ok()) << diagnostics_.text();
  EXPECT_TRUE(corner->volume->X_CV.translation().isApprox(Eigen::Vector3d(1.002, 0.003, 0.003)));
  EXPECT_TRUE(corner->volume->grid->hounsfield);
}

TEST_F(VolumeTableOfComponent, SaysTablesPlanesAndTheIsosurfaceOfTheStart) {
  write_volume("a.nrrd");
  const auto sut = read(
      "source = \"a.nrrd\"\ntable = \"LIN_LUT\"\nisosurface = 300\nmedical = { air = 0.5, bone = 0.25 }\n"
      "parameters = [{ table = \"LIN_LUT\", opacity = 2, gain = 3, level = 1.5, window_rad = 1 }]\n"
      "plane = [{ plane = \"CLP3\", clip = \"reverse\", visible = true, elevation_rad = 0.5, azimuth_rad = -0.5,"
      " distance_m = 0.02 }]\n");
  ASSERT_TRUE(sut && diagnostics_.ok()) << diagnostics_.text();
  const VolumeSettings& settings = sut->volume->settings;
  EXPECT_EQ(settings.table, VolumeTable::linear);
  EXPECT_TRUE(settings.isosurface);
  EXPECT_EQ(settings.iso_value, 300);
  EXPECT_EQ(settings.medical, (MedicalTableParameters{0.5, 0.1, 0.3, 0.25}));
  EXPECT_EQ(settings.parameters[1], (VolumeTableParameters{2, 3, 1.5, 1}));
  EXPECT_EQ(settings.planes[2], (VolumePlane{VolumePlaneSide::before, true, 0.5, -0.5, 0.02}));
  EXPECT_EQ(settings.planes[0], VolumePlane());
}

TEST_F(VolumeTableOfComponent, ReportsWhatIsWrongWithFileAndLine) {
  write_volume("a.nrrd");
  read("source = \"b.nrrd\"\n");
  EXPECT_NE(diagnostics_.text().find("part.mpc:3:"), std::string::npos) << diagnostics_.text();
  EXPECT_NE(diagnostics_.text().find("did you mean a.nrrd?"), std::string::npos) << diagnostics_.text();
  home_.write("envlib/short.nrrd", nrrd_head() + "\nxx");
  read("source = \"short.nrrd\"\n");
  EXPECT_NE(diagnostics_.text().find("part.mpc:3:10: error: the volume short.nrrd: short.nrrd has"), std::string::npos)
      << diagnostics_.text();
  home_.write("envlib/type.nrrd", nrrd_head("", "block") + "\n");
  read("source = \"type.nrrd\"\n");
  EXPECT_NE(diagnostics_.text().find("type.nrrd:2: error: the type block is not read"), std::string::npos)
      << diagnostics_.text();
  read("source = \"a.nrrd\"\norigin = \"patient\"\n");
  EXPECT_NE(diagnostics_.text().find("has no coordinates of its own"), std::string::npos) << diagnostics_.text();
  read("source = \"a.nrrd\"\ntable = \"MY_LUT\"\n");
  EXPECT_NE(diagnostics_.text().find("write one of MEDICAL_LUT, LIN_LUT"), std::string::npos) << diagnostics_.text();
  read("source = \"../a.nrrd\"\n");
  EXPECT_FALSE(diagnostics_.ok());
}

TEST_F(VolumeTableOfComponent, SharesASourceWhileItIsUsed) {
  write_volume("a.nrrd");
  const HomeFiles files(*KismetHome::open(home_.root()));
  Diagnostics diagnostics;
  const VolumeRequest request{"a.nrrd", {}, {}, "a"};
  const auto first = files.volume(request, {}, diagnostics);
  const auto second = files.volume(request, {}, diagnostics);
  ASSERT_TRUE(first);
  EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace cellmirror
