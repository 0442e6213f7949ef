// The displays of STDP, cameras in them, and cameras that track.
#include <gtest/gtest.h>

#include <numbers>

#include "rt_core/scene/cameras.hpp"
#include "rt_core/scene/panes.hpp"
#include "tests/unit/scene/small_cell.hpp"

namespace cellmirror::scene {
namespace {

class Panes : public ::testing::Test {
 protected:
  [[nodiscard]] PaneInput input() const { return {cell_.cell, cell_.poses, cell_.display, Timestamp{1}, 0}; }
  [[nodiscard]] std::vector<int> views() const {
    std::vector<int> ids;
    for (const Pane& pane : panes_of_display(input())) ids.push_back(pane.view);
    return ids;
  }
  SmallCell cell_;
};

TEST_F(Panes, EachDisplayHasTheViewsOfTheManual) {
  const std::array<std::vector<int>, kDisplays> wanted = {{{0}, {1, 2}, {3}, {4}, {5}, {6}}};
  for (int display = 1; display <= static_cast<int>(kDisplays); ++display) {
    cell_.display.display = display;
    EXPECT_EQ(views(), wanted[static_cast<std::size_t>(display - 1)]) << "display " << display;
  }
}

TEST_F(Panes, TheTopViewStandsAboveTheSideViewAndTheyFillThePicture) {
  cell_.display.display = 2;
  const auto sut = panes_of_display(input());
  ASSERT_EQ(sut.size(), 2U);
  EXPECT_EQ(sut[0].top, 0);
  EXPECT_EQ(sut[0].height, 0.5);
  EXPECT_EQ(sut[1].top, 0.5);
  EXPECT_EQ(sut[1].height, 0.5);
  EXPECT_EQ(sut[1].width, 1);
  EXPECT_EQ(sut[0].title, "1 top");
  EXPECT_EQ(sut[1].title, "2 side");
}

TEST_F(Panes, StandWhereTheLayoutHasThemUnderItsNames) {
  cell_.display.layout.views[5].name = "gate";
  cell_.display.layout.displays[1].panes = {{.view = 5, .left = 0.25, .top = 0.125, .width = 0.5, .height = 0.75},
                                            {.view = 0, .left = 0.75, .top = 0, .width = 0.25, .height = 1}};
  cell_.display.display = 2;
  const auto sut = panes_of_display(input());
  ASSERT_EQ(sut.size(), 2U);
  EXPECT_EQ(sut[0].view, 5);
  EXPECT_EQ(sut[0].title, "5 gate");
  EXPECT_EQ(sut[0].left, 0.25);
  EXPECT_EQ(sut[0].top, 0.125);
  EXPECT_EQ(sut[0].width, 0.5);
  EXPECT_EQ(sut[0].height, 0.75);
  EXPECT_EQ(sut[1].title, "0 perspective");
  cell_.display.full_screen = true;
  EXPECT_EQ(views(), (std::vector<int>{5, 0}));
  EXPECT_EQ(panes_of_display(input())[0].width, 0.5);
}

TEST_F(Panes, FullIsTheSameLayoutWithoutTitles) {
  cell_.display.display = 2;
  cell_.display.full_screen = true;
  const auto sut = panes_of_display(input());
  ASSERT_EQ(sut.size(), 2U);
  EXPECT_EQ(sut[0].view, 1);
  EXPECT_EQ(sut[1].view, 2);
  EXPECT_EQ(sut[1].top, 0.5);
  for (const Pane& pane : sut) EXPECT_TRUE(pane.title.empty());
}

TEST_F(Panes, TellThroughWhichCameraTheyLook) {
  constexpr std::uint32_t kCamera = SmallCell::camera + 1;
  EXPECT_EQ(panes_of_display(input())[0].camera, 0U);
  EXPECT_EQ((*panes_of_camera(input(), "CAM"))[0].camera, kCamera);
  cell_.display.views[3].camera = "Table.CAM";
  EXPECT_EQ(panes_of_view(input(), 3)[0].camera, kCamera);
  EXPECT_EQ(panes_of_view(input(), 4)[0].camera, 0U);
  cell_.display.views[3].camera = "gone";
  EXPECT_EQ(panes_of_view(input(), 3)[0].camera, 0U);
  cell_.display.modes.set(static_cast<std::size_t>(DisplayMode::camera_main_view));
  EXPECT_EQ(panes_of_display(input())[0].camera, kCamera);
}

TEST_F(Panes, OfAnUnknownDisplayThePerspective) {
  cell_.display.display = 99;
  EXPECT_EQ(views(), std::vector<int>{0});
}

TEST_F(Panes, TheTitleNamesTheCameraOfTheView) {
  cell_.display.views[0].camera = "CAM";
  EXPECT_EQ(panes_of_display(input())[0].title, "0 CAM");
  cell_.display.views[0].camera = "gone";
  EXPECT_EQ(panes_of_display(input())[0].title, "0 perspective");
}

TEST_F(Panes, TheMainViewOfACameraIsClippedAsTheBirdsEyeView) {
  cell_.display.display = 2;
  cell_.display.modes.set(static_cast<std::size_t>(DisplayMode::camera_main_view));
  cell_.display.views[6].view.far_distance = 7;
  const auto sut = panes_of_display(input());
  ASSERT_EQ(sut.size(), 1U);
  EXPECT_EQ(sut[0].view, 6);
  EXPECT_EQ(sut[0].title, "CAM");
  EXPECT_EQ(sut[0].eye.far_distance, 7);
  EXPECT_LT((sut[0].eye.X_WE.translation() - Eigen::Vector3d(2, 0, 1.5)).norm(), 1e-12);
  cell_.cell.cameras.clear();
  EXPECT_EQ(views(), (std::vector<int>{1, 2}));
}

TEST_F(Panes, OneCameraByNameOrTheNearestNames) {
  const auto sut = panes_of_camera(input(), "CAM");
  ASSERT_TRUE(sut.has_value());
  EXPECT_EQ((*sut)[0].view, -1);
  EXPECT_DOUBLE_EQ((*sut)[0].eye.opening_angle, 0.5);
  const auto refused = panes_of_camera(input(), "CAN");
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().text().find("CAM"), std::string::npos) << refused.error().text();
}

TEST_F(Panes, OneViewFillsThePicture) {
  const auto sut = panes_of_view(input(), 4);
  ASSERT_EQ(sut.size(), 1U);
  EXPECT_EQ(sut[0].view, 4);
  EXPECT_EQ(sut[0].width, 1);
  EXPECT_TRUE(sut[0].title.empty());
}

TEST_F(Panes, APictureOfACameraBeginsBehindItsOwnHousing) {
  const auto add = [&](std::int32_t node, double z, double length) {
    auto geometry = std::make_shared<Geometry>();
    geometry->shape = Shape::box;
    geometry->size = {0.08, 0.08, length};
    geometry->X_NG.translation().z() = z;
    cell_.cell.geometry.push_back({node, geometry});
  };
  EXPECT_LE((*panes_of_camera(input(), "CAM"))[0].eye.near_distance, 0.05) << "the table is not a housing";
  add(SmallCell::camera, 0, 0.12);           // to 60 mm
  add(SmallCell::table, 1.0 + 0.085, 0.05);  // what it is fixed to: from 60 to 110 mm
  add(SmallCell::camera, 0.5, 0.1);          // beyond a gap
  EXPECT_NEAR((*panes_of_camera(input(), "CAM"))[0].eye.near_distance, 1.02 * 0.11, 1e-12);
}

class Tracking : public Panes {
 protected:
  Tracking() {
    // Looks along the world's y: x to the right, y down.
    Pose& X_WC = cell_.poses.X_WN[SmallCell::camera];
    X_WC.linear() = Eigen::AngleAxisd(-0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
    X_WC.translation() << 0, -4, 2;
    cell_.display.cameras.resize(1);
    cell_.display.cameras[0].name = "CAM";
    cell_.display.cameras[0].tracks = "Tool";
  }
  [[nodiscard]] CameraNow now() const { return *camera_now(cell_.cell, cell_.poses, cell_.display, "CAM"); }
};

TEST_F(Tracking, TurnsAboutItsPositionUntilItLooksAtTheFrame) {
  for (const double angle : {0.0, 0.7, 1.5, 2.9, -2.0}) {
    cell_.poses.X_WN[SmallCell::tool].translation() << 3 * std::cos(angle), 3 * std::sin(angle), 0.3;
    const CameraNow sut = now();
    const Eigen::Vector3d p_WT = cell_.poses.X_WN[SmallCell::tool].translation();
    const Eigen::Vector3d ahead = sut.X_WC * Eigen::Vector3d(0, 0, sut.focal_distance_m);
    EXPECT_TRUE(sut.tracking);
    EXPECT_LT((ahead - p_WT).norm(), 1e-9) << angle;
    EXPECT_EQ(sut.X_WC.translation(), Eigen::Vector3d(0, -4, 2));
    EXPECT_NEAR(sut.X_WC.linear().col(0).z(), 0, 1e-12) << "the horizon stays level";
  }
}

TEST_F(Tracking, TellsHowFarItTurned) {
  // 3 m to the right and 4 m ahead, then as far down.
  cell_.poses.X_WN[SmallCell::tool].translation() << 3, 0, -3;
  const CameraNow sut = now();
  EXPECT_NEAR(sut.pan_rad, std::atan2(3, 4), 1e-12);
  EXPECT_NEAR(sut.tilt_rad, -0.25 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(sut.focal_distance_m, std::sqrt(50), 1e-12);
}

TEST_F(Tracking, WhatIsNotThereOrOnTheSpotTurnsNothing) {
  const Pose X_WC = cell_.poses.X_WN[SmallCell::camera];
  cell_.poses.X_WN[SmallCell::tool].translation() = X_WC.translation();
  EXPECT_FALSE(now().tracking);
  EXPECT_EQ(now().X_WC.matrix(), X_WC.matrix());
  cell_.display.cameras[0].tracks = "gone";
  EXPECT_EQ(now().X_WC.matrix(), X_WC.matrix());
  EXPECT_EQ(now().focal_distance_m, 2.0);
}

TEST_F(Tracking, AMirroredHeadIsShownAsItIs) {
  const Pose X_WC = cell_.poses.X_WN[SmallCell::camera];
  cell_.display.cameras[0].mirrored = true;
  EXPECT_EQ(now().X_WC.matrix(), X_WC.matrix());
}

TEST_F(Tracking, AViewAtTheCameraFollows) {
  cell_.display.views[0].camera = "CAM";
  const View sut = view_now(input(), 0);
  EXPECT_LT((sut.lookpoint - cell_.poses.X_WN[SmallCell::tool].translation()).norm(), 1e-9);
}

}  // namespace
}  // namespace cellmirror::scene
