// SET_FRAME PLACEMENT, CONNECT, FRAME_TO_WFRM, SET_CAMPAR, SET_USSPAR, and the pictures that follow from them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/unit/cell/cell_from_text.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

struct Places : testing::Test {
  Places() {
    files->add("arm.mpc", kArm);
    files->add("box.mpc",
               "[[node]]\nname = \"Tool\"\nxyz_m = [0, 0, 1]\n[[node]]\nname = \"Edge\"\nparent = \"Tool\"\n"
               "xyz_m = [0, 0, 0.5]\n");
    Diagnostics diagnostics;
    sut = build_cell(R"(
[[node]]
name = "Arm"
abstract = "arm.mpc"
xyz_m = [0, 0, 1]
[[node]]
name = "Box"
abstract = "box.mpc"
xyz_m = [5, 0, 0]
[[node]]
name = "Grip_WFRM"
parent = "Box"
type = "workframe"
xyz_m = [0, 0, 0.1]
rpy_rad = [0, 0, 1.5707963267948966]
[[node]]
name = "Ear"
parent = "Box"
type = "sensor"
[[node]]
name = "Cam"
type = "camera"
)",
                     files, diagnostics);
    EXPECT_TRUE(sut) << diagnostics.text();
    q = sut->start_positions();
  }
  Pose world(const std::string& path) const {
    const auto cell = sut->compile();
    CellPoses poses;
    compute_poses(*cell, q, poses);
    const std::string full = sut->path(*sut->find(path));
    const auto at = std::ranges::find(*cell->paths, full);
    return poses.X_WN[static_cast<std::size_t>(at - cell->paths->begin())];
  }
  Eigen::Vector3d position(const std::string& path) const { return world(path).translation(); }
  std::shared_ptr<TextFiles> files = std::make_shared<TextFiles>();
  std::optional<Cell> sut;
  std::vector<JointValues> q;
};

TEST_F(Places, jointsMoveWhatHangsOnThem) {
  EXPECT_TRUE(position("Arm.TIP").isApprox(Eigen::Vector3d(3, 0, 1)));
  q[sut->robot("ARM")->slot()] = {0.5, std::numbers::pi / 2, 0.0};
  EXPECT_TRUE(position("Arm.TIP").isApprox(Eigen::Vector3d(1, 2, 1.5)));
  q[sut->robot("ARM")->slot()] = {0.0, 0.0, -std::numbers::pi / 2};
  EXPECT_TRUE(position("Arm.TIP").isApprox(Eigen::Vector3d(2, 0, 2)));
}

TEST_F(Places, worldPoseAgreesWithThePicture) {
  q[sut->robot("ARM")->slot()] = {0.3, 0.7, -1.1};
  EXPECT_TRUE(sut->world_pose(*sut->find("Arm.TIP"), q).isApprox(world("Arm.TIP"), 1e-12));
}

TEST_F(Places, placementMovesAFrameAndItsSuccessors) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(0, 2, 0);
  ASSERT_TRUE(sut->set_placement("Box.Tool", X));
  EXPECT_TRUE(position("Box.Edge").isApprox(Eigen::Vector3d(5, 2, 0.5)));
}

TEST_F(Places, placementOfAJointOrWithValuesThatAreNoNumbersIsRefused) {
  const auto joint = sut->set_placement("Arm.TURN", Pose::Identity());
  ASSERT_FALSE(joint);
  EXPECT_THAT(joint.error().remedy, HasSubstr("POS_ROB"));
  Pose X = Pose::Identity();
  X.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const auto before = sut->revision();
  EXPECT_FALSE(sut->set_placement("Box.Tool", X));
  X.translation().x() = 1e30;
  EXPECT_FALSE(sut->set_placement("Box.Tool", X));
  EXPECT_EQ(sut->revision(), before);
}

TEST_F(Places, connectKeepsTheWorldPoseAndThenFollows) {
  const std::size_t slot = sut->robot("ARM")->slot();
  q[slot] = {0.5, 0.4, -0.3};
  const Pose before = world("Box.Tool");
  ASSERT_TRUE(sut->connect("Box.Tool", "Arm.TIP", q));
  EXPECT_TRUE(world("Box.Tool").isApprox(before, 1e-12));
  const Pose X_TP = world("Arm.TIP").inverse() * before;
  q[slot] = {1.5, -0.4, 0.3};
  EXPECT_TRUE(world("Box.Tool").isApprox(world("Arm.TIP") * X_TP, 1e-12));
  EXPECT_EQ(sut->path(*sut->find("Box.Tool")), "Box.Tool") << "the name stays";
}

TEST_F(Places, connectRefusesWhatWouldBreakTheTreeOrARobot) {
  EXPECT_THAT(sut->connect("Box", "Box.Edge", q).error().what, HasSubstr("is attached to Box"));
  EXPECT_THAT(sut->connect("Box", "Box", q).error().what, HasSubstr("its own predecessor"));
  EXPECT_THAT(sut->connect("Arm.TURN", "Box", q).error().what, HasSubstr("is a joint"));
  EXPECT_THAT(sut->connect("Arm.TIP", "Box", q).error().what, HasSubstr("part of the mechanism"));
  EXPECT_THAT(sut->connect("Arm", "Arm.TIP", q).error().what, HasSubstr("is attached to Arm"));
  EXPECT_THAT(sut->connect("Bxo", "Arm.TIP", q).error().remedy, HasSubstr("Box"));
  EXPECT_TRUE(sut->connect("Arm", "Box.Edge", q)) << "a whole robot may stand on something";
  EXPECT_THAT(sut->connect("Box", "Arm.TIP", q).error().what, HasSubstr("is attached to Box")) << "now a circle";
}

TEST_F(Places, attachingPutsThePartAtTheWorkframe) {
  ASSERT_TRUE(sut->attach_at_workframe("Box.Tool", "Arm.TIP", "Grip_WFRM"));
  Pose X_FW = Pose::Identity();
  X_FW.translation().z() = 0.1;
  X_FW.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(world("Box.Tool").isApprox(world("Arm.TIP") * X_FW, 1e-12));
  EXPECT_THAT(sut->attach_at_workframe("Box.Tool", "Arm.TIP", "Cam").error().what, HasSubstr("is a camera"));
}

TEST_F(Places, cameraParametersAreChecked) {
  EXPECT_FALSE(sut->set_camera("Cam", 0.0, 0.5));
  EXPECT_THAT(sut->set_camera("Cam", -1.0, 0.5).error().what, HasSubstr("must be positive"));
  EXPECT_THAT(sut->set_camera("Cam", 1e7, 0.5).error().what, HasSubstr("is 10000000 m, but at most 1000000 m"));
  EXPECT_FALSE(sut->set_camera("Cam", std::nan(""), 0.5));
  EXPECT_FALSE(sut->set_camera("Cam", 1.0, 3.2));
  EXPECT_FALSE(sut->set_camera("Box", 1.0, 0.5));
  ASSERT_TRUE(sut->set_camera("Cam", 4.85, 0.27));
  EXPECT_EQ(sut->compile()->cameras.front().focal_distance_m, 4.85);
}

TEST_F(Places, sensorParametersAreCheckedAndShowInThePicture) {
  EXPECT_FALSE(sut->set_sensor_active("Cam", true));
  EXPECT_THAT(sut->set_sensor_range("Earr", 1.0).error().text(), HasSubstr("Ear"));
  for (const double range : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_FALSE(sut->set_sensor_range("Ear", range)) << range;
  EXPECT_THAT(sut->set_sensor_range("Ear", 1e9).error().what, HasSubstr("but at most 1000000000 mm"));
  const auto before = sut->compile();
  EXPECT_FALSE(before->sensors.front().sensor.active);
  ASSERT_TRUE(sut->set_sensor_active("Ear", true));
  ASSERT_TRUE(sut->set_sensor_range("Box.Ear", 3.5));
  const auto after = sut->compile();
  EXPECT_TRUE(after->sensors.front().sensor.active);
  EXPECT_EQ(after->sensors.front().sensor.range_m, 3.5);
  EXPECT_FALSE(before->sensors.front().sensor.active) << "a picture stays as it is";
  ASSERT_TRUE(sut->set_sensor_active("Ear", true));
  EXPECT_EQ(sut->revision(), after->revision) << "nothing changed";
}

TEST_F(Places, aSensorSeesBeyondItsBlindZone) {
  const double blind_zone = sut->compile()->sensors.front().sensor.blind_zone_m;
  const auto refused = sut->set_sensor_range("Ear", blind_zone);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text(), HasSubstr("within its blind zone of 100 mm; give more than 100 mm"));
  EXPECT_TRUE(sut->set_sensor_range("Ear", blind_zone + 0.001));
}

TEST_F(Places, aPlacementTooFarNamesTheLimit) {
  Pose far = Pose::Identity();
  far.translation().x() = 2e6;
  EXPECT_THAT(sut->set_placement("Box", far).error().what,
              HasSubstr("2000000000 mm away from its predecessor, but at most 1000000000 mm"));
  far.translation().x() = std::nan("");
  EXPECT_THAT(sut->set_placement("Box", far).error().what, HasSubstr("is not finite"));
}

TEST_F(Places, aPictureStaysAsItIsAndTheRevisionTellsOfChanges) {
  const auto old = sut->compile();
  EXPECT_EQ(sut->compile(), old) << "nothing changed";
  ASSERT_TRUE(sut->set_placement("Box", Pose::Identity()));
  const auto now = sut->compile();
  EXPECT_NE(now->revision, old->revision);
  EXPECT_EQ(now->paths, old->paths) << "names are shared as long as the tree stays";
  CellPoses poses;
  compute_poses(*old, q, poses);
  const auto box = std::ranges::find(*old->paths, "Box") - old->paths->begin();
  EXPECT_TRUE(poses.X_WN[static_cast<std::size_t>(box)].translation().isApprox(Eigen::Vector3d(5, 0, 0)));
  compute_poses(*now, q, poses);
  EXPECT_TRUE(poses.X_WN[static_cast<std::size_t>(box)].translation().isZero());
}

TEST_F(Places, arraysHaveFixedNodesFirstAndParentsBeforeChildren) {
  ASSERT_TRUE(sut->connect("Box", "Arm.TIP", q));
  const auto cell = sut->compile();
  for (std::size_t i = 1; i < cell->size(); ++i) {
    EXPECT_LT(cell->parent[i], static_cast<std::int32_t>(i));
    EXPECT_GE(cell->parent[i], 0);
  }
  for (std::size_t i = 0; i < cell->fixed_count; ++i) EXPECT_EQ(cell->joint_of[i], -1);
  EXPECT_EQ(cell->X_WN_fixed.size(), cell->fixed_count);
  const auto box = std::ranges::find(*cell->paths, "Box") - cell->paths->begin();
  EXPECT_GE(static_cast<std::size_t>(box), cell->fixed_count) << "it moves now";
}

TEST_F(Places, tcpPosesFollowFromThePointOfReferenceAndTheTool) {
  Pose X_FP = Pose::Identity();
  X_FP.translation().x() = 0.2;
  Pose X_PT = Pose::Identity();
  X_PT.translation().x() = 0.1;
  ASSERT_TRUE(sut->edit_robot("ARM")->set_point_of_reference(X_FP));
  ASSERT_TRUE(sut->edit_robot("ARM")->set_tool_center_point(X_PT));
  const auto cell = sut->compile();
  CellPoses poses;
  compute_poses(*cell, q, poses);
  const TcpPoses tcp = tcp_poses(*cell->robot(sut->robot("ARM")->slot()), poses);
  EXPECT_TRUE(tcp.X_WT.translation().isApprox(Eigen::Vector3d(3.3, 0, 1)));
  EXPECT_TRUE(tcp.X_BT.translation().isApprox(Eigen::Vector3d(3.3, 0, 0)));
  EXPECT_TRUE(tcp.X_ZT.isApprox(tcp.X_BT));
}

TEST_F(Places, aBaseThatHangsOnAnotherRobotIsCarried) {
  files->add("box.mpc", kArm);
  Diagnostics diagnostics;
  auto carried = build_cell(
      "[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n[[node]]\nname = \"Rider\"\nabstract = \"box.mpc\"\n"
      "robot_id = \"RIDER\"\n",
      files, diagnostics, {{"Rider", "Arm.TIP"}});
  ASSERT_TRUE(carried) << diagnostics.text();
  q = carried->start_positions();
  q[carried->robot("ARM")->slot()][0] = 1.0;
  EXPECT_TRUE(carried->world_pose(*carried->find("Rider.TIP"), q).translation().isApprox(Eigen::Vector3d(6, 0, 1)));
}

TEST_F(Places, predecessorsThatAreUnknownOrMakeACircleAreFindings) {
  Diagnostics diagnostics;
  EXPECT_FALSE(build_cell("[[node]]\nname = \"A\"\n[[node]]\nname = \"B\"\n[[node]]\nname = \"C\"\n", files,
                          diagnostics, {{"A", "B"}, {"B", "A"}, {"C", "D"}}));
  EXPECT_EQ(diagnostics.errors(), 2U) << diagnostics.text();
  EXPECT_THAT(diagnostics.text(), HasSubstr("would be its own ancestor"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("cell.toml:6"));
}

}  // namespace
}  // namespace cellmirror
