// What a run has to do with others: inputs, loading, comments; endless and many programs.
#include "tests/unit/program_controller/cell_of_programs.hpp"

namespace cellmirror::program::test {
namespace {

using Kind = ProgramEvent::Kind;

TEST(ProgramInputs, EndAWaitAtTheInstantAtWhichTheyChange) {
  CellOfPrograms cell;
  cell.look = 9;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).wait_for_input(7).move(2).wait_for_input(7));
  cell.run("A", "p");
  cell.pass(1.5);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::waiting);
  EXPECT_EQ(cell.status("A", "p").waits_for, "input 7 is on");
  ASSERT_TRUE(cell.sut.set_digital_input("A", 7, true));
  cell.finish();
  EXPECT_NEAR(cell.status("A", "p").elapsed_s, 2.5, 1e-6);
  EXPECT_FALSE(cell.sut.set_digital_input("A", 0, true));
  EXPECT_FALSE(cell.sut.set_digital_input("A", kMostPorts + 1, true));
  EXPECT_FALSE(cell.sut.set_digital_input("nobody", 1, true));
  EXPECT_TRUE(cell.sut.set_analogue_input("A", kMostPorts, 2.5));
}

TEST(ProgramInputs, ThatDoNotComeInTimeFailTheProgram) {
  CellOfPrograms cell;
  ProgramMaker maker;
  cell.load("A", "p", maker.move(1).wait_for_input(7, 0.5).move(2));
  cell.run("A", "p");
  cell.finish();
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::failed);
  EXPECT_NEAR(cell.time_of(Kind::failed, "p"), 1.5, 1e-6);
}

TEST(ProgramLoading, RefusesWhatCannotBe) {
  CellOfPrograms cell;
  ProgramMaker maker;
  const auto program = maker.move(1).make();
  EXPECT_FALSE(cell.sut.load("nobody", "p", program));
  EXPECT_FALSE(cell.sut.load("A", "", program));
  EXPECT_FALSE(cell.sut.run("A", "p", Controllers::Begin::now));
  ASSERT_TRUE(cell.sut.load("A", "p", program));
  ASSERT_TRUE(cell.sut.load("A", "p", program));
  EXPECT_FALSE(cell.sut.run("A", "q", Controllers::Begin::now));
  EXPECT_FALSE(cell.sut.run("A", "p", Controllers::Begin::now, Direction::backward));
  EXPECT_FALSE(cell.sut.remove("A", "q"));
  cell.run("A", "p");
  EXPECT_FALSE(cell.sut.load("A", "p", program));
  EXPECT_FALSE(cell.sut.remove("A", "p"));
  EXPECT_FALSE(cell.sut.run("A", "p", Controllers::Begin::exec_wait));
  cell.finish();
  EXPECT_TRUE(cell.sut.remove("A", "p"));
  for (int i = 0; i < 64; ++i) ASSERT_TRUE(cell.sut.load("A", std::to_string(i), program));
  EXPECT_FALSE(cell.sut.load("A", "one more", program));
}

TEST(ProgramComments, MayStopHoldOrDeleteTheirOwnProgram) {
  const auto after = [](std::string_view what) {
    CellOfPrograms cell;
    ProgramMaker maker;
    cell.load("A", "p", maker.move(1).script("X").move(2));
    cell.scripts.answer = [&](std::string_view) -> Result<ActivityHandle> {
      Result<void> done;
      if (what == "stop") done = cell.sut.stop("A");
      if (what == "hold") done = cell.sut.hold("A");
      if (what == "run") done = cell.sut.run("A", "p", Controllers::Begin::exec_wait);
      if (what == "remove") done = cell.sut.remove("A", "p");
      if (what == "forget") cell.sut.cancel("A", {"gone", {}}, true);
      if (what == "stop all") cell.sut.stop_all();
      if (!done) return std::unexpected(done.error());
      return nullptr;
    };
    cell.run("A", "p");
    cell.pass(4);
    return cell.sut.status().empty() ? std::string("none") : std::string(name_of(cell.status("A", "p").state));
  };
  EXPECT_EQ(after("stop"), "stopped");
  EXPECT_EQ(after("stop all"), "stopped");
  EXPECT_EQ(after("hold"), "held");
  EXPECT_EQ(after("run"), "failed");
  EXPECT_EQ(after("remove"), "failed");
  EXPECT_EQ(after("forget"), "none");
}

TEST(ProgramComments, StartProgramsAtTheirOwnInstant) {
  CellOfPrograms cell;
  cell.look = 10;
  ProgramMaker first("first");
  ProgramMaker second("second");
  cell.load("A", "first", first.move(0.9995).script("TF_RUN second B").move(2));
  cell.load("B", "second", second.move(1));
  cell.scripts.answer = [&](std::string_view) -> Result<ActivityHandle> {
    EXPECT_TRUE(cell.sut.run("B", "second", Controllers::Begin::now));
    return nullptr;
  };
  cell.run("A", "first");
  cell.finish();
  EXPECT_NEAR(cell.time_of(Kind::started, "second"), 0.9995, 1e-6);
  EXPECT_NEAR(cell.time_of(Kind::ended, "second"), 1.9995, 1e-6);
}

TEST(ProgramLoops, WithoutAnEndAreStoppedAtOnceAndStarveNobody) {
  CellOfPrograms cell;
  ProgramMaker endless("endless");
  const auto label = endless.label();
  endless.jump(label);
  ProgramMaker talker("talker");
  const auto again = talker.label();
  talker.script("SPEAK").jump(again);
  ProgramMaker other("other");
  cell.load("A", "endless", endless);
  cell.load("B", "talker", talker);
  cell.load("C", "other", other.move(1));
  cell.run("A", "endless");
  cell.run("B", "talker");
  cell.run("C", "other");
  cell.pass(0.1);
  EXPECT_LE(cell.scripts.sources.size(), 100U * 8);
  cell.pass(1.5);
  EXPECT_EQ(cell.status("C", "other").state, ProgramState::ended);
  EXPECT_EQ(cell.status("A", "endless").state, ProgramState::running);
  EXPECT_EQ(cell.status("A", "endless").line, 1U);
  ASSERT_TRUE(cell.sut.stop("A"));
  ASSERT_TRUE(cell.sut.stop("B"));
  EXPECT_FALSE(cell.sut.busy());
}

TEST(ProgramRuns, OfAHundredThousandRecordsEnd) {
  CellOfPrograms cell;
  ProgramMaker maker;
  for (int i = 0; i < 100'000; ++i) maker.out(1 + i % 1000, i % 2 == 0);
  cell.load("A", "p", maker);
  cell.run("A", "p");
  cell.finish(10);
  EXPECT_EQ(cell.status("A", "p").state, ProgramState::ended);
}

TEST(ProgramRuns, OfTwentyRobotsGoOnSideBySide) {
  CellOfPrograms cell;
  cell.look = 3;
  for (int i = 0; i < 20; ++i) {
    const std::string robot = "R" + std::to_string(i);
    cell.motion.robot(robot);
    ProgramMaker maker;
    for (int k = 1; k <= 50; ++k) maker.move(0.02 * (k % 2)).script("S");
    cell.load(robot, "p", maker);
    cell.run(robot, "p");
  }
  cell.finish();
  for (const ProgramStatus& status : cell.sut.status()) EXPECT_NEAR(status.elapsed_s, 1.0, 1e-6) << status.robot;
}

}  // namespace
}  // namespace cellmirror::program::test
