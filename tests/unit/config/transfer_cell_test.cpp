// The cells that come with the project: every name in an example of the SCRIPT manual exists in the transfer cell and
// is of the right kind, its published kinematics are right, and the examples' values are possible.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include "config/cell_file.hpp"
#include "rt_core/base/pose.hpp"
#include "rt_core/base/units.hpp"

namespace cellmirror {
namespace {

namespace fs = std::filesystem;

fs::path source_folder() {
  const char* folder = std::getenv("CELLMIRROR_SOURCE_DIR");
  return folder != nullptr ? fs::path(folder)
                           : fs::path(__FILE__).parent_path().parent_path().parent_path().parent_path();
}

LoadedCell load(const std::string& name) {
  Diagnostics diagnostics;
  auto loaded = load_cell(source_folder() / "config/cells" / name / "cell.toml", diagnostics);
  EXPECT_TRUE(loaded) << diagnostics.text();
  EXPECT_EQ(diagnostics.text(), "");
  return std::move(*loaded);
}

struct TransferCell : testing::Test {
  const RobotModel& robot(const std::string& id) const {
    const RobotModel* found = cell.robot(id);
    EXPECT_NE(found, nullptr) << id;
    return *found;
  }
  // TCP of a robot in its base, at joint positions in mm and degrees.
  Pose X_BT(const std::string& id, const std::vector<double>& positions) {
    std::vector<JointValues> q = cell.start_positions();
    const RobotModel& model = robot(id);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const bool prismatic = model.joint_kinds()[i] == JointKind::prismatic;
      q[model.slot()][i] = prismatic ? m_from_mm(positions[i]) : rad_from_deg(positions[i]);
    }
    const auto picture = cell.compile();
    CellPoses poses;
    compute_poses(*picture, q, poses);
    return tcp_poses(*picture->robot(model.slot()), poses).X_BT;
  }
  LoadedCell loaded = load("transfer_cell");
  Cell& cell = loaded.cell;
};

std::vector<double> in_si(const RobotModel& robot, std::vector<double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = robot.joint_kinds()[i] == JointKind::prismatic ? m_from_mm(values[i]) : rad_from_deg(values[i]);
  }
  return values;
}

TEST_F(TransferCell, hasTheFramesOfTheExamples) {
  for (const char* name :
       {"Testlab_1.FL_Klein.Flansch_Typ1", "Testlab_1.FL_Klein", "Testlab_1.FL_Klein_02.Flansch_Typ1", "Mantec_1.HAND",
        "Toolbox.Tool1", "HTL_UMGEBUNG.FL_Klein01", "HTL_UMGEBUNG.FL_Klein02", "Gantry.J_2.Hand"}) {
    EXPECT_TRUE(cell.knows(name)) << name;
  }
  EXPECT_TRUE(cell.knows("Tool1_WFRM", PathKind::workframe));
  for (const char* name : {"UMG_Kamera_1", "CAMERA_5"}) EXPECT_TRUE(cell.knows(name, PathKind::camera)) << name;
  for (const char* name : {"USS_1B", "USS_5"}) EXPECT_TRUE(cell.knows(name, PathKind::sensor)) << name;
  EXPECT_EQ(cell.node(*cell.find("Gantry.J_2")).kind(), NodeKind::joint);
}

TEST_F(TransferCell, hasTheRobotsOfTheExamples) {
  for (const char* id : {"MANTEC_RM3", "MANTEC_R3", "mantec_R3", "mantec_R3a", "PUMA_762"})
    EXPECT_EQ(robot(id).joint_count(), 6U) << id;
  EXPECT_EQ(robot("TRAEGERSYSTEM").joint_count(), 3U);
  const auto crane = robot("ZELLENKRAN").joint_kinds();
  EXPECT_EQ(std::vector<JointKind>(crane.begin(), crane.end()),
            (std::vector<JointKind>{JointKind::prismatic, JointKind::revolute, JointKind::revolute}));
}

// The words of each example that name something, by the command's syntax.
TEST_F(TransferCell, everyNameInTheIndexOfExamplesExists) {
  std::ifstream index(source_folder() / "tests/data/commands.tsv");
  if (!index) GTEST_SKIP() << "skipped: tests/data/commands.tsv is not there";
  std::string line;
  int checked = 0;
  const std::map<std::string, int> frame_at{{"ACTIVATE", 1},  {"DEACTIVATE", 1},  {"DELETE_NODE", 1},
                                            {"SWAP_NODE", 1}, {"LEVEL_DOWN", 1},  {"LEVEL_UP", 1},
                                            {"SET_FRAME", 1}, {"SET_ABSTRACT", 1}};
  while (std::getline(index, line)) {
    std::vector<std::string> columns;
    std::stringstream cells(line);
    for (std::string column; std::getline(cells, column, '\t');) columns.push_back(column);
    if (columns.size() < 5 || columns[0] == "section" || columns[4].empty()) continue;
    std::vector<std::string> words;
    std::stringstream example(columns[4]);
    for (std::string word; example >> word;) words.push_back(word);
    const auto expect_frame = [&](std::size_t i) {
      ++checked;
      EXPECT_TRUE(i < words.size() && cell.knows(words[i])) << columns[4];
    };
    const auto expect_robot = [&](std::size_t i) {
      ++checked;
      EXPECT_TRUE(i < words.size() && cell.robot(words[i]) != nullptr) << columns[4];
    };
    if (frame_at.contains(words[0])) expect_frame(1);
    if (words[0] == "CONNECT" || words[0] == "FRAME_TO_WFRM") {
      expect_frame(1);
      expect_frame(3);
    }
    if (words[0] == "CAM_TRACKING") expect_frame(3);
    if (words[0] == "ROBACT" || words[0] == "POS_ROB" || words[0] == "ROBOT") expect_robot(1);
    if (words[0] == "TF_LOAD" || words[0] == "TF_RUN" || words[0] == "TF_DELETE") expect_robot(2);
    if (words[0].starts_with("CAM_") || words[0] == "SET_CAMPAR") {
      ++checked;
      EXPECT_TRUE(cell.knows(words[1], PathKind::camera)) << columns[4];
    }
  }
  EXPECT_GT(checked, 20);
}

TEST_F(TransferCell, theExamplesOfPosRobArePossible) {
  const RobotModel& model = robot("MANTEC_RM3");
  const JointValues start = model.parameters().start_position;
  const auto there = model.positions_to(in_si(model, {27.5, -17.38, -11.02, 37.338, 0.9, -12.271}), start);
  ASSERT_TRUE(there) << there.error().text();
  EXPECT_TRUE(model.positions_by(in_si(model, {-0.1, 0, 0, 0.85, 0, -0.3}), *there));
}

TEST_F(TransferCell, theExamplesOfParametersArePossible) {
  const auto set = [](RobotModel& model, JointParameter which, const std::vector<double>& values) {
    const auto result = model.set_joint_parameter(which, values);
    EXPECT_TRUE(result) << result.error().text();
  };
  RobotModel& arm = *cell.edit_robot("MANTEC_R3");
  const std::vector<double> velocity{1.919862, 1.483553, 5.235988, 3.14159, 4.014257, 3.926991};
  set(arm, JointParameter::start_position, in_si(arm, {0.0, 50.0, -110.0, 0.0, -150.0, -180.0}));
  set(arm, JointParameter::reference_position, in_si(arm, {17.35, 0, -12.79307, 1.507E-03, 0.0, 15.2003}));
  set(arm, JointParameter::max_range, in_si(arm, {162.5, 110.0, 145.0, 187.5, 115.5, 270.0}));
  set(arm, JointParameter::min_range, in_si(arm, {-162.5, -110.0, -145.0, -187.5, -115.5, -270.0}));
  set(arm, JointParameter::max_velocity, velocity);
  set(arm, JointParameter::max_acceleration, velocity);
  set(arm, JointParameter::active_acceleration, velocity);
  RobotModel& crane = *cell.edit_robot("ZELLENKRAN");
  set(crane, JointParameter::min_velocity, {8.5e-3, 3.14159E-04, 4.014257E-04});
  set(crane, JointParameter::active_velocity, {1.3, 3.14159, 1.5707963});
}

TEST_F(TransferCell, theExamplesOfDetailLevelsAndGrippingWork) {
  const auto expect = [](const Result<void>& result) { EXPECT_TRUE(result) << result.error().text(); };
  expect(cell.activate("Testlab_1.FL_Klein.Flansch_Typ1"));
  expect(cell.deactivate("Testlab_1.FL_Klein.Flansch_Typ1"));
  expect(cell.delete_node("Testlab_1.FL_Klein.Flansch_Typ1"));
  expect(cell.swap_node("Testlab_1.FL_Klein.Flansch_Typ1"));
  expect(cell.level_up("Testlab_1.FL_Klein"));
  expect(cell.level_down("Testlab_1.FL_Klein"));
  expect(cell.connect("Testlab_1.FL_Klein_02.Flansch_Typ1", "Mantec_1.HAND", cell.start_positions()));
  expect(cell.attach_at_workframe("Toolbox.Tool1", "Mantec_1.HAND", "Tool1_WFRM"));
  expect(cell.set_placement("Testlab_1.FL_Klein.Flansch_Typ1", Pose::Identity()));
  expect(cell.set_camera("CAMERA_5", 4.85, rad_from_deg(15.71)));
}

// The published chain (Denavit-Hartenberg form: 0.5 m between axes 2 and 3, 0.73 m to the wrist), with the base 0.66 m
// and the hand 0.12 m of ours.
TEST_F(TransferCell, theManutecStandsStraightUpAtZeroAndFoldsAsPublished) {
  const double up = 0.66 + 0.5 + 0.73 + 0.12;
  EXPECT_TRUE(X_BT("MANTEC_R3", {0, 0, 0, 0, 0, 0}).translation().isApprox(Eigen::Vector3d(0, 0, up), 1e-12));
  // Axis 2 turns about x: +90 degrees lays the arm along -y.
  EXPECT_TRUE(X_BT("MANTEC_R3", {0, 90, 0, 0, 0, 0})
                  .translation()
                  .isApprox(Eigen::Vector3d(0, -(0.5 + 0.73 + 0.12), 0.66), 1e-12));
  // Elbow by 90 degrees: only the forearm lies.
  EXPECT_TRUE(X_BT("MANTEC_R3", {0, 0, 90, 0, 0, 0})
                  .translation()
                  .isApprox(Eigen::Vector3d(0, -(0.73 + 0.12), 0.66 + 0.5), 1e-12));
  // Axis 1 turns all of it.
  EXPECT_TRUE(X_BT("MANTEC_R3", {90, 0, 90, 0, 0, 0})
                  .translation()
                  .isApprox(Eigen::Vector3d(0.73 + 0.12, 0, 0.66 + 0.5), 1e-12));
  // Axes 4 and 6 are the same line while axis 5 is at zero.
  EXPECT_TRUE(X_BT("MANTEC_R3", {10, 20, 30, 40, 0, 0}).isApprox(X_BT("MANTEC_R3", {10, 20, 30, 0, 0, 40}), 1e-12));
}

// Product of the modified Denavit-Hartenberg transforms, written out independently of the component file.
Pose puma_by_denavit_hartenberg(const std::vector<double>& q_deg) {
  struct Row {
    double alpha_deg, a, d;
  };
  constexpr Row kRows[] = {{0, 0, 0}, {-90, 0, 0}, {0, 0.65, 0.19}, {-90, 0, 0.6}, {90, 0, 0}, {-90, 0, 0}};
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T(2, 3) = 1.119;
  for (std::size_t i = 0; i < 6; ++i) {
    const double ca = std::cos(rad_from_deg(kRows[i].alpha_deg));
    const double sa = std::sin(rad_from_deg(kRows[i].alpha_deg));
    const double c = std::cos(rad_from_deg(q_deg[i]));
    const double s = std::sin(rad_from_deg(q_deg[i]));
    Eigen::Matrix4d A;
    A << c, -s, 0, kRows[i].a, s * ca, c * ca, -sa, -sa * kRows[i].d, s * sa, c * sa, ca, ca * kRows[i].d, 0, 0, 0, 1;
    T = T * A;
  }
  Eigen::Matrix4d flange = Eigen::Matrix4d::Identity();
  flange(2, 3) = 0.125;
  Pose X;
  X.matrix() = T * flange;
  return X;
}

TEST_F(TransferCell, thePumaFollowsItsDenavitHartenbergTable) {
  for (const std::vector<double>& q : std::vector<std::vector<double>>{
           {0, 0, 0, 0, 0, 0}, {0, -90, -90, 0, 0, 0}, {30, -45, 20, 60, -70, 80}, {-150, -190, -220, 260, 99, -260}}) {
    EXPECT_TRUE(X_BT("PUMA_762", q).isApprox(puma_by_denavit_hartenberg(q), 1e-9)) << q[0];
  }
}

TEST_F(TransferCell, theGantryCarriesItsArm) {
  std::vector<JointValues> q = cell.start_positions();
  const Pose before = cell.world_pose(*cell.find("Mantec_1.HAND"), q);
  q[robot("TRAEGERSYSTEM").slot()] = {3.0, 0.5, 0.25};
  const Pose after = cell.world_pose(*cell.find("Mantec_1.HAND"), q);
  EXPECT_TRUE((after.translation() - before.translation()).isApprox(Eigen::Vector3d(2.0, 0.5, -0.25), 1e-12));
  EXPECT_LT(before.linear()(2, 2), -0.99) << "it hangs head down";
}

TEST_F(TransferCell, hasItsStreams) {
  ASSERT_EQ(loaded.streams.size(), 3U);
  const auto& can = std::get<Cia402StreamConfig>(loaded.streams[0].config);
  EXPECT_EQ(loaded.streams[0].robot, "MANTEC_R3");
  EXPECT_EQ(can.channel.endpoint, "udp:239.74.163.2:43113");
  ASSERT_EQ(can.nodes.size(), 6U);
  EXPECT_EQ(can.nodes[5].joint, 5U);
  EXPECT_DOUBLE_EQ(can.nodes[0].scale, 1e-5);
  const auto& dds = std::get<DdsStreamConfig>(loaded.streams[1].config);
  EXPECT_EQ(dds.joints[2].ros_name, "puma_762_joint_3");
  const auto& head = std::get<Cia402StreamConfig>(loaded.streams[2].config);
  EXPECT_EQ(loaded.streams[2].robot, "KAMERAKOPF_1");
  EXPECT_EQ(head.nodes.size(), 2U);
  EXPECT_EQ(loaded.startup_script, "startup.spt");
}

// Whatever is commanded, in whatever order: refused commands change nothing, and the picture agrees with the tree.
TEST_F(TransferCell, randomOperationsKeepTheModelSound) {
  std::mt19937 random(2026);
  const auto pick = [&](const std::vector<std::string>& from) { return from[random() % from.size()]; };
  std::vector<JointValues> q = cell.start_positions();
  int done = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::vector<std::string> paths = cell.paths(PathKind::any);
    const std::string path = pick(paths);
    const auto before = cell.revision();
    const auto nodes = cell.node_count();
    Pose X = Pose::Identity();
    X.translation() = Eigen::Vector3d::Random();
    Result<void> result;
    switch (random() % 10) {
      case 0:
        result = cell.activate(path);
        break;
      case 1:
        result = cell.deactivate(path);
        break;
      case 2:
        // Seldom, or soon nothing is left.
        result = cell.node(*cell.find(path)).has_abstract() ? cell.delete_node(path) : Result<void>();
        break;
      case 3:
        result = cell.swap_node(path);
        break;
      case 4:
        result = cell.level_down(path);
        break;
      case 5:
        result = cell.level_up(path);
        break;
      case 6:
        result = cell.set_placement(path, X);
        break;
      case 7:
        result = cell.attach_at_workframe(path, pick(paths), "Tool1_WFRM");
        break;
      default:
        result = cell.connect(path, pick(paths), q);
        break;
    }
    done += result ? 1 : 0;
    if (!result) {
      ASSERT_FALSE(result.error().what.empty());
      ASSERT_EQ(cell.revision(), before) << result.error().text();
      ASSERT_EQ(cell.node_count(), nodes);
    }
    for (JointValues& joints : q) joints[random() % 3] = 0.1 * static_cast<double>(random() % 10);
    if (round % 20 != 0) continue;
    const auto picture = cell.compile();
    CellPoses poses;
    compute_poses(*picture, q, poses);
    ASSERT_EQ(picture->size(), cell.node_count());
    for (std::size_t i = 1; i < picture->size(); ++i) {
      const auto node = cell.find((*picture->paths)[i]);
      ASSERT_TRUE(node) << node.error().text();
      ASSERT_TRUE((poses.X_WN[i].matrix() - cell.world_pose(*node, q).matrix()).norm() < 1e-9) << (*picture->paths)[i];
      ASSERT_EQ(picture->visible[i] != 0, cell.visible(*node));
    }
  }
  EXPECT_GT(done, 300);
}

TEST(OtherCells, load) {
  const LoadedCell ros2 = load("ros2_cell");
  ASSERT_NE(ros2.cell.robot("demo_arm"), nullptr);
  EXPECT_EQ(ros2.cell.robot("demo_arm")->joint_names(),
            (std::vector<std::string>{"turn", "shoulder", "elbow", "roll", "bend", "flange_turn"}));
  EXPECT_EQ(std::get<DdsStreamConfig>(ros2.streams.front().config).joints.size(), 6U)
      << "all joints by their own names";
  const LoadedCell can = load("can_cell");
  ASSERT_EQ(can.streams.size(), 2U);
  const auto& drives = std::get<Cia402StreamConfig>(can.streams[0].config);
  EXPECT_EQ(drives.nodes[1].sign, -1.0);
  EXPECT_EQ(drives.nodes[1].offset, 0.25);
  EXPECT_TRUE(fs::path(drives.nodes[0].eds_file).is_absolute());
  EXPECT_EQ(std::get<DbcStreamConfig>(can.streams[1].config).signals[2].quantity, JointQuantity::velocity);
}

}  // namespace
}  // namespace cellmirror
