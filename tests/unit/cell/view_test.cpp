// From where the cell is looked at, and which way the screen lies.
#include "rt_core/cell/view.hpp"

#include <gtest/gtest.h>

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

class ViewsTest : public ::testing::Test {
 protected:
  Views sut_{Extent{{-2, -1, 0}, {4, 3, 2}}};
};

TEST_F(ViewsTest, EachViewLooksAtTheMiddleOfTheCellAndClipsNothingOfIt) {
  const double radius = 0.5 * Eigen::Vector3d(6, 4, 2).norm();
  for (int id = 0; id < Views::kViews; ++id) {
    const View& view = sut_.view(id);
    EXPECT_LT((view.lookpoint - Eigen::Vector3d(1, 1, 1)).norm(), 1e-12);
    const double distance = (view.viewpoint - view.lookpoint).norm();
    EXPECT_LT(view.near_distance, distance - radius);
    EXPECT_GT(view.far_distance, distance + radius);
  }
  EXPECT_TRUE(sut_.view(1).orthogonal);
  EXPECT_FALSE(sut_.view(0).orthogonal);
}

TEST_F(ViewsTest, CurrentViewIsTheFirstOfTheDisplay) {
  EXPECT_EQ(sut_.current_id(), 0);
  const int expected[] = {0, 1, 3, 4, 5, 6};
  for (int display = 1; display <= Views::kDisplays; ++display) {
    ASSERT_TRUE(sut_.set_display(display, true));
    EXPECT_EQ(sut_.current_id(), expected[display - 1]);
  }
  EXPECT_TRUE(sut_.full_screen());
  EXPECT_FALSE(sut_.set_display(0, false));
  EXPECT_FALSE(sut_.set_display(7, false));
  EXPECT_EQ(sut_.display(), 6);
}

TEST_F(ViewsTest, RefusesViewsThatShowNothingAndKeepsTheOld) {
  const View before = sut_.view(2);
  const auto refused = [&](auto change) {
    View view = before;
    change(view);
    EXPECT_FALSE(sut_.set(2, view));
    EXPECT_EQ(sut_.view(2).viewpoint, before.viewpoint);
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
  EXPECT_FALSE(sut_.set(7, before));
  EXPECT_FALSE(sut_.set(-1, before));
}

}  // namespace
}  // namespace cellmirror
