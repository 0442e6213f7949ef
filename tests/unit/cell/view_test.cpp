// From where the cell is looked at, and which way the screen lies.
#include "rt_core/cell/view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cellmirror {
namespace {

void expect_axes(const View& view, const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  const Eigen::Matrix3d sut = screen_axes(view);
  EXPECT_LT((sut.col(0) - x).norm(), 1e-12) << sut;
  EXPECT_LT((sut.col(1) - y).norm(), 1e-12) << sut;
  EXPECT_LT((sut.col(2) - x.cross(y)).norm(), 1e-12) << sut;
}

TEST(ScreenAxes, FromTheSideTheWorldsZIsUp) {
  View view;
  view.viewpoint = {0, -5, 0};
  expect_axes(view, {1, 0, 0}, {0, 0, 1});
  view.viewpoint = {5, 0, 0};
  expect_axes(view, {0, 1, 0}, {0, 0, 1});
}

TEST(ScreenAxes, FromAboveAndBelowTheWorldsYIsUp) {
  View view;
  view.viewpoint = {0, 0, 5};
  expect_axes(view, {1, 0, 0}, {0, 1, 0});
  view.viewpoint = {0, 0, -5};
  expect_axes(view, {-1, 0, 0}, {0, 1, 0});
}

TEST(ScreenAxes, TwistTurnsTheScreenAboutItsOwnZ) {
  View view;
  view.viewpoint = {0, 0, 5};
  view.twist = std::numbers::pi / 2;
  expect_axes(view, {0, 1, 0}, {-1, 0, 0});
}

TEST(Views, EachLooksAtTheMiddleOfTheCellAndClipsNothingOfIt) {
  const auto sut = views_of_extent({{-2, -1, 0}, {4, 3, 2}});
  const double radius = 0.5 * Eigen::Vector3d(6, 4, 2).norm();
  for (const View& view : sut) {
    EXPECT_LT((view.lookpoint - Eigen::Vector3d(1, 1, 1)).norm(), 1e-12);
    const double distance = (view.viewpoint - view.lookpoint).norm();
    EXPECT_LT(view.near_distance, distance - radius);
    EXPECT_GT(view.far_distance, distance + radius);
  }
  EXPECT_TRUE(sut[1].orthogonal);
  EXPECT_FALSE(sut[0].orthogonal);
}

TEST(Views, TheCellFillsAPictureOfFourToThreeAndNothingIsOutsideOfIt) {
  const Extent extent{{-2, -1, 0}, {4, 3, 2}};
  for (const View& view : views_of_extent(extent)) {
    const double distance = (view.viewpoint - view.lookpoint).norm();
    double farthest = 0;  // 1: at an edge of the picture
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d p_W((corner & 1) != 0 ? 4 : -2, (corner & 2) != 0 ? 3 : -1, (corner & 4) != 0 ? 2 : 0);
      const Eigen::Vector3d p_S = screen_axes(view).transpose() * (p_W - view.viewpoint);
      const double half = (view.orthogonal ? distance : -p_S.z()) * std::tan(0.5 * view.opening_angle);
      farthest = std::max({farthest, std::abs(p_S.y()) / half, std::abs(p_S.x()) / (4.0 / 3.0 * half)});
    }
    EXPECT_LT(farthest, 1.0);
    EXPECT_GT(farthest, 0.85);
  }
}

TEST(Views, StandWhereTheLayoutHasThemAndShowTheWholeCellInANarrowPane) {
  const Extent extent{{-2, -1, 0}, {4, 3, 2}};
  DisplayLayout layout;
  layout.views[4].towards_viewer = {3, 0, 0};
  layout.views[0].orthogonal = true;
  layout.displays[1].panes = {{.view = 1, .left = 0, .top = 0, .width = 0.25, .height = 1}};
  const auto sut = views_of_extent(extent, layout);
  EXPECT_LT((sut[4].viewpoint - sut[4].lookpoint).normalized().cross(Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_GT(sut[4].viewpoint.x(), sut[4].lookpoint.x());
  EXPECT_TRUE(sut[0].orthogonal);
  const double height = 2 * (sut[1].viewpoint - sut[1].lookpoint).norm() * std::tan(0.5 * sut[1].opening_angle);
  EXPECT_GT(height / 3.0, 6.0) << "a third as wide as high";
  EXPECT_EQ(sut[3].viewpoint, views_of_extent(extent)[3].viewpoint) << "the same view in a whole picture";
}

TEST(Views, ChangeLeavesWhatItDoesNotName) {
  View before;
  before.twist = 0.25;
  ViewChange change;
  change.opening_angle = 0.5;
  change.far_distance = 7.0;
  const View sut = changed_by(before, change);
  EXPECT_EQ(sut.viewpoint, before.viewpoint);
  EXPECT_EQ(sut.twist, 0.25);
  EXPECT_EQ(sut.opening_angle, 0.5);
  EXPECT_EQ(sut.far_distance, 7.0);
}

TEST(Views, RefusesThoseThatShowNothing) {
  const View good;
  EXPECT_TRUE(check_view(2, good));
  const auto refused = [&](auto change) {
    View view = good;
    change(view);
    EXPECT_FALSE(check_view(2, view));
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  refused([](View& view) { view.viewpoint = view.lookpoint; });
  refused([](View& view) { view.viewpoint.x() = kNan; });
  refused([](View& view) { view.lookpoint.y() = 1e9; });
  refused([](View& view) { view.twist = kNan; });
  refused([](View& view) { view.opening_angle = 0; });
  refused([](View& view) { view.opening_angle = 3.2; });
  refused([](View& view) { view.near_distance = view.far_distance; });
  refused([](View& view) { view.near_distance = -1; });
  View far = good;
  far.viewpoint.x() = 2e4;
  EXPECT_NE(check_view(2, far).error().what.find("10000 m (10000000 mm)"), std::string::npos);
  EXPECT_FALSE(check_view(7, good));
  EXPECT_FALSE(check_view(-1, good));
}

}  // namespace
}  // namespace cellmirror
