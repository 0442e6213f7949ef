// Hold, resume, pause, steps, backward.
#include "tests/unit/program_controller/cell_of_programs.hpp"

namespace cellmirror::program::test {
namespace {

using Kind = ProgramEvent::Kind;

ProgramMaker check_points(int count) {
  ProgramMaker maker;
  for (int i = 1; i <= count; ++i) maker.move(i);
  maker.reversible();
  return maker;
}

TEST(ProgramHold, BrakesOnTheWayAndGoesOnLater) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).script("S").move(2));
  cell.run("A", "p");
  cell.pass(0.5);
  ASSERT_TRUE(cell.sut.hold("A"));
  EXPECT_FALSE(cell.sut.hold("A"));
  cell.pass(3);
  EXPECT_NEAR(cell.q("A"), 0.5 + kBrakeTime / 2, 0.002);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  EXPECT_TRUE(cell.sut.busy());
  EXPECT_TRUE(cell.sut.moves("A"));
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 0.5, 1e-6);
  ASSERT_TRUE(cell.sut.resume("A"));
  EXPECT_FALSE(cell.sut.resume("A"));
  cell.finish();
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::ended);
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 2 + 0.0, 0.06);
  EXPECT_FALSE(cell.status("A", "p").expected_s);
}

TEST(ProgramHold, LetsNothingHappen) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).script("S").wait_for_input(1, 1.0).move(2));
  cell.run("A", "p");
  cell.pass(0.99);
  ASSERT_TRUE(cell.sut.hold("A"));  // the move ends while it brakes
  cell.pass(1);
  EXPECT_DOUBLE_EQ(cell.q("A"), 1);
  EXPECT_TRUE(cell.scripts.sources.empty());
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.pass(0.5);
  EXPECT_EQ(cell.scripts.sources.size(), 1U);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::waiting);
  ASSERT_TRUE(cell.sut.hold("A"));
  ASSERT_TRUE(cell.sut.set_digital_input("A", 1, true));
  cell.pass(10);  // longer than the timeout
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.finish();
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::ended);
}

TEST(ProgramHold, StopsTheTimeoutOfAWait) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.wait_for_input(1, 1.0));
  cell.run("A", "p");
  cell.pass(0.4);
  ASSERT_TRUE(cell.sut.hold("A"));
  cell.pass(5);
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.pass(0.5);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::waiting);
  cell.pass(0.2);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::failed);
}

TEST(ProgramHold, OfADelayedProgramDelaysIt) {
  CellOfPrograms cell;
  cell.motion.robot("A").delay = 1;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1));
  cell.run("A", "p");
  cell.pass(0.5);
  ASSERT_TRUE(cell.sut.hold("A"));
  cell.pass(5);
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.pass(0.4);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::delayed);
  cell.finish();
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 2, 0.06);
}

TEST(ProgramHold, EndsWithAStop) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(5));
  cell.run("A", "p");
  cell.pass(1);
  ASSERT_TRUE(cell.sut.hold("A"));
  cell.pass(1);
  ASSERT_TRUE(cell.sut.stop("A"));
  EXPECT_FALSE(cell.sut.busy());
  cell.pass(1);
  cell.run("A", "p");
  cell.finish();
  EXPECT_DOUBLE_EQ(cell.q("A"), 5);
}

TEST(ProgramPause, WaitsForSomebodyToResume) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).pause().move(2));
  cell.run("A", "p");
  cell.pass(3);
  EXPECT_DOUBLE_EQ(cell.q("A"), 1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  EXPECT_EQ(cell.status("A", "p").step, "line 2");
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.finish();
  EXPECT_DOUBLE_EQ(cell.q("A"), 2);
}

TEST(ProgramStep, GoesToTheEndOfTheNextMove) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).fly(2).out(1, true).move(3).script("S").move(4));
  cell.run("A", "p");
  EXPECT_FALSE(cell.sut.step("A", Direction::forward));  // not held
  cell.pass(0.5);
  ASSERT_TRUE(cell.sut.hold("A"));
  ASSERT_TRUE(cell.sut.step("A", Direction::forward));
  EXPECT_FALSE(cell.sut.step("A", Direction::forward));  // under way
  cell.pass(5);
  EXPECT_DOUBLE_EQ(cell.q("A"), 1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  ASSERT_TRUE(cell.sut.step("A", Direction::forward));
  cell.pass(5);
  EXPECT_DOUBLE_EQ(cell.q("A"), 2);  // a fly move, too
  EXPECT_TRUE(cell.sut.signals("A")->digital_outputs[1]);
  ASSERT_TRUE(cell.sut.step("A", Direction::forward));
  cell.pass(5);
  EXPECT_DOUBLE_EQ(cell.q("A"), 3);
  EXPECT_TRUE(cell.scripts.sources.empty());
  ASSERT_TRUE(cell.sut.step("A", Direction::forward));
  cell.pass(5);
  EXPECT_DOUBLE_EQ(cell.q("A"), 4);
  EXPECT_EQ(cell.scripts.sources.size(), 1U);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  ASSERT_TRUE(cell.sut.step("A", Direction::forward));
  cell.pass(0.1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::ended);
}

TEST(ProgramStep, MayBeFollowedByTheRest) {
  CellOfPrograms cell;
  ProgramMaker maker = check_points(6);
  cell.load("A", "p", maker);
  cell.run("A", "p");
  cell.pass(0.5);
  ASSERT_TRUE(cell.sut.hold("A"));
  cell.pass(1);
  ASSERT_TRUE(cell.sut.step("A", Direction::forward));
  cell.pass(0.2);
  ASSERT_TRUE(cell.sut.resume("A"));  // in the middle of the step
  cell.finish();
  EXPECT_DOUBLE_EQ(cell.q("A"), 6);
}

TEST(ProgramStep, GoesBackToTheCheckPointBefore) {
  CellOfPrograms cell;
  ProgramMaker maker = check_points(9);
  cell.load("A", "p", maker);
  cell.run("A", "p");
  cell.pass(3.5);
  ASSERT_TRUE(cell.sut.hold("A"));
  const auto step_to = [&](Direction direction, double posture) {
    ASSERT_TRUE(cell.sut.step("A", direction));
    cell.pass(3);
    EXPECT_DOUBLE_EQ(cell.q("A"), posture);
    EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  };
  step_to(Direction::backward, 3);  // from between 3 and 4
  step_to(Direction::backward, 2);
  step_to(Direction::forward, 3);
  step_to(Direction::forward, 4);
  step_to(Direction::backward, 3);
  step_to(Direction::backward, 2);
  step_to(Direction::backward, 1);
  step_to(Direction::backward, 1);  // the first one: there it stays
  step_to(Direction::forward, 2);
  ASSERT_TRUE(cell.sut.step("A", Direction::backward));
  cell.pass(0.5);
  ASSERT_TRUE(cell.sut.resume("A"));  // on the way back: on with the program
  cell.finish();
  EXPECT_DOUBLE_EQ(cell.q("A"), 9);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::ended);
}

// Back and forth between 0 and 1, so that each check point that is left out makes the way shorter; behind each is an
// output of its own. The moves are put ahead, since they fly.
constexpr int kTurns = 12;
ProgramMaker back_and_forth() {
  ProgramMaker maker;
  maker.reversible();
  for (int i = 1; i <= kTurns; ++i) maker.fly(i % 2).out(i, true);
  return maker;
}

void expect_whole(CellOfPrograms& cell, double least_s) {
  cell.finish();
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::ended);
  EXPECT_GT(cell.status("A", "p").elapsed_s, least_s);
  EXPECT_DOUBLE_EQ(cell.q("A"), kTurns % 2);
  for (std::size_t i = 1; i <= kTurns; ++i) EXPECT_TRUE(cell.sut.signals("A")->digital_outputs[i]) << i;
}

// `later`: from the instant of the step to that at which it is taken back: braking, standing, or on the way back.
TEST(ProgramStep, BackwardThatIsTakenBackLeavesNothingOut) {
  const double least_s = kTurns * (1 - kFlyTime) - 0.1;
  for (const double held_at : {0.5, 0.89, 1.79, 2.2}) {
    for (const double later : {0.0, 0.02, 0.06, 0.08, 0.12, 0.3}) {
      for (const bool by_step : {false, true}) {
        SCOPED_TRACE(testing::Message() << held_at << " s, taken back " << later << " s later, step: " << by_step);
        CellOfPrograms cell;
        ProgramMaker maker = back_and_forth();
        cell.load("A", "p", maker);
        cell.run("A", "p");
        cell.pass(held_at);
        ASSERT_TRUE(cell.sut.hold("A"));
        ASSERT_TRUE(cell.sut.step("A", Direction::backward));
        cell.pass(later);
        if (by_step) {
          static_cast<void>(cell.sut.hold("A"));  // it may have come to the first check point and be held already
          ASSERT_TRUE(cell.sut.step("A", Direction::forward));
          cell.pass(3);
          EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
        }
        ASSERT_TRUE(cell.sut.resume("A"));
        expect_whole(cell, least_s);
      }
    }
  }
}

TEST(ProgramStep, BackwardFromTheFirstWayChangesNothing) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.reversible().out(1, true).move(5).move(1));
  cell.run("A", "p");
  cell.pass(2);
  ASSERT_TRUE(cell.sut.hold("A"));
  ASSERT_TRUE(cell.sut.step("A", Direction::backward));
  cell.pass(1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  EXPECT_LT(cell.q("A"), 2.1);
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.finish();
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 5 + 4, 0.2);
}

TEST(ProgramStep, ForwardFromTheFirstWayBackwardChangesNothing) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.reversible().move(1).move(5));
  cell.run("A", "p", Direction::backward);
  cell.pass(2);
  ASSERT_TRUE(cell.sut.hold("A"));
  ASSERT_TRUE(cell.sut.step("A", Direction::forward));
  cell.pass(1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.finish();
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 5 + 4, 0.2);
}

TEST(ProgramStep, BackwardThatIsTakenBackRepeatsNothing) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.reversible().move(1).script("S").pause().script("S").move(2));
  cell.run("A", "p");
  cell.pass(2);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  ASSERT_TRUE(cell.sut.step("A", Direction::backward));  // it is the first check point: there it stays
  cell.pass(1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::held);
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.finish();
  EXPECT_EQ(cell.scripts.sources.size(), 2U);
  EXPECT_DOUBLE_EQ(cell.q("A"), 2);
}

TEST(ProgramStep, GoesBackOnlyWhereTheProgramCan) {
  CellOfPrograms cell;
  ProgramMaker forward;
  ProgramMaker back = check_points(3);
  cell.load("A", "p", forward.move(1).move(2));
  cell.load("B", "p", back);
  cell.motion.robot("B").delay = 1;
  cell.run("A", "p");
  cell.run("B", "p");
  cell.pass(0.5);
  ASSERT_TRUE(cell.sut.hold("A"));
  ASSERT_TRUE(cell.sut.hold("B"));
  EXPECT_FALSE(cell.sut.step("A", Direction::backward));
  EXPECT_FALSE(cell.sut.step("B", Direction::backward));  // has not moved yet
  cell.sut.stop_all();
  EXPECT_FALSE(cell.sut.busy());
}

TEST(ProgramBackward, RunsFromTheLastCheckPointToTheFirst) {
  CellOfPrograms cell;
  ProgramMaker maker = check_points(10);
  cell.load("A", "p", maker);
  cell.motion.robot("A").q = 9;
  cell.run("A", "p", Direction::backward);
  cell.pass(3.5);
  EXPECT_EQ(cell.status("A", "p").direction, Direction::backward);
  ASSERT_TRUE(cell.sut.hold("A"));
  ASSERT_TRUE(cell.sut.step("A", Direction::forward));
  cell.pass(2);
  EXPECT_DOUBLE_EQ(cell.q("A"), 8);  // it was between 8 and 7
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.finish();
  EXPECT_DOUBLE_EQ(cell.q("A"), 1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::ended);
  cell.run("A", "p", Direction::backward);
  cell.finish();
  EXPECT_NEAR(*cell.status("A", "p").expected_s, 18, 1e-6);
  cell.run("A", "p");
  EXPECT_FALSE(cell.status("A", "p").expected_s);  // forward: not known yet
  cell.finish();
}

}  // namespace
}  // namespace cellmirror::program::test
