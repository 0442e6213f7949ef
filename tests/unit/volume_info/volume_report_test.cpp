#include "app/volume_info/volume_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

// fontconfig keeps its configuration until the process ends; the leak sanitizer asks by this name what is known.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }
// NOLINTEND(bugprone-reserved-identifier)

namespace cellmirror::app {
namespace {

VolumeData small_volume() {
  VolumeData volume;
  volume.grid.size = {4, 3, 2};
  volume.grid.spacing_m = {0.0005, 0.0007, 0.0015};
  volume.grid.values = std::vector<std::int16_t>(24, 7);
  volume.grid.hounsfield = true;
  volume.facts.kind = "DICOM series";
  volume.facts.files = {"b", "a"};
  volume.X_PV = Pose::Identity();
  return volume;
}

TEST(VolumeReport, SaysSizeSpacingAndValues) {
  const VolumeData volume = small_volume();
  const std::string sut = volume_text(volume, summarise(volume.grid));
  for (const char* text : {"DICOM series", "4 x 3 x 2 voxels", "0.5 x 0.7 x 1.5 mm", "2 x 2.1 x 3 mm", "7 to 7 HU",
                           "tissue 100.0 %", "2: b ... a"})
    EXPECT_NE(sut.find(text), std::string::npos) << text << "\n" << sut;
}

TEST(VolumeReport, IsJsonWithWarnings) {
  const VolumeData volume = small_volume();
  Diagnostics diagnostics;
  diagnostics.warning({}, "a \"link\" is not read");
  const auto sut = nlohmann::json::parse(volume_json("ct", volume, summarise(volume.grid), diagnostics));
  EXPECT_EQ(sut.at("size"), (std::vector<int>{4, 3, 2}));
  EXPECT_EQ(sut.at("values").at("least"), 7);
  EXPECT_EQ(sut.at("warnings").at(0), "a \"link\" is not read");
  EXPECT_EQ(sut.at("X_PV").at("z").at(2), 1);
  EXPECT_EQ(sut.at("bytes"), 48);
}

TEST(VolumeReport, HasAFigureOfThreeSlicesInTheirProportions) {
  const VolumeData volume = small_volume();
  const plot::Figure sut = volume_figure("ct", volume, summarise(volume.grid), {40, 400});
  ASSERT_EQ(sut.panels.size(), 4U);
  EXPECT_EQ(sut.panels[0].image.width, 4);
  EXPECT_EQ(sut.panels[0].image.height, 3);
  EXPECT_DOUBLE_EQ(sut.panels[0].x.high, 1.0);
  EXPECT_NEAR(sut.panels[1].y.high, 1.5, 1e-12);
  const auto png = plot::png_of(sut);
  ASSERT_TRUE(png) << png.error().text();
  EXPECT_TRUE(png->starts_with("\x89PNG"));
}

}  // namespace
}  // namespace cellmirror::app
