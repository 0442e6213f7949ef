// Where the head of the transfer cell's camera has to turn.
#include "rt_core/scene/camera_mount.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/cell_file.hpp"

namespace cellmirror::scene {
namespace {

std::filesystem::path cell_file() {
  const char* folder = std::getenv("CELLMIRROR_SOURCE_DIR");
  const std::filesystem::path source =
      folder != nullptr ? std::filesystem::path(folder)
                        : std::filesystem::path(__FILE__).parent_path().parent_path().parent_path().parent_path();
  return source / "config/cells/transfer_cell/cell.toml";
}

class CameraMountTest : public ::testing::Test {
 protected:
  CameraMountTest() {
    Diagnostics diagnostics;
    auto loaded = load_cell(cell_file(), diagnostics);
    EXPECT_TRUE(loaded) << diagnostics.text();
    cell_ = loaded->cell.compile();
    q_ = loaded->cell.start_positions();
    hand_ = loaded->cell.path(*loaded->cell.find("Gantry.J_2.Hand"));  // its full path, as settings have it
    camera_ = camera("UMG_Kamera_1");
    setting_.name = "UMG_Kamera_1";
    compute_poses(*cell_, q_, poses_);
  }
  std::size_t camera(const std::string& name) const {
    const auto found = std::ranges::find(cell_->cameras, name, &CompiledCamera::name);
    return static_cast<std::size_t>(found - cell_->cameras.begin());
  }
  const Pose& pose_of(const std::string& path) const {
    const auto found = std::ranges::find(*cell_->paths, path);
    EXPECT_NE(found, cell_->paths->end()) << path;
    return poses_.X_WN[static_cast<std::size_t>(found - cell_->paths->begin())];
  }
  const Pose& workframe() const { return poses_.X_WN[static_cast<std::size_t>(cell_->cameras[camera_].node)]; }
  std::size_t head_slot() const { return *carrier_slot(*cell_, camera_); }
  void turn_head(double pan, double tilt) {
    q_[head_slot()][0] = pan;
    q_[head_slot()][1] = tilt;
    compute_poses(*cell_, q_, poses_);
  }

  std::shared_ptr<const CompiledCell> cell_;
  std::vector<JointValues> q_;
  CellPoses poses_;
  std::size_t camera_ = 0;
  std::string hand_;
  CameraSetting setting_;
};

TEST_F(CameraMountTest, TheHeadCarriesItsCameraAndNobodyTheOther) {
  ASSERT_TRUE(carrier_slot(*cell_, camera_));
  EXPECT_EQ(cell_->robot(head_slot())->id, "KAMERAKOPF_1");
  EXPECT_FALSE(carrier_slot(*cell_, camera("CAMERA_5")));
  const std::size_t fixed = camera("CAMERA_5");
  const Pose& X_WC = poses_.X_WN[static_cast<std::size_t>(cell_->cameras[fixed].node)];
  EXPECT_TRUE(mount_pose(*cell_, poses_, fixed).isApprox(X_WC));
}

TEST_F(CameraMountTest, TheMountStaysWhereverTheHeadTurns) {
  const Pose X_WM = mount_pose(*cell_, poses_, camera_);
  EXPECT_TRUE(X_WM.linear().col(2).isApprox(Eigen::Vector3d(0, -1, 0), 1e-9)) << "level, into the cell";
  EXPECT_TRUE(X_WM.linear().col(1).isApprox(Eigen::Vector3d(0, 0, -1), 1e-9)) << "y points down";
  turn_head(0.7, -0.9);
  EXPECT_TRUE(mount_pose(*cell_, poses_, camera_).isApprox(X_WM, 1e-12));
  EXPECT_FALSE(workframe().linear().isApprox(X_WM.linear(), 0.1));
}

TEST_F(CameraMountTest, PanAndTiltAreTheJointsOfTheHead) {
  for (const auto& [pan, tilt] : {std::pair(0.0, 0.0), std::pair(0.7, -0.9), std::pair(-1.5, 0.6)}) {
    turn_head(pan, tilt);
    const CameraState sut = camera_state(*cell_, poses_, setting_, camera_);
    EXPECT_NEAR(sut.pan_rad, pan, 1e-9);
    EXPECT_NEAR(sut.tilt_rad, tilt, 1e-9);
    EXPECT_TRUE(sut.X_WC.isApprox(workframe(), 1e-9));
    EXPECT_FALSE(sut.tracking);
  }
}

TEST_F(CameraMountTest, AHeadThatIsTurnedAsToldLooksAtItsTarget) {
  setting_.tracks = hand_;
  const CameraState sut = camera_state(*cell_, poses_, setting_, camera_);
  const Eigen::Vector3d p_WT = pose_of(hand_).translation();
  ASSERT_TRUE(sut.tracking);
  EXPECT_EQ(sut.tracks, hand_);
  EXPECT_NEAR(sut.focal_distance_m, (p_WT - workframe().translation()).norm(), 1e-9);
  turn_head(sut.pan_rad, sut.tilt_rad);
  EXPECT_TRUE(sut.X_WC.isApprox(workframe(), 1e-9));
  const Eigen::Vector3d line = (p_WT - workframe().translation()).normalized();
  EXPECT_TRUE(workframe().linear().col(2).isApprox(line, 1e-9));
  // What it is told does not depend on where it looks now.
  const CameraState again = camera_state(*cell_, poses_, setting_, camera_);
  EXPECT_NEAR(again.pan_rad, sut.pan_rad, 1e-12);
  EXPECT_NEAR(again.tilt_rad, sut.tilt_rad, 1e-12);
}

TEST_F(CameraMountTest, AFixedCameraTurnsOutOfItsWorkframe) {
  setting_.name = "CAMERA_5";
  setting_.tracks = "Puma";
  const CameraState sut = camera_state(*cell_, poses_, setting_, camera("CAMERA_5"));
  const Eigen::Vector3d line = (pose_of("Puma").translation() - sut.X_WC.translation()).normalized();
  EXPECT_TRUE(sut.X_WC.linear().col(2).isApprox(line, 1e-9));
  EXPECT_TRUE((sut.X_WM.linear() * rotation_of({sut.pan_rad, sut.tilt_rad})).isApprox(sut.X_WC.linear(), 1e-9));
}

TEST_F(CameraMountTest, ATargetThatIsGoneIsNoTarget) {
  setting_.tracks = "Gantry.Nobody";
  const CameraState sut = camera_state(*cell_, poses_, setting_, camera_);
  EXPECT_FALSE(sut.tracking);
  EXPECT_EQ(sut.tracks, "");
  EXPECT_TRUE(sut.X_WC.isApprox(workframe()));
}

TEST_F(CameraMountTest, OnlyCamerasOnlineAreTold) {
  DisplayState display;
  display.cameras = {{.name = "CAMERA_5", .tracks = {}}, {.name = "UMG_Kamera_1", .tracks = {}}};
  EXPECT_TRUE(online_cameras(*cell_, poses_, display).empty());
  display.cameras[1].online = display.cameras[1].mirrored = true;
  const auto sut = online_cameras(*cell_, poses_, display);
  ASSERT_EQ(sut.size(), 1U);
  EXPECT_EQ(sut.front().name, "UMG_Kamera_1");
  EXPECT_TRUE(sut.front().mirrored);
}

TEST(CameraNamed, ThatWithThePathBeforeOneThatEndsWithIt) {
  CompiledCell cell;
  cell.paths =
      std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"", "Head.CAM", "CAM", "Hall.TOP"});
  for (const std::int32_t node : {1, 2, 3}) {
    cell.cameras.emplace_back();
    cell.cameras.back().node = node;
  }
  EXPECT_EQ(camera_named(cell, "CAM"), 1U);
  EXPECT_EQ(camera_named(cell, "Head.CAM"), 0U);
  EXPECT_EQ(camera_named(cell, "TOP"), 2U);
  EXPECT_EQ(camera_named(cell, "AM"), std::nullopt);
  EXPECT_EQ(camera_named(cell, ""), std::nullopt);
}

TEST(PanTilt, PointsWhereItIsTold) {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-3, 1, -2), Eigen::Vector3d(0, 1, 0),
        Eigen::Vector3d(0, -1, 0)}) {
    const Eigen::Matrix3d R = rotation_of(pan_tilt_towards(direction));
    EXPECT_TRUE(R.col(2).isApprox(direction.normalized(), 1e-9)) << direction.transpose();
    EXPECT_NEAR(R.col(0).y(), 0, 1e-12) << "x stays level";
  }
  EXPECT_GT(pan_tilt_towards({1, 0, 1}).pan_rad, 0) << "to the right";
  EXPECT_GT(pan_tilt_towards({0, -1, 1}).tilt_rad, 0) << "upwards";
  EXPECT_EQ(pan_tilt_towards({0, 0, 0}).pan_rad, 0);
  EXPECT_EQ(pan_tilt_towards({0, 0, 0}).tilt_rad, 0);
  EXPECT_EQ(pan_tilt_towards({std::nan(""), 0, 0}).pan_rad, 0);
}

}  // namespace
}  // namespace cellmirror::scene
