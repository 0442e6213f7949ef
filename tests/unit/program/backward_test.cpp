// Reversible programs: check points in either direction.
#include "tests/unit/program/machine_fixture.hpp"

namespace cellmirror::program {
namespace {

class BackwardTest : public MachineTest {
 protected:
  // Check points at 1, 2 and 3 mm, each with a speed of its own (0.1, 0.2, 0.3); between them what is passed over.
  BackwardTest() {
    builder.set_reversible();
    for (std::uint32_t point = 1; point <= 3; ++point) {
      builder.at(10 * point, 1, "check point P" + std::to_string(point));
      add(SetStatement{.setting = Setting::joint_velocity, .value = builder.real(0.1 * point)});
      add(MoveStatement{.fly = point == 2, .target = joints(0, point)});
      add(ScriptStatement{builder.text("DRAW_SCENE")});
    }
  }

  // "30 move ptp to joints 0.000000 0.003000 with ..." as "P3 0.300000"; others as they are.
  std::string steps(Machine& sut, std::size_t most) {
    std::string out;
    for (std::size_t count = 0; count < most; ++count) {
      const auto step = sut.next(world, 100);
      if (step != Machine::Step::command) return out + (step == Machine::Step::ended ? "ended" : "?");
      const auto* move = std::get_if<MoveCommand>(&sut.command().what);
      if (move == nullptr) continue;
      out += sut.program().step_name(sut.command().statement).substr(12);
      out += move->fly ? " fly " : " ";
      out += std::to_string(move->settings.joint_velocity.value_or(0)).substr(0, 3) + ", ";
    }
    return out;
  }
};

TEST_F(BackwardTest, RunsFromTheEndToTheFirstCheckPoint) {
  Machine sut = machine();
  ASSERT_TRUE(sut.set_direction(Direction::backward));
  EXPECT_EQ(steps(sut, 9), "P3 0.3, P2 fly 0.3, P1 0.2, ended");
}

TEST_F(BackwardTest, GoesBackTheWayThatItCameWithItsSpeed) {
  Machine sut = machine();
  EXPECT_EQ(steps(sut, 4), "P1 0.1, P2 fly 0.2, ");
  ASSERT_TRUE(sut.set_direction(Direction::backward));
  EXPECT_EQ(steps(sut, 1), "P1 0.2, ");
  ASSERT_TRUE(sut.set_direction(Direction::forward));
  EXPECT_EQ(steps(sut, 9), "P2 fly 0.2, P3 0.3, ended");
}

TEST_F(BackwardTest, GoesOnInTheOtherDirectionAfterItsEnd) {
  Machine sut = machine();
  EXPECT_EQ(steps(sut, 9), "P1 0.1, P2 fly 0.2, P3 0.3, ended");
  ASSERT_TRUE(sut.set_direction(Direction::backward));
  EXPECT_EQ(steps(sut, 9), "P2 fly 0.3, P1 0.2, ended");
  ASSERT_TRUE(sut.set_direction(Direction::forward));
  EXPECT_EQ(steps(sut, 9), "P2 fly 0.2, P3 0.3, ended");
}

TEST_F(BackwardTest, GoesOnFromTheCheckPointThatTheRobotIsAt) {
  Machine sut = machine();
  EXPECT_EQ(steps(sut, 9), "P1 0.1, P2 fly 0.2, P3 0.3, ended");
  ASSERT_TRUE(sut.stand_at(4));
  ASSERT_TRUE(sut.set_direction(Direction::backward));
  EXPECT_EQ(steps(sut, 1), "P1 0.2, ");
  ASSERT_TRUE(sut.stand_at(1));
  ASSERT_TRUE(sut.set_direction(Direction::forward));
  EXPECT_EQ(steps(sut, 9), "P2 fly 0.2, P3 0.3, ended");
  EXPECT_FALSE(sut.stand_at(0)) << "a setting is not a check point";
  EXPECT_FALSE(sut.stand_at(100));
}

TEST_F(BackwardTest, GivesAgainWhatWasTakenBack) {
  Machine sut = machine();
  EXPECT_EQ(steps(sut, 9), "P1 0.1, P2 fly 0.2, P3 0.3, ended");
  ASSERT_TRUE(sut.go_on_with(1));
  EXPECT_EQ(steps(sut, 1), "P1 0.1, ");
  ASSERT_TRUE(sut.set_direction(Direction::backward));
  ASSERT_TRUE(sut.go_on_with(7));
  EXPECT_EQ(steps(sut, 9), "P3 0.3, P2 fly 0.3, P1 0.2, ended");
  ASSERT_TRUE(sut.go_on_with(4));
  EXPECT_EQ(steps(sut, 1), "P2 fly 0.3, ");
  EXPECT_FALSE(sut.go_on_with(0)) << "a setting is not a check point";
  ASSERT_TRUE(sut.set_direction(Direction::forward));
  ASSERT_TRUE(sut.go_on_with(100));
  EXPECT_EQ(steps(sut, 1), "ended");
}

TEST_F(MachineTest, ReportsWhatCannotBeRunBackward) {
  builder.set_reversible();
  const VariableId where = ok(builder.declare("where", ValueType::joints));
  builder.at(1, 1);
  add(MoveStatement{.kind = TargetKind::joints_relative, .target = joints(0, 0)});
  builder.at(2, 1);
  add(MoveStatement{.target = ok(builder.variable(where))});
  builder.at(3, 1);
  add(SetStatement{.setting = Setting::tool, .value = pose(0, 0, 0)});
  builder.at(4, 1);
  add(SemaphoreStatement{.acquire = true, .name = builder.text("S")});
  EXPECT_EQ(errors(),
            "sut.txt:1:1: error: a relative move cannot be run backward\nsut.txt:2:1: error: a program that runs "
            "backward must have constant values only\nsut.txt:3:1: error: a change of tool or zero point cannot be run "
            "backward\nsut.txt:4:1: error: this statement cannot be run backward\n");
}

}  // namespace
}  // namespace cellmirror::program
