// Semaphores between programs, and deadlocks.
#include "tests/unit/program_controller/cell_of_programs.hpp"

namespace cellmirror::program::test {
namespace {

using Kind = ProgramEvent::Kind;

TEST(Semaphores, CountAndAreMadeOnce) {
  Semaphores sut;
  EXPECT_TRUE(sut.declare("S", 2));
  EXPECT_TRUE(sut.declare("S", 2));
  EXPECT_FALSE(sut.declare("S", 1));
  EXPECT_FALSE(sut.declare("many", Semaphores::kMostCount + 1));
  EXPECT_TRUE(sut.try_acquire("S"));
  EXPECT_TRUE(sut.try_acquire("S"));
  EXPECT_FALSE(sut.try_acquire("S"));
  EXPECT_TRUE(sut.release("S", Timestamp{7}));
  EXPECT_EQ(sut.released("S"), Timestamp{7});
  EXPECT_FALSE(sut.try_acquire("unknown"));
  EXPECT_TRUE(sut.release("unknown", Timestamp{8}));
  EXPECT_TRUE(sut.try_acquire("unknown"));
  sut.reset("S");
  EXPECT_EQ(sut.counts().at("S"), 2U);
  sut.forget("S");
  EXPECT_FALSE(sut.counts().contains("S"));
  EXPECT_TRUE(sut.declare("full", Semaphores::kMostCount));
  EXPECT_FALSE(sut.release("full", Timestamp{9}));
  for (std::size_t i = sut.counts().size(); i < Semaphores::kMost; ++i) {
    ASSERT_TRUE(sut.release("s" + std::to_string(i), Timestamp{1}));
  }
  EXPECT_FALSE(sut.release("one more", Timestamp{1}));
}

TEST(ProgramSemaphores, HandOverAtTheInstantOfTheRelease) {
  for (const int look : {1, 11}) {
    CellOfPrograms cell;
    cell.look = look;
    ProgramMaker giver("giver");
    ProgramMaker taker("taker");
    cell.load("A", "giver", giver.semaphore("S", 0).move(1.2345).release("S").move(2));
    cell.load("B", "taker", taker.semaphore("S", 0).move(0.5).acquire("S").move(1.5));
    cell.run("B", "taker");
    cell.run("A", "giver");
    cell.pass(1);
    EXPECT_EQ(cell.status("B", "taker").state, ProgramState::waiting);
    EXPECT_EQ(cell.status("B", "taker").waits_for, "semaphore S");
    EXPECT_FALSE(cell.sut.deadlock());
    cell.finish();
    EXPECT_NEAR(cell.time_of(Kind::done, "taker", "acquire"), 1.2345, 1e-6);
    EXPECT_NEAR(cell.status("B", "taker").elapsed_s, 2.2345, 1e-6) << look;
    EXPECT_NEAR(cell.status("A", "giver").elapsed_s, 2.0, 1e-6);
  }
}

TEST(ProgramSemaphores, ServeWhoWaitsLongest) {
  CellOfPrograms cell;
  cell.look = 50;  // both come to it between two looks
  ProgramMaker owner("owner");
  ProgramMaker late("late");
  ProgramMaker early("early");
  cell.load("C", "owner", owner.semaphore("S", 1).acquire("S").move(1).release("S"));
  cell.load("A", "late", late.semaphore("S", 1).move(0.51).acquire("S").move(1).release("S"));
  cell.load("B", "early", early.semaphore("S", 1).move(0.505).acquire("S").move(1).release("S"));
  cell.run("C", "owner");
  cell.run("A", "late");
  cell.run("B", "early");
  cell.finish();
  EXPECT_LT(cell.time_of(Kind::ended, "early"), cell.time_of(Kind::ended, "late"));
  EXPECT_EQ(cell.sut.failures(), 0U);
  EXPECT_EQ(cell.sut.semaphores().counts().at("S"), 1U);
}

TEST(ProgramSemaphores, BeginAnewWhenTheirProgramsAreLoadedAgain) {
  CellOfPrograms cell;
  ProgramMaker maker;
  const auto program = maker.semaphore("S", 1).acquire("S").move(1).make();
  ASSERT_TRUE(cell.sut.load("A", "p", program));
  ASSERT_TRUE(cell.sut.load("B", "p", program));
  cell.run("A", "p");
  cell.finish();
  EXPECT_EQ(cell.sut.semaphores().counts().at("S"), 0U);
  ASSERT_TRUE(cell.sut.load("A", "p", program));
  EXPECT_EQ(cell.sut.semaphores().counts().at("S"), 1U);
  ProgramMaker other;
  EXPECT_FALSE(cell.sut.load("C", "other", other.semaphore("S", 5).move(1).make()));
  EXPECT_TRUE(cell.sut.remove("A", "p"));
  EXPECT_TRUE(cell.sut.remove("B", "p"));
  EXPECT_TRUE(cell.sut.semaphores().counts().empty());
}

TEST(ProgramSemaphores, AreAsBeforeWhenALoadIsRefused) {
  CellOfPrograms cell;
  ProgramMaker first("first");
  ProgramMaker wrong("wrong");
  ProgramMaker corrected("corrected");
  ProgramMaker second("second");
  cell.load("A", "first", first.semaphore("table", 1).semaphore("own", 1).acquire("own").acquire("table"));
  cell.load("B", "second", second.semaphore("table", 1).semaphore("own", 1));
  cell.run("A", "first");
  cell.finish();
  const auto before = cell.sut.semaphores().counts();
  EXPECT_FALSE(cell.sut.load("A", "third", wrong.semaphore("s1", 1).semaphore("own", 1).semaphore("table", 2).make()));
  EXPECT_EQ(cell.sut.semaphores().counts(), before);
  cell.load("A", "third", corrected.semaphore("s1", 0));
  // It would replace one, whose semaphores begin anew.
  EXPECT_TRUE(cell.sut.remove("B", "second"));
  ProgramMaker other("other");
  cell.load("B", "other", other.semaphore("table", 1).acquire("table"));
  const auto with_three = cell.sut.semaphores().counts();
  ProgramMaker again("again");
  EXPECT_FALSE(cell.sut.load("A", "first", again.semaphore("own", 5).semaphore("table", 2).make()));
  EXPECT_EQ(cell.sut.semaphores().counts(), with_three);
  ProgramMaker as_it_was("as_it_was");
  cell.load("C", "other", as_it_was.semaphore("own", 1));
}

// Each has what the other wants.
void cross(CellOfPrograms& cell) {
  ProgramMaker left("left");
  ProgramMaker right("right");
  left.semaphore("S1", 1).semaphore("S2", 1);
  right.semaphore("S1", 1).semaphore("S2", 1);
  cell.load("A", "left", left.acquire("S1").move(1).acquire("S2").move(2).release("S2").release("S1"));
  cell.load("B", "right", right.acquire("S2").move(1).acquire("S1").move(2).release("S1").release("S2"));
  cell.run("A", "left");
  cell.run("B", "right");
}

TEST(ProgramDeadlock, IsToldWithWhoWaitsForWhat) {
  CellOfPrograms cell;
  cross(cell);
  cell.pass(0.5);
  EXPECT_FALSE(cell.sut.deadlock());
  cell.pass(0.55);
  ASSERT_TRUE(cell.sut.deadlock());
  EXPECT_EQ(cell.sut.deadlock()->text(),
            "deadlock: A left waits at line 3 for semaphore S2, which B right could release; "
            "B right waits at line 3 for semaphore S1, which A left could release");
  EXPECT_EQ(cell.sut.failures(), 1U);
  EXPECT_EQ(cell.sut.last_failure(), cell.sut.deadlock()->text());
  cell.pass(5);
  EXPECT_EQ(cell.sut.failures(), 1U);
  EXPECT_TRUE(cell.sut.busy());
  EXPECT_EQ(cell.status("A", "left").state, ProgramState::waiting);
}

TEST(ProgramDeadlock, EndsWhenSomebodyIsStopped) {
  CellOfPrograms cell;
  ProgramMaker helper("helper");
  cell.load("C", "helper", helper.release("S1").release("S2"));
  cross(cell);
  cell.pass(2);
  ASSERT_TRUE(cell.sut.deadlock());
  EXPECT_NE(cell.sut.deadlock()->text().find("(C helper could, if started)"), std::string::npos);
  cell.run("C", "helper");
  cell.finish();
  EXPECT_FALSE(cell.sut.deadlock());
  EXPECT_EQ(cell.status("A", "left").state, ProgramState::ended);

  cross(cell);
  cell.pass(4);
  ASSERT_TRUE(cell.sut.deadlock());
  cell.sut.stop_all();
  EXPECT_FALSE(cell.sut.deadlock());
}

// A script that stops them and starts others may wait for those in the same turn.
TEST(ProgramDeadlock, EndsWithTheCommandThatEndsIt) {
  CellOfPrograms cell;
  cross(cell);
  cell.pass(2);
  ASSERT_TRUE(cell.sut.deadlock());
  ASSERT_TRUE(cell.sut.stop("B"));
  EXPECT_FALSE(cell.sut.deadlock()) << "who is left waits for what may be started next";
  cell.pass(0.5);
  EXPECT_FALSE(cell.sut.deadlock());
  cell.pass(0.6);
  ASSERT_TRUE(cell.sut.deadlock());
  EXPECT_EQ(cell.sut.deadlock()->waiting.size(), 1U);
  ProgramMaker helper("helper");
  cell.load("C", "helper", helper.move(1).release("S2"));
  cell.run("C", "helper");
  EXPECT_FALSE(cell.sut.deadlock());
  cell.finish();

  cross(cell);
  cell.pass(2);
  ASSERT_TRUE(cell.sut.deadlock());
  cell.sut.cancel("A", {"gone", {}}, true);
  EXPECT_FALSE(cell.sut.deadlock());
}

TEST(ProgramDeadlock, GoesOnWhenACommandDoesNotEndIt) {
  CellOfPrograms cell;
  ProgramMaker waiter("waiter");
  ProgramMaker other("other");
  cell.load("A", "waiter", waiter.acquire("S").move(1));
  cell.load("B", "other", other.move(1));
  cell.run("A", "waiter");
  cell.pass(1.5);
  ASSERT_TRUE(cell.sut.deadlock());
  cell.run("B", "other");
  EXPECT_TRUE(cell.sut.deadlock());
  cell.pass(3);
  EXPECT_EQ(cell.sut.failures(), 1U);
}

TEST(ProgramDeadlock, CountsProgramsThatAreQueuedBehindOneThatWaits) {
  CellOfPrograms cell;
  ProgramMaker waiter("waiter");
  ProgramMaker giver("giver");
  cell.load("A", "waiter", waiter.acquire("S").move(1));
  cell.load("A", "giver", giver.release("S"));
  cell.run("A", "waiter");
  ASSERT_TRUE(cell.sut.run("A", "giver", Controllers::Begin::exec_wait));
  cell.pass(0.01);
  ASSERT_TRUE(cell.sut.deadlock());
  EXPECT_EQ(cell.sut.deadlock()->waiting.at(0).releasers, std::vector<std::string>{"A giver"});
}

TEST(ProgramDeadlock, IsNoneWhileAReleaserCanGoOn) {
  CellOfPrograms cell;
  ProgramMaker waiter("waiter");
  ProgramMaker giver("giver");
  cell.load("A", "waiter", waiter.acquire("S").move(1));
  cell.load("B", "giver", giver.wait_for_input(1).release("S"));
  cell.run("A", "waiter");
  cell.run("B", "giver");
  cell.pass(5);
  EXPECT_FALSE(cell.sut.deadlock());
  ASSERT_TRUE(cell.sut.hold("B"));
  cell.pass(5);
  EXPECT_FALSE(cell.sut.deadlock());
  ASSERT_TRUE(cell.sut.resume("B"));
  ASSERT_TRUE(cell.sut.set_digital_input("B", 1, true));
  cell.finish();
  EXPECT_EQ(cell.status("A", "waiter").state, ProgramState::ended);
}

TEST(ProgramDeadlock, WaitsForTheNextCommandWhereNobodyWasStartedWhoReleases) {
  CellOfPrograms cell;
  ProgramMaker waiter("waiter");
  cell.load("A", "waiter", waiter.acquire("S").move(1));
  cell.run("A", "waiter");
  cell.pass(0.9);
  EXPECT_FALSE(cell.sut.deadlock());
  cell.pass(0.2);
  ASSERT_TRUE(cell.sut.deadlock());
  EXPECT_EQ(cell.sut.deadlock()->text(),
            "deadlock: A waiter waits at line 1 for semaphore S, which no started program releases");
}

TEST(ProgramDeadlock, ComesWhenTheOnlyReleaserFails) {
  CellOfPrograms cell;
  ProgramMaker waiter("waiter");
  ProgramMaker giver("giver");
  cell.load("A", "waiter", waiter.acquire("S").move(1));
  cell.load("B", "giver", giver.move(1).move(99).release("S"));
  cell.run("A", "waiter");
  cell.run("B", "giver");
  cell.pass(1.5);
  EXPECT_EQ(cell.status("B", "giver").state, ProgramState::failed);
  EXPECT_FALSE(cell.sut.deadlock());
  cell.pass(1);
  EXPECT_TRUE(cell.sut.deadlock());
  EXPECT_EQ(cell.sut.failures(), 2U);
}

TEST(ProgramDeadlock, TellsWhoWasStoppedWithTheSemaphore) {
  CellOfPrograms cell;
  ProgramMaker waiter("waiter");
  ProgramMaker owner("owner");
  cell.load("A", "waiter", waiter.semaphore("table", 1).move(0.5).acquire("table").move(1));
  cell.load("B", "owner", owner.semaphore("table", 1).acquire("table").move(5).release("table"));
  cell.run("B", "owner");
  cell.run("A", "waiter");
  cell.pass(1);
  ASSERT_TRUE(cell.sut.stop("B"));
  EXPECT_EQ(cell.texts(Kind::stopped, "owner"), std::vector<std::string>{"before it released semaphore table"});
  cell.pass(1.5);
  ASSERT_TRUE(cell.sut.deadlock());
  EXPECT_EQ(cell.sut.deadlock()->text(),
            "deadlock: A waiter waits at line 2 for semaphore table, which no started program releases (B owner could, "
            "if started), B owner was stopped before it released it");
  // Another gives back what it had.
  ProgramMaker helper("helper");
  cell.load("C", "helper", helper.release("table"));
  cell.run("C", "helper");
  cell.finish();
  EXPECT_TRUE(cell.sut.semaphores().kept_by("table").empty());
}

// It takes what another gives: a signal, that it never gives back.
TEST(ProgramDeadlock, DoesNotNameWhoOnlyTakes) {
  CellOfPrograms cell;
  ProgramMaker taker("taker");
  ProgramMaker giver("giver");
  cell.load("A", "taker", taker.semaphore("S", 1).acquire("S").move(5));
  cell.load("B", "giver", giver.semaphore("S", 1).release("S"));
  cell.run("A", "taker");
  cell.pass(1);
  ASSERT_TRUE(cell.sut.stop("A"));
  EXPECT_TRUE(cell.sut.semaphores().kept_by("S").empty());
}

TEST(ProgramSemaphores, ThatAStoppedProgramKeptBeginAnewWhenItIsLoadedAgain) {
  CellOfPrograms cell;
  ProgramMaker maker;
  const auto program = maker.semaphore("table", 1).acquire("table").move(5).release("table").make();
  ASSERT_TRUE(cell.sut.load("A", "p", program));
  ASSERT_TRUE(cell.sut.load("B", "p", program));
  cell.run("A", "p");
  cell.pass(1);
  ASSERT_TRUE(cell.sut.stop("A"));
  EXPECT_EQ(cell.sut.semaphores().kept_by("table"), std::vector<std::string>{"A p was stopped"});
  ASSERT_TRUE(cell.sut.load("A", "p", program));
  EXPECT_TRUE(cell.sut.semaphores().kept_by("table").empty());
  EXPECT_EQ(cell.sut.semaphores().counts().at("table"), 1U);
}

TEST(ProgramDeadlock, IsNoneWhereTheSemaphoreIsFreeAndWhoWaitsIsHeld) {
  CellOfPrograms cell;
  ProgramMaker waiter("waiter");
  ProgramMaker owner("owner");
  cell.load("A", "waiter", waiter.semaphore("table", 1).move(0.5).acquire("table").move(1));
  cell.load("B", "owner", owner.semaphore("table", 1).acquire("table").move(1).release("table"));
  cell.run("B", "owner");
  cell.run("A", "waiter");
  cell.pass(0.7);
  EXPECT_EQ(cell.status("A", "waiter").state, ProgramState::waiting);
  ASSERT_TRUE(cell.sut.hold("A"));
  cell.pass(5);
  EXPECT_FALSE(cell.sut.deadlock());
  EXPECT_EQ(cell.sut.failures(), 0U);
  ASSERT_TRUE(cell.sut.resume("A"));
  cell.finish();
  EXPECT_EQ(cell.status("A", "waiter").state, ProgramState::ended);
}

}  // namespace
}  // namespace cellmirror::program::test
