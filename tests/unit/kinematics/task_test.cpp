#include "rt_core/kinematics/task.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "tests/unit/kinematics/chain_support.hpp"

namespace cellmirror::kinematics {
namespace {

using std::numbers::pi;

Chain planar_boom(std::size_t links) {
  std::vector<DhRow> rows(links, DhRow{.a = 1.0});
  return chain_of_table(rows);
}

Chain elbow_arm() {
  const std::vector<DhRow> rows = {{0, pi / 2, 0.5, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}, {0, pi / 2, 0, 0}, {0, 0, 0.1, 0}};
  return chain_of_table(rows);
}

TEST(TaskOfClass, NamesPositionsAndOrientation) {
  struct Row {
    InverseClass inverse_class;
    unsigned axes;
    OrientationTask orientation;
    bool required;
  };
  using enum InverseClass;
  using enum OrientationTask;
  const std::vector<Row> rows = {{align_frame, 0b111, full, true},         {align_pos, 0b111, free, true},
                                 {align_x_axis, 0b001, full, false},       {align_y_axis, 0b010, full, false},
                                 {align_z_axis, 0b100, full, false},       {align_xy_axis, 0b011, full, false},
                                 {align_yz_axis, 0b110, full, false},      {align_xz_axis, 0b101, full, false},
                                 {align_n_axis, 0b111, normal, true},      {align_s_axis, 0b111, sliding, true},
                                 {align_a_axis, 0b111, approach, true},    {align_xy_n_axis, 0b011, normal, true},
                                 {align_xy_s_axis, 0b011, sliding, true},  {align_xy_a_axis, 0b011, approach, true},
                                 {align_xz_n_axis, 0b101, normal, true},   {align_xz_s_axis, 0b101, sliding, true},
                                 {align_xz_a_axis, 0b101, approach, true}, {align_yz_n_axis, 0b110, normal, true},
                                 {align_yz_s_axis, 0b110, sliding, true},  {align_yz_a_axis, 0b110, approach, true}};
  for (const Row& row : rows) {
    const Task sut = task_of(row.inverse_class, elbow_arm());
    EXPECT_EQ(sut.position_axes, row.axes) << static_cast<int>(row.inverse_class);
    EXPECT_EQ(sut.orientation, row.orientation) << static_cast<int>(row.inverse_class);
    EXPECT_EQ(sut.orientation_required, row.required) << static_cast<int>(row.inverse_class);
    EXPECT_EQ(sut.secondary, Secondary::nearest_present);
  }
}

TEST(TaskOfClass, BoomsMoveInTheirPlaneAndBendEvenly) {
  for (const auto inverse_class :
       {InverseClass::edith, InverseClass::boom_3, InverseClass::boom_4, InverseClass::boom_5, InverseClass::boom_6}) {
    const Task sut = task_of(inverse_class, planar_boom(5));
    EXPECT_EQ(sut.position_axes, 0b011);
    EXPECT_EQ(sut.orientation, OrientationTask::normal) << "z stands on the plane, x points along the boom";
    EXPECT_FALSE(sut.orientation_required);
    EXPECT_EQ(sut.secondary, Secondary::even_bend);
  }
}

TEST(TaskOfClass, BoomsDifferInTheNumberOfJointsThatBend) {
  const Chain chain = planar_boom(7);
  const auto bent = [&](InverseClass inverse_class) {
    const Task task = task_of(inverse_class, chain);
    std::string digits;
    for (std::size_t i = 0; i < chain.variable_count(); ++i) digits += bends(chain, task, i) ? '1' : '0';
    return digits;
  };
  EXPECT_EQ(bent(InverseClass::boom_3), "0000111");
  EXPECT_EQ(bent(InverseClass::boom_4), "0001111");
  EXPECT_EQ(bent(InverseClass::boom_5), "0011111");
  EXPECT_EQ(bent(InverseClass::boom_6), "0111111");
  EXPECT_EQ(bent(InverseClass::edith), "1111111");
}

TEST(TaskOfClass, BoomOnALiftTakesTheHeightToo) {
  std::vector<ChainJoint> joints(4);
  std::vector<Variable> variables(4);
  for (std::uint8_t i = 0; i < 4; ++i) {
    joints[i].variable = i;
    if (i > 1) joints[i].X_PJ = translation(1, 0, 0);
    variables[i] = {"q" + std::to_string(i), JointKind::revolute, -2, 2};
  }
  joints[0].kind = variables[0].kind = JointKind::prismatic;
  const Chain chain = Chain::make(variables, joints, translation(1, 0, 0)).value();
  EXPECT_EQ(task_of(InverseClass::boom_3, chain).position_axes, 0b111);
}

TEST(TaskOfClass, BoomThatIsNotPlanarTriesTheWholeOrientation) {
  const Task sut = task_of(InverseClass::edith, elbow_arm());
  EXPECT_EQ(sut.orientation, OrientationTask::full);
  EXPECT_FALSE(sut.orientation_required);
}

TEST(TaskError, LeavesOutWhatTheTaskDoesNotName) {
  const Pose X_BG = translation(1, 2, 3) * turn(0.5, Eigen::Vector3d::UnitX());
  const Twist sut = task_error({.position_axes = 0b101, .orientation = OrientationTask::free}, Pose::Identity(), X_BG);
  EXPECT_TRUE(sut.isApprox((Twist() << 1, 0, 3, 0, 0, 0).finished()));
}

TEST(TaskError, VectorTaskTurnsTheShortestWay) {
  const Task task = {.orientation = OrientationTask::approach};
  const Pose X_BG = turn(1.0, Eigen::Vector3d::UnitY()) * turn(2.0, Eigen::Vector3d::UnitZ());
  const Twist sut = task_error(task, Pose::Identity(), X_BG);
  EXPECT_NEAR((sut - (Twist() << 0, 0, 0, 0, 1, 0).finished()).norm(), 0, 1e-12) << "the turn about z is free";
}

TEST(TaskError, OppositeVectorsAreHalfATurnApart) {
  for (const auto orientation : {OrientationTask::normal, OrientationTask::sliding, OrientationTask::approach}) {
    const int column = orientation == OrientationTask::normal ? 0 : orientation == OrientationTask::sliding ? 1 : 2;
    const Pose X_BG = turn(pi, Eigen::Vector3d::Unit((column + 1) % 3));
    const Eigen::Vector3d sut = task_error({.orientation = orientation}, Pose::Identity(), X_BG).tail<3>();
    EXPECT_NEAR(sut.norm(), pi, 1e-12);
    EXPECT_NEAR(sut[column], 0, 1e-9) << "perpendicular to the tool's axis";
  }
}

TEST(TaskMet, CountsRequiredComponentsOnly) {
  Twist error = Twist::Zero();
  error[4] = 0.1;
  EXPECT_TRUE(meets({.orientation_required = false}, error, 1e-5));
  EXPECT_FALSE(meets({}, error, 1e-5));
  error[4] = 0;
  error[1] = 1.1e-5;
  EXPECT_FALSE(meets({}, error, 1e-5));
  error[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(meets({}, error, 1e-5));
}

}  // namespace
}  // namespace cellmirror::kinematics
