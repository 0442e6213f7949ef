#include "config/volume/dicom_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "config/volume/dicom_slices.hpp"

namespace cellmirror {
namespace {

std::vector<SlicePlace> stack(std::size_t count, double distance = 2.0) {
  std::vector<SlicePlace> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    // Names that say nothing about the order.
    out[i].file = "f" + std::to_string((i * 7 + 3) % 11);
    out[i].position = {10, 20, -5 + distance * static_cast<double>(i)};
    out[i].row_spacing = 0.7;
    out[i].column_spacing = 0.5;
  }
  return out;
}

std::string why_no_series(const std::vector<SlicePlace>& slices) {
  SeriesGeometry out;
  Diagnostics diagnostics;
  EXPECT_FALSE(find_series_geometry(slices, 100, 50, out, diagnostics));
  return diagnostics.text();
}

TEST(SeriesOfSlices, IsOrderedByPositionAlongTheNormal) {
  auto slices = stack(5);
  std::swap(slices[0], slices[3]);
  std::swap(slices[1], slices[4]);
  SeriesGeometry sut;
  Diagnostics diagnostics;
  ASSERT_TRUE(find_series_geometry(slices, 100, 50, sut, diagnostics)) << diagnostics.text();
  EXPECT_EQ(sut.order, (std::vector<std::size_t>{3, 4, 2, 0, 1}));
  EXPECT_TRUE(sut.spacing_m.isApprox(Eigen::Vector3d(0.0005, 0.0007, 0.002)));
  EXPECT_TRUE(sut.shear.empty());
  // 49.5 columns of 0.5 mm, 24.5 rows of 0.7 mm, 2 slices of 2 mm from (10, 20, -5) mm.
  EXPECT_TRUE(sut.X_PV.translation().isApprox(Eigen::Vector3d(0.03475, 0.03715, -0.001), 1e-12));
  EXPECT_EQ(diagnostics.all().size(), 0U);
}

TEST(SeriesOfSlices, GoesFromTheHeadToTheFeetWhereTheNormalDoes) {
  auto slices = stack(3);
  for (SlicePlace& slice : slices) slice.column = -Eigen::Vector3d::UnitY();
  SeriesGeometry sut;
  Diagnostics diagnostics;
  ASSERT_TRUE(find_series_geometry(slices, 100, 50, sut, diagnostics)) << diagnostics.text();
  EXPECT_EQ(sut.order, (std::vector<std::size_t>{2, 1, 0}));
  EXPECT_NEAR(sut.X_PV.linear().determinant(), 1, 1e-12);
}

TEST(SeriesOfSlices, NamesMissingUnevenAndDoubleSlices) {
  auto slices = stack(9);
  slices.erase(slices.begin() + 4, slices.begin() + 6);
  EXPECT_NE(why_no_series(slices).find("slices are missing between"), std::string::npos);
  EXPECT_NE(why_no_series(slices).find("about 2, at a usual distance of 2.000 mm"), std::string::npos);
  slices = stack(9);
  slices[4].position.z() += 0.3;
  EXPECT_NE(why_no_series(slices).find("is 2.300 mm, elsewhere 2.000 mm"), std::string::npos);
  slices = stack(9);
  slices.push_back(slices[2]);
  slices.back().file = "again";
  EXPECT_NE(why_no_series(slices).find("again are at the same place"), std::string::npos);
  EXPECT_NE(why_no_series(stack(1)).find("1 slice"), std::string::npos);
}

TEST(SeriesOfSlices, IsWarnedAboutWhereDistancesAreRounded) {
  auto slices = stack(9, 2.0);
  slices[4].position.z() += 0.05;
  SeriesGeometry sut;
  Diagnostics diagnostics;
  ASSERT_TRUE(find_series_geometry(slices, 100, 50, sut, diagnostics)) << diagnostics.text();
  EXPECT_EQ(diagnostics.warnings(), 1U);
  EXPECT_NEAR(sut.spacing_m.z(), 0.002, 1e-12);
}

TEST(SeriesOfSlices, IsRefusedWithOtherDirectionsOrSpacings) {
  auto slices = stack(4);
  slices[2].row = Eigen::Vector3d::UnitZ();
  EXPECT_NE(why_no_series(slices).find("has another orientation than"), std::string::npos);
  slices = stack(4);
  slices[2].row_spacing = 0.8;
  EXPECT_NE(why_no_series(slices).find("has another pixel spacing than"), std::string::npos);
  slices = stack(4);
  for (SlicePlace& slice : slices) slice.row = {1, 0.5, 0};
  EXPECT_NE(why_no_series(slices).find("not at right angles"), std::string::npos);
  slices = stack(4);
  slices[2].position.x() += 3;
  EXPECT_NE(why_no_series(slices).find("beside the line"), std::string::npos);
}

TEST(SeriesOfSlices, OfATiltedGantryIsShearedAlongItsColumns) {
  auto slices = stack(11);
  const double tilt = 15 * std::numbers::pi / 180;
  // The table moves along z; the slices are tilted about x.
  for (SlicePlace& slice : slices) slice.column = {0, std::cos(tilt), -std::sin(tilt)};
  SeriesGeometry sut;
  Diagnostics diagnostics;
  ASSERT_TRUE(find_series_geometry(slices, 100, 50, sut, diagnostics)) << diagnostics.text();
  EXPECT_NEAR(sut.tilt_rad, tilt, 1e-9);
  EXPECT_NEAR(sut.spacing_m.z(), 0.002 * std::cos(tilt), 1e-9);
  ASSERT_EQ(sut.shear.size(), 11U);
  EXPECT_NEAR(sut.shear[10].y(), -20 * std::sin(tilt) / 0.7, 1e-9);
  EXPECT_NEAR(sut.shear[10].x(), 0, 1e-9);
  const ShearedExtent extent = sheared_extent(sut);
  EXPECT_EQ(extent.more[0], 0U);
  EXPECT_EQ(extent.more[1], 8U);  // 7.4 rows
}

}  // namespace
}  // namespace cellmirror
