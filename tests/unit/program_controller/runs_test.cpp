// Runs of one program: times, order, errors, the queue.
#include "tests/unit/program_controller/cell_of_programs.hpp"

namespace cellmirror::program::test {
namespace {

using Kind = ProgramEvent::Kind;
constexpr double kExact = 2e-9;

TEST(ProgramRuns, TakeAsLongAsTheirMovesAndDelays) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).delay(0.5).move(0.25).move(2));
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::loaded);
  cell.run("A", "p");
  cell.pass(0.2);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::running);
  EXPECT_EQ(cell.status("A", "p").step, "line 1");
  EXPECT_TRUE(cell.sut.moves("A"));
  EXPECT_FALSE(cell.sut.moves("B"));
  cell.finish();
  const ProgramStatus status = cell.status("A", "p");
  EXPECT_EQ(status.state, ProgramState::ended);
  EXPECT_NEAR(status.elapsed_s, 1 + 0.5 + 0.75 + 1.75, kExact);
  ASSERT_TRUE(status.expected_s);
  EXPECT_NEAR(*status.expected_s, status.elapsed_s, kExact);
  EXPECT_EQ(status.runs, 1U);
  EXPECT_DOUBLE_EQ(cell.q("A"), 2);
  EXPECT_FALSE(cell.sut.moves("A"));
}

TEST(ProgramRuns, PutAtMostEightMovesAhead) {
  CellOfPrograms cell;
  ProgramMaker maker;
  for (int i = 1; i <= 40; ++i) maker.move(0.1 * i);
  cell.load("A", "p", maker);
  cell.run("A", "p");
  cell.finish();
  EXPECT_EQ(cell.motion.robot("A").most_ahead, 8U);
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 4.0, 1e-6);
}

TEST(ProgramRuns, LoseNoTimeWhereTheyWaitForTheEndOfAMove) {
  for (const int look : {1, 7, 13}) {
    CellOfPrograms cell;
    cell.look = look;
    ProgramMaker maker;
    for (int i = 1; i <= 20; ++i) maker.move(0.1 * i + 0.0003).script("SET " + std::to_string(i));
    cell.load("A", "p", maker);
    cell.run("A", "p");
    cell.finish();
    EXPECT_NEAR(cell.status("A", "p").elapsed_s, 2.0003, 1e-6) << look;
    EXPECT_NEAR(cell.time_of(Kind::done, "p", "SET 10"), 1.0003, 1e-6) << look;
  }
}

TEST(ProgramRuns, CarryOutCommentsWhenTheMovesBeforeHaveEnded) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.script("FIRST").move(1).script("SECOND").move(0).script("THIRD"));
  std::vector<double> postures;
  cell.scripts.answer = [&](std::string_view) -> Result<ActivityHandle> {
    postures.push_back(cell.q("A"));
    return nullptr;
  };
  cell.run("A", "p");
  cell.finish();
  EXPECT_EQ(postures, (std::vector<double>{0, 1, 0}));
  ASSERT_EQ(cell.scripts.sources.size(), 3U);
  EXPECT_EQ(cell.scripts.sources[1], "program p of A, line 3");
}

TEST(ProgramRuns, DoNotStopAtFlyMovesForOutputsAndComments) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.fly(1).out(3, true).script("HALF").move(2).out(3, false));
  cell.run("A", "p");
  cell.pass(0.85);
  EXPECT_FALSE(cell.sut.signals("A")->digital_outputs[3]);
  cell.pass(0.1);
  EXPECT_TRUE(cell.sut.signals("A")->digital_outputs[3]);
  cell.finish();
  EXPECT_FALSE(cell.sut.signals("A")->digital_outputs[3]);
  EXPECT_NEAR(cell.time_of(Kind::done, "p", "HALF"), 1 - kFlyTime, kExact);
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 2 - kFlyTime, kExact);
}

TEST(ProgramRuns, StandAtAFlyMoveBeforeTheyWait) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.semaphore("S", 1).fly(1).acquire("S").move(2));
  cell.run("A", "p");
  cell.finish();
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 2, 1e-6);
}

TEST(ProgramRuns, HaveTheSameCommandsHoweverOftenTheyAreLookedAt) {
  const auto commands = [](int look) {
    CellOfPrograms cell;
    cell.look = look;
    ProgramMaker maker;
    for (int i = 1; i <= 30; ++i) maker.move(0.01 * i, i % 3 != 0).out(i, true).script("S");
    cell.load("A", "p", maker);
    cell.run("A", "p");
    cell.finish();
    return cell.texts(Kind::command, "p");
  };
  const auto often = commands(1);
  EXPECT_EQ(often.size(), 90U);
  EXPECT_EQ(often, commands(50));
}

TEST(ProgramRuns, BeginAfterTheDelayOfTheirRobot) {
  CellOfPrograms cell;
  cell.motion.robot("A").delay = 1.5;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1));
  cell.run("A", "p");
  cell.pass(1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::delayed);
  EXPECT_DOUBLE_EQ(cell.q("A"), 0);
  cell.finish();
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 2.5, kExact);
}

TEST(ProgramRuns, SetTheirToolAtRestAndGiveItBack) {
  CellOfPrograms cell;
  ProgramMaker maker;
  Pose X_PT = Pose::Identity();
  X_PT.translation().x() = 0.1;
  cell.load("A", "p", maker.move(1).tool(X_PT).move(2));
  cell.run("A", "p");
  cell.pass(0.9);
  EXPECT_FALSE(cell.motion.robot("A").X_PT);
  cell.pass(0.2);
  ASSERT_TRUE(cell.motion.robot("A").X_PT);
  EXPECT_DOUBLE_EQ(cell.motion.robot("A").X_PT->translation().x(), 0.1);
  cell.finish();
  EXPECT_FALSE(cell.motion.robot("A").X_PT);
  EXPECT_EQ(cell.motion.robot("A").tool_changes, 2);
}

TEST(ProgramRuns, FailWhenTheMovesBeforeTheErrorHaveEnded) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).move(2).move(99).move(3));
  cell.run("A", "p");
  cell.pass(0.5);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::running);
  EXPECT_EQ(cell.sut.failures(), 0U);
  cell.finish();
  const ProgramStatus status = cell.status("A", "p");
  EXPECT_EQ(status.state, ProgramState::failed);
  EXPECT_EQ(status.error, "p.ird:3:1: error: A cannot reach the target; look at its limits");
  EXPECT_EQ(status.step, "line 3");
  EXPECT_EQ(status.line, 3U);
  EXPECT_FALSE(status.expected_s);
  EXPECT_DOUBLE_EQ(cell.q("A"), 2);
  EXPECT_EQ(cell.sut.failures(), 1U);
  EXPECT_EQ(cell.sut.last_failure(), "program p of A: " + status.error);
}

TEST(ProgramRuns, FailWithTheirOwnMistakesAndTheirComments) {
  CellOfPrograms cell;
  ProgramMaker wrong("wrong");
  ProgramMaker refused("refused");
  cell.load("A", "wrong", wrong.move(1).divide_by_zero().move(2));
  cell.load("B", "refused", refused.move(1).script("NO_SUCH").move(2));
  cell.scripts.answer = [](std::string_view text) -> Result<ActivityHandle> {
    return fail(std::string(text) + " is not a command");
  };
  cell.run("A", "wrong");
  cell.run("B", "refused");
  cell.finish();
  EXPECT_EQ(cell.status("A", "wrong").error.rfind("wrong.ird:2:1: error: ", 0), 0U);
  EXPECT_EQ(cell.status("A", "wrong").line, 2U);
  EXPECT_EQ(cell.status("B", "refused").error, "refused.ird:2:1: error: NO_SUCH is not a command");
  EXPECT_DOUBLE_EQ(cell.q("A"), 1);
  EXPECT_DOUBLE_EQ(cell.q("B"), 1);
  EXPECT_EQ(cell.sut.failures(), 2U);
}

TEST(ProgramRuns, StopTheRobotWhereACommentBehindAFlyMoveIsRefused) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.fly(1).script("NO_SUCH").move(2).move(3));
  cell.scripts.answer = [](std::string_view) -> Result<ActivityHandle> { return fail("no"); };
  cell.run("A", "p");
  cell.finish();
  cell.pass(1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::failed);
  EXPECT_EQ(cell.status("A", "p").step, "line 2");
  EXPECT_TRUE(cell.motion.robot("A").queue.empty());
  EXPECT_LT(cell.q("A"), 1.5);
}

TEST(ProgramRuns, FailWhereAMoveIsBlockedOnItsWay) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).move(2));
  cell.motion.block("A");
  cell.run("A", "p");
  cell.finish();
  EXPECT_EQ(cell.status("A", "p").error.rfind("p.ird:1:1: error: A could not continue this move", 0), 0U);
}

TEST(ProgramQueue, RunsOneBehindTheOtherWithoutAGap) {
  CellOfPrograms cell;
  cell.look = 5;
  cell.motion.robot("A").delay = 0.25;
  for (const char* name : {"hs1", "hs2", "hs3"}) {
    ProgramMaker maker(name);
    cell.load("A", name, maker.move(1).move(0));
  }
  cell.run("A", "hs1");
  EXPECT_FALSE(cell.sut.run("A", "hs2", Controllers::Begin::now));
  ASSERT_TRUE(cell.sut.run("A", "hs2", Controllers::Begin::exec_wait));
  ASSERT_TRUE(cell.sut.run("A", "hs3", Controllers::Begin::exec_wait));
  EXPECT_FALSE(cell.sut.run("A", "hs3", Controllers::Begin::exec_wait));
  EXPECT_EQ(cell.status("A", "hs3").state, ProgramState::queued);
  cell.finish();
  EXPECT_NEAR(cell.time_of(Kind::started, "hs2"), 2.25, 1e-6);
  EXPECT_NEAR(cell.time_of(Kind::ended, "hs3"), 6.75, 1e-6);
  EXPECT_EQ(cell.sut.failures(), 0U);
}

TEST(ProgramQueue, DoesNotGoOnBehindAProgramThatFailed) {
  CellOfPrograms cell;
  ProgramMaker bad("bad");
  ProgramMaker good("good");
  cell.load("A", "bad", bad.move(99));
  cell.load("A", "good", good.move(1));
  cell.run("A", "bad");
  ASSERT_TRUE(cell.sut.run("A", "good", Controllers::Begin::exec_wait));
  cell.finish();
  EXPECT_EQ(cell.status("A", "good").state, ProgramState::failed);
  EXPECT_EQ(cell.status("A", "good").error, "not started: the previous program bad has failed");
  EXPECT_EQ(cell.status("A", "good").runs, 0U);
  cell.run("A", "good");
  cell.finish();
  EXPECT_EQ(cell.status("A", "good").state, ProgramState::ended);
  EXPECT_EQ(cell.status("A", "good").error, "");
}

TEST(ProgramRuns, EndAtOnceWhenStoppedAndForgetTheQueue) {
  CellOfPrograms cell;
  ProgramMaker first("first");
  ProgramMaker second("second");
  cell.load("A", "first", first.move(5));
  cell.load("A", "second", second.move(1));
  cell.run("A", "first");
  ASSERT_TRUE(cell.sut.run("A", "second", Controllers::Begin::exec_wait));
  cell.pass(1);
  ASSERT_TRUE(cell.sut.stop("A"));
  EXPECT_FALSE(cell.sut.busy());
  cell.pass(1);
  EXPECT_LT(cell.q("A"), 1.2);
  EXPECT_EQ(cell.status("A", "first").state, ProgramState::stopped);
  EXPECT_NEAR(cell.status("A", "first").elapsed_s, 1, 1e-6);
  EXPECT_EQ(cell.status("A", "second").state, ProgramState::stopped);
  EXPECT_EQ(cell.sut.failures(), 0U);
  EXPECT_FALSE(cell.sut.stop("A"));
  std::vector<std::string> stopped;  // in the order in which they would have run
  for (const ProgramEvent& event : cell.events) {
    if (event.kind == Kind::stopped) stopped.push_back(event.program);
  }
  EXPECT_EQ(stopped, (std::vector<std::string>{"first", "second"}));
}

TEST(ProgramRuns, BeginWhenTheRobotRests) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(5));
  cell.run("A", "p");
  cell.pass(1);
  ASSERT_TRUE(cell.sut.stop("A"));
  cell.run("A", "p");
  cell.pass(0.02);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::delayed);  // it brakes still
  cell.finish();
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::ended);
  EXPECT_DOUBLE_EQ(cell.q("A"), 5);
}

TEST(ProgramRuns, OfRobotsThatAreGivenUpFail) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(5));
  cell.run("A", "p");
  cell.pass(1);
  cell.sut.cancel("A", {"A is online", {}}, false);
  EXPECT_FALSE(cell.sut.busy());
  EXPECT_EQ(cell.status("A", "p").error, "A is online");
  cell.motion.robot("A").known = false;
  EXPECT_FALSE(cell.sut.run("A", "p", Controllers::Begin::now));
  cell.sut.cancel("A", {"A is deleted", {}}, true);
  EXPECT_TRUE(cell.sut.status().empty());
}

TEST(ProgramRuns, WaitForWhatTheirCommentsHaveBegun) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.script("POS_ROB A").move(1));
  const auto activity = std::make_shared<Activity>();
  cell.scripts.answer = [&](std::string_view) -> Result<ActivityHandle> {
    EXPECT_FALSE(cell.sut.moves("A"));  // the comment may move the robot itself
    return activity;
  };
  cell.run("A", "p");
  cell.pass(1);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::waiting);
  EXPECT_DOUBLE_EQ(cell.q("A"), 0);
  EXPECT_FALSE(cell.sut.moves("A"));
  activity->finish();
  cell.pass(0.1);
  EXPECT_TRUE(cell.sut.moves("A"));
  cell.finish();
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 2, 0.002);
}

// MOVE_ROB is done when the move is queued.
TEST(ProgramRuns, WaitUntilTheirRobotRestsBehindACommentThatMovesIt) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).script("MOVE_ROB A").out(4, true));
  cell.scripts.answer = [&](std::string_view) -> Result<ActivityHandle> {
    MoveCommand command;
    command.target.joints[0] = 3;
    EXPECT_TRUE(cell.motion.move("A", command, {}));
    return nullptr;
  };
  cell.run("A", "p");
  cell.pass(2);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::waiting);
  EXPECT_FALSE(cell.sut.signals("A")->digital_outputs[4]);
  cell.finish();
  EXPECT_TRUE(cell.sut.signals("A")->digital_outputs[4]);
  EXPECT_DOUBLE_EQ(cell.q("A"), 3);
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 3, 0.002);
}

TEST(ProgramRuns, EndWhenTheirRobotRestsBehindACommentThatMovesIt) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.script("MOVE_ROB A"));
  cell.scripts.answer = [&](std::string_view) -> Result<ActivityHandle> {
    MoveCommand command;
    command.target.joints[0] = 2;
    EXPECT_TRUE(cell.motion.move("A", command, {}));
    return nullptr;
  };
  cell.run("A", "p");
  cell.finish();
  EXPECT_DOUBLE_EQ(cell.q("A"), 2);
}

TEST(ProgramRuns, FailWhereWhatTheirCommentsHaveBegunIsRefused) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).script("POS_ROB B").move(2));
  const auto activity = std::make_shared<Activity>();
  cell.scripts.answer = [&](std::string_view) -> Result<ActivityHandle> { return activity; };
  cell.run("A", "p");
  cell.pass(2);
  activity->refuse({"B was stopped", {}});
  cell.finish();
  EXPECT_EQ(cell.status("A", "p").error, "p.ird:2:1: error: B was stopped");
}

}  // namespace
}  // namespace cellmirror::program::test
