// Where a view is now, and the eye that sees it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rt_core/scene/panes.hpp"
#include "tests/unit/scene/small_cell.hpp"

namespace cellmirror::scene {
namespace {

constexpr double kPi = std::numbers::pi;

// Where a point is seen: x and y of the picture's half height, from the middle.
Eigen::Vector2d seen(const Eye& eye, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_E = eye.X_WE.inverse() * p_W;
  const double half = eye.height_m > 0 ? 0.5 * eye.height_m : -p_E.z() * std::tan(0.5 * eye.opening_angle);
  return p_E.head<2>() / half;
}

void expect_seen(const View& view, const Eigen::Vector3d& p_W, double x, double y) {
  const Eigen::Vector2d at = seen(eye_of(view), p_W);
  EXPECT_NEAR(at.x(), x, 1e-12);
  EXPECT_NEAR(at.y(), y, 1e-12);
}

View view_from(const Eigen::Vector3d& viewpoint, double opening_angle = 0.5 * kPi) {
  View view;
  view.viewpoint = viewpoint;
  view.opening_angle = opening_angle;
  return view;
}

TEST(Eye, TheLookpointIsInTheMiddleAndTheOpeningAngleReachesTheUpperEdge) {
  expect_seen(view_from({0, -5, 0}), {0, 0, 0}, 0, 0);
  expect_seen(view_from({0, -5, 0}), {0, 0, 5}, 0, 1);  // 45 degrees of 90
  expect_seen(view_from({0, -5, 0}), {5, 0, 0}, 1, 0);
  expect_seen(view_from({0, -5, 0}, 2 * std::atan(0.1)), {0.5, 0, 0}, 1, 0);
}

TEST(Eye, TwistTurnsTheScreenSoThatThePictureTurnsTheOtherWay) {
  View view = view_from({0, -5, 0});
  view.twist = 0.5 * kPi;
  expect_seen(view, {0, 0, 5}, 1, 0);
  view.twist = 0.3;
  expect_seen(view, {0, 0, 5}, std::sin(0.3), std::cos(0.3));
}

TEST(Eye, StraightDownTheWorldsYIsUpAndTwistCounts) {
  View view = view_from({0, 0, 5});
  expect_seen(view, {0, 5, 0}, 0, 1);
  expect_seen(view, {5, 0, 0}, 1, 0);
  view.twist = 0.5 * kPi;
  expect_seen(view, {0, 5, 0}, 1, 0);
  expect_seen(view_from({0, 0, -5}), {5, 0, 0}, -1, 0);
}

TEST(Eye, AParallelViewShowsTheLookpointsPlaneAsThePerspectiveOneDoes) {
  View view = view_from({1, -4, 2}, 0.8);
  view.lookpoint = {1, 2, 2};
  View parallel = view;
  parallel.orthogonal = true;
  EXPECT_DOUBLE_EQ(eye_of(parallel).height_m, 2 * 6 * std::tan(0.4));
  const Eigen::Vector3d in_plane(2.3, 2, 1.1);
  EXPECT_LT((seen(eye_of(view), in_plane) - seen(eye_of(parallel), in_plane)).norm(), 1e-12);
  const Eigen::Vector3d behind = in_plane + Eigen::Vector3d(0, 3, 0);
  EXPECT_LT((seen(eye_of(parallel), behind) - seen(eye_of(parallel), in_plane)).norm(), 1e-12);
}

TEST(Eye, HasTheClippingPlanesOfTheView) {
  View view;
  view.near_distance = 0.2;
  view.far_distance = 1e6;
  EXPECT_EQ(eye_of(view).near_distance, 0.2);
  EXPECT_EQ(eye_of(view).far_distance, 1e6);
  view.near_distance = 0;
  EXPECT_EQ(eye_of(view).near_distance, 0);
}

TEST(Eye, AViewpointOnItsLookpointStillLooksSomewhere) {
  View view;
  view.viewpoint = view.lookpoint = {1, 2, 3};
  const Eye sut = eye_of(view);
  EXPECT_TRUE(sut.X_WE.matrix().allFinite());
  EXPECT_NEAR(sut.X_WE.linear().determinant(), 1.0, 1e-12);
}

TEST(Between, EveryParameterGoesEvenly) {
  View from = view_from({0, -4, 0}, 0.4);
  View to = view_from({8, 4, 2}, 0.8);
  to.lookpoint = {1, 2, 3};
  to.twist = 1;
  to.near_distance = 1.05;
  to.far_distance = 300;
  const View sut = between(from, to, 0.25);
  EXPECT_LT((sut.viewpoint - Eigen::Vector3d(2, -2, 0.5)).norm(), 1e-12);
  EXPECT_LT((sut.lookpoint - Eigen::Vector3d(0.25, 0.5, 0.75)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(sut.twist, 0.25);
  EXPECT_DOUBLE_EQ(sut.opening_angle, 0.5);
  EXPECT_DOUBLE_EQ(sut.near_distance, 0.3);
  EXPECT_DOUBLE_EQ(sut.far_distance, 150);
}

TEST(Between, EndsAreExactAndNothingLiesBeyondThem) {
  const View from = view_from({0.1, -4, 0});
  const View to = view_from({8, 4.7, 2});
  EXPECT_EQ(between(from, to, -1).viewpoint, from.viewpoint);
  EXPECT_EQ(between(from, to, 0).viewpoint, from.viewpoint);
  EXPECT_EQ(between(from, to, 1).viewpoint, to.viewpoint);
  EXPECT_EQ(between(from, to, 7).viewpoint, to.viewpoint);
}

class ViewNow : public ::testing::Test {
 protected:
  [[nodiscard]] View now(double s, std::uint64_t updates = 0) const {
    return view_now({cell_.cell, cell_.poses, cell_.display, Timestamp{1'000'000'000 + std::llround(1e9 * s)}, updates},
                    3);
  }
  ViewSequence& sequence() {
    DisplayView& shown = cell_.display.views[3];
    shown.view = view_from({4, -5, 0});
    shown.sequence = ViewSequence{};
    shown.sequence->from = view_from({0, -5, 0});
    shown.sequence->to = shown.view;
    shown.sequence->begin = Timestamp{1'000'000'000};
    return *shown.sequence;
  }
  SmallCell cell_;
};

TEST_F(ViewNow, ASequenceByTimeGoesByTheClock) {
  ViewSequence& way = sequence();
  way.duration = std::chrono::seconds(4);
  EXPECT_NEAR(now(-0.5).viewpoint.x(), 0, 1e-12);
  EXPECT_NEAR(now(1, 99).viewpoint.x(), 1, 1e-12);
  EXPECT_NEAR(now(3).viewpoint.x(), 3, 1e-12);
  EXPECT_NEAR(now(9).viewpoint.x(), 4, 1e-12);
  EXPECT_FALSE(ended(way, Timestamp{4'999'999'999}, 0));
  EXPECT_TRUE(ended(way, Timestamp{5'000'000'000}, 0));
}

TEST_F(ViewNow, ASequenceByStepsGoesByTheUpdatesOfThePicture) {
  ViewSequence& steps = sequence();
  steps.first_step = 100;
  steps.steps = 8;
  EXPECT_NEAR(now(50, 90).viewpoint.x(), 0, 1e-12);
  EXPECT_NEAR(now(50, 102).viewpoint.x(), 1, 1e-12);
  EXPECT_NEAR(now(50, 108).viewpoint.x(), 4, 1e-12);
  EXPECT_FALSE(ended(steps, {}, 107));
  EXPECT_TRUE(ended(steps, {}, 108));
}

TEST_F(ViewNow, AViewAtACameraSeesWhatTheCameraSees) {
  cell_.cell.X_PF[SmallCell::camera].linear() =
      (Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())).toRotationMatrix();
  cell_.poses.X_WN[SmallCell::camera].linear() = cell_.cell.X_PF[SmallCell::camera].linear();
  cell_.display.views[3].camera = "CAM";
  cell_.display.views[3].view.orthogonal = true;
  cell_.display.views[3].view.near_distance = 2;
  const View sut = now(0);
  const Pose& X_WC = cell_.poses.X_WN[SmallCell::camera];
  EXPECT_FALSE(sut.orthogonal);
  EXPECT_DOUBLE_EQ(sut.opening_angle, 0.5);
  EXPECT_LE(sut.near_distance, 0.05);
  EXPECT_LT((sut.lookpoint - X_WC * Eigen::Vector3d(0, 0, 2)).norm(), 1e-12);
  // Right, down and ahead of the camera are right, down and into the picture.
  const Eigen::Matrix3d R_WE = eye_of(sut).X_WE.linear();
  EXPECT_LT((R_WE.col(0) - X_WC.linear().col(0)).norm(), 1e-9);
  EXPECT_LT((R_WE.col(1) + X_WC.linear().col(1)).norm(), 1e-9);
  EXPECT_LT((R_WE.col(2) + X_WC.linear().col(2)).norm(), 1e-9);
}

TEST_F(ViewNow, ACameraThatLooksStraightDownKeepsItsTwist) {
  Pose& X_WC = cell_.poses.X_WN[SmallCell::camera];
  X_WC.linear() = (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  cell_.display.views[3].camera = "Table.CAM";
  const Eigen::Matrix3d R_WE = eye_of(now(0)).X_WE.linear();
  EXPECT_LT((R_WE.col(0) - X_WC.linear().col(0)).norm(), 1e-9);
  EXPECT_LT((R_WE.col(1) + X_WC.linear().col(1)).norm(), 1e-9);
}

TEST_F(ViewNow, WithoutTheCameraTheViewIsItsOwn) {
  cell_.display.views[3].view = view_from({4, -5, 0});
  cell_.display.views[3].camera = "gone";
  EXPECT_EQ(now(0).viewpoint, Eigen::Vector3d(4, -5, 0));
}

}  // namespace
}  // namespace cellmirror::scene
